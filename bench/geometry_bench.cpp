// SPDX-License-Identifier: Apache-2.0
// Steering curves beside OMPL's: first a table of faults in queries of known answers, then the time
// per query.
#include <algorithm>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/DubinsStateSpace.h>
#include <ompl/base/spaces/ReedsSheppStateSpace.h>

#include "core/geometry/clothoid.hpp"
#include "core/geometry/dubins.hpp"
#include "core/geometry/reeds_shepp.hpp"
#include "core/geometry/smooth_dubins.hpp"
#include "tests/support/curve_constructions.hpp"

namespace headland {
namespace {

namespace ob = ompl::base;

constexpr double kRadius = 2.0;     // [m]
constexpr double kHalfSide = 10.0;  // [m] of the square of the random poses
constexpr double kOverLong = 1e-6;  // [m] beyond the known answer
constexpr std::size_t kCount = 200000;

struct Query {
  Pose2 from;
  Pose2 to;
};

std::vector<Query> random_queries() {
  RandomStream random(1, "bench");
  std::vector<Query> queries(kCount);
  for (Query& query : queries) {
    query.from = test::random_pose(random, kHalfSide);
    query.to = test::random_pose(random, kHalfSide);
  }
  return queries;
}

// OMPL's spaces on the same poses.
template <typename Space>
class Ompl {
 public:
  Ompl() : space_(std::make_shared<Space>(kRadius)), from_(space_), to_(space_) {}

  double distance(const Query& query) {
    set(query);
    return space_->distance(from_.get(), to_.get());
  }
  Curve path(const Query& query);

 private:
  static void set(ob::ScopedState<Space>& state, const Pose2& pose) {
    state->setXY(pose.x, pose.y);
    state->setYaw(pose.yaw);
  }
  void set(const Query& query) {
    set(from_, query.from);
    set(to_, query.to);
  }

  std::shared_ptr<Space> space_;
  ob::ScopedState<Space> from_;
  ob::ScopedState<Space> to_;
};

template <>
Curve Ompl<ob::DubinsStateSpace>::path(const Query& query) {
  set(query);
  const auto found = space_->dubins(from_.get(), to_.get());
  Curve curve;
  for (int i = 0; i < 3; ++i) {
    const auto type = found.type_[i];
    const double turn = type == ob::DubinsStateSpace::DUBINS_LEFT    ? 1.0
                        : type == ob::DubinsStateSpace::DUBINS_RIGHT ? -1.0
                                                                     : 0.0;
    curve.add({turn / kRadius, found.length_[i] * kRadius});
  }
  return curve;
}

template <>
Curve Ompl<ob::ReedsSheppStateSpace>::path(const Query& query) {
  set(query);
  const auto found = space_->reedsShepp(from_.get(), to_.get());
  Curve curve;
  for (int i = 0; i < 5 && found.type_[i] != ob::ReedsSheppStateSpace::RS_NOP; ++i) {
    const auto type = found.type_[i];
    const double turn = type == ob::ReedsSheppStateSpace::RS_LEFT    ? 1.0
                        : type == ob::ReedsSheppStateSpace::RS_RIGHT ? -1.0
                                                                     : 0.0;
    curve.add({turn / kRadius, found.length_[i] * kRadius});
  }
  return curve;
}

struct Faults {
  int over_long = 0;
  double worst_excess = 0.0;    // [m]
  double worst_position = 0.0;  // [m]
  double worst_yaw = 0.0;       // [rad]

  void count(const Curve& found, const Query& query, double known_length) {
    const double excess = found.length() - known_length;
    const EndError error = end_error(found, query.from, query.to);
    over_long += excess > kOverLong ? 1 : 0;
    worst_excess = std::max(worst_excess, excess);
    worst_position = std::max(worst_position, error.position);
    worst_yaw = std::max(worst_yaw, error.yaw);
  }
  void print(const char* name) const {
    fmt::print("{:<22}{:>10}{:>16.3g}{:>20.2g}{:>16.2g}\n", name, over_long,
               std::max(worst_excess, 0.0), worst_position, worst_yaw);
  }
};

template <typename Space, typename Solve, typename Construct>
void compare_faults(const char* name, Solve solve, Construct construct) {
  RandomStream random(20261122, name);
  Ompl<Space> ompl;
  Faults ours;
  Faults theirs;
  for (std::size_t i = 0; i < kCount; ++i) {
    const Pose2 from = test::random_pose(random, kHalfSide);
    const Curve known = construct(random, kRadius);
    Query query{from, known.end_pose(from)};
    query.to.yaw = wrap_angle(query.to.yaw);
    ours.count(solve(query.from, query.to, kRadius), query, known.length());
    theirs.count(ompl.path(query), query, known.length());
  }
  ours.print(fmt::format("{}, Headland", name).c_str());
  theirs.print(fmt::format("{}, OMPL", name).c_str());
}

void print_faults() {
  fmt::print("{} constructed queries each\n{:<22}{:>10}{:>16}{:>20}{:>16}\n", kCount, "",
             "over-long", "worst [m]", "end error [m]", "[rad]");
  compare_faults<ob::DubinsStateSpace>("Dubins", shortest_dubins,
                                       test::random_forward_construction);
  compare_faults<ob::ReedsSheppStateSpace>("Reeds-Shepp", shortest_reeds_shepp,
                                           test::random_reversing_construction);
}

// Time per query over all random queries.
template <typename Ask>
void run(benchmark::State& state, Ask ask) {
  const std::vector<Query> queries = random_queries();
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(ask(queries[i]));
    if (++i == queries.size()) i = 0;
  }
}

void dubins_length_headland(benchmark::State& state) {
  run(state, [](const Query& q) { return dubins_length(q.from, q.to, kRadius); });
}
void dubins_curve_headland(benchmark::State& state) {
  run(state, [](const Query& q) { return shortest_dubins(q.from, q.to, kRadius); });
}
void dubins_length_ompl(benchmark::State& state) {
  Ompl<ob::DubinsStateSpace> ompl;
  run(state, [&](const Query& q) { return ompl.distance(q); });
}
void reeds_shepp_length_headland(benchmark::State& state) {
  run(state, [](const Query& q) { return reeds_shepp_length(q.from, q.to, kRadius); });
}
void reeds_shepp_curve_headland(benchmark::State& state) {
  run(state, [](const Query& q) { return shortest_reeds_shepp(q.from, q.to, kRadius); });
}
void reeds_shepp_length_ompl(benchmark::State& state) {
  Ompl<ob::ReedsSheppStateSpace> ompl;
  run(state, [&](const Query& q) { return ompl.distance(q); });
}

void clothoid_headland(benchmark::State& state) {
  run(state, [](const Query& q) { return fit_clothoid(q.from, q.to); });
}

// With the sharpness at which other libraries are measured.
const SmoothTurn kSmooth({1.0 / kRadius, 0.5});

void smooth_dubins_curve_headland(benchmark::State& state) {
  run(state, [](const Query& q) { return smooth_dubins(q.from, q.to, kSmooth); });
}
void smooth_dubins_length_headland(benchmark::State& state) {
  run(state, [](const Query& q) { return smooth_dubins_length(q.from, q.to, kSmooth); });
}

// How much longer than Dubins' the curves are.
void print_smooth_lengths() {
  double sum = 0.0;
  double dubins = 0.0;
  double worst = 0.0;
  for (const Query& q : random_queries()) {
    const Curve curve = smooth_dubins(q.from, q.to, kSmooth);
    sum += curve.length();
    dubins += dubins_length(q.from, q.to, kRadius);
    worst = std::max(worst, end_error(curve, q.from, q.to).position);
  }
  fmt::print("Smooth Dubins: {:.4f} times as long as Dubins on average, end error {:.2g} m\n",
             sum / dubins, worst);
}

// All queries once a repetition; the median holds off what else the machine does.
void repeated(benchmark::internal::Benchmark* entry) {
  entry->Iterations(kCount)->Repetitions(15)->ReportAggregatesOnly(true)->Unit(
      benchmark::kMicrosecond);
}
BENCHMARK(dubins_length_headland)->Apply(repeated);
BENCHMARK(dubins_curve_headland)->Apply(repeated);
BENCHMARK(dubins_length_ompl)->Apply(repeated);
BENCHMARK(reeds_shepp_length_headland)->Apply(repeated);
BENCHMARK(reeds_shepp_curve_headland)->Apply(repeated);
BENCHMARK(reeds_shepp_length_ompl)->Apply(repeated);
BENCHMARK(clothoid_headland)->Apply(repeated);
BENCHMARK(smooth_dubins_length_headland)->Apply(repeated);
BENCHMARK(smooth_dubins_curve_headland)->Apply(repeated);

}  // namespace
}  // namespace headland

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  headland::print_faults();
  headland::print_smooth_lengths();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
