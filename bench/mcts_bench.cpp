// SPDX-License-Identifier: Apache-2.0
// The tree search among 11 agents that go straight on: expansions per second of processor time, and
// how long a decision takes that may take 50 ms.
#include <algorithm>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/base/clock.hpp"
#include "core/base/random.hpp"
#include "local_planner/mcts/mcts_planner.hpp"

namespace headland::bench {
namespace {

constexpr int kAgents = 11;
constexpr double kBudget = 0.05;  // of a decision [s]
constexpr double kPeriod = 10.0;  // between decisions: so long that no tree is kept [s]
constexpr double kFree = 2.5;     // around the robot nobody starts [m]

Vehicle robot() {
  Vehicle vehicle;
  vehicle.wheelbase_m = 1.2;
  vehicle.max_steering_deg = 40.0;
  vehicle.steering_rate_radps = 0.8;
  vehicle.footprint = {1.6, 0.4, 1.3};
  vehicle.work_speed_mps = vehicle.transit_speed_mps = vehicle.turn_speed_mps = 1.5;
  vehicle.acceleration_mps2 = 1.0;
  vehicle.can_reverse = false;
  return vehicle;
}

std::vector<Agent> crowd(RandomStream& random) {
  std::vector<Agent> agents(kAgents);
  for (int i = 0; i < kAgents; ++i) {
    Agent& agent = agents[static_cast<std::size_t>(i)];
    agent.id = i;
    agent.radius_m = 0.5;
    do {
      agent.position = {random.uniform(-8.0, 10.0), random.uniform(-8.0, 8.0)};
    } while (agent.position.norm() < kFree);
    agent.velocity = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
  }
  return agents;
}

// A decision among another crowd each time.
class Decisions {
 public:
  Decisions() : planner_(robot(), MctsConfig{}), random_(3, "bench/mcts") {
    scene_.robot.state.speed = 1.0;
    goal_.place = {9.0, 1.0};
    goal_.speed_mps = 1.5;
  }
  void meet() {
    agents_ = crowd(random_);
    scene_.agents = agents_;
    scene_.time_s += kPeriod;
  }
  int decide(const PlanBudget& budget) {
    planner_.plan(scene_, goal_, budget, plan_);
    return plan_.expansions;
  }

 private:
  MctsPlanner planner_;
  RandomStream random_;
  std::vector<Agent> agents_;
  LocalScene scene_;
  LocalGoal goal_;
  LocalPlan plan_;
};

// Items are expansions.
void expansions(benchmark::State& state) {
  Decisions decisions;
  std::int64_t count = 0;
  for (auto _ : state) {
    decisions.meet();
    count += decisions.decide({static_cast<int>(state.range(0)), {}});
  }
  state.SetItemsProcessed(count);
}

void within_50_ms(benchmark::State& state) {
  const SteadyClock clock;
  Decisions decisions;
  std::vector<double> took_ms;
  double count = 0.0;
  for (auto _ : state) {
    decisions.meet();
    const double begin = clock.now();
    count += decisions.decide({0, Deadline::in(&clock, kBudget)});
    took_ms.push_back(1e3 * (clock.now() - begin));
  }
  std::sort(took_ms.begin(), took_ms.end());
  const auto quantile = [&](double share) {
    return took_ms[static_cast<std::size_t>(share * static_cast<double>(took_ms.size() - 1))];
  };
  state.counters["p50_ms"] = quantile(0.5);
  state.counters["p99_ms"] = quantile(0.99);
  state.counters["max_ms"] = took_ms.back();
  state.counters["expansions"] = count / static_cast<double>(took_ms.size());
}

BENCHMARK(expansions)->Arg(1000)->Arg(20000)->Unit(benchmark::kMillisecond);
BENCHMARK(within_50_ms)->Iterations(400)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace headland::bench

BENCHMARK_MAIN();
