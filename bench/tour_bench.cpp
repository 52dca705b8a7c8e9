// SPDX-License-Identifier: Apache-2.0
// The tour engine beside its own exact mode: how often and how closely its search finds what the
// exact search proves, then the time of each.
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "core/base/random.hpp"
#include "global_planner/tour/tour_solver.hpp"

namespace headland {
namespace {

constexpr int kInstances = 10;

// Electric vehicles in a square of 100 m: places with loads and windows, four chargers.
TourProblem random_problem(int tasks, std::uint64_t seed) {
  constexpr int kStations = 4;
  RandomStream random(seed, "tour bench");
  TourProblem problem;
  problem.sites = 1 + tasks + kStations;
  std::vector<std::pair<double, double>> at;
  for (int s = 0; s < problem.sites; ++s) {
    at.emplace_back(random.uniform(0.0, 100.0), random.uniform(0.0, 100.0));
  }
  TourProfile& profile = problem.profiles.emplace_back();
  for (const auto& [ax, ay] : at) {
    for (const auto& [bx, by] : at) {
      const double d = std::hypot(ax - bx, ay - by);
      profile.ways.push_back({d, d, d, d});
    }
  }
  for (int t = 0; t < tasks; ++t) {
    TourTask task;
    task.modes = {{1 + t, 1 + t}};
    task.demand = 1.0 + random.index(3);
    task.earliest_s = random.uniform(0.0, 300.0);
    task.latest_s = task.earliest_s + 300.0;
    problem.tasks.push_back(task);
    profile.work.push_back({{0.0, 5.0}});
  }
  TourVehicle vehicle;
  vehicle.load_capacity = 12.0;
  vehicle.battery_j = vehicle.start_energy_j = 250.0;
  vehicle.fixed_cost = 100.0;
  for (int s = 0; s < kStations; ++s) {
    problem.stations.push_back({1 + tasks + s, tasks});
    vehicle.charging.push_back({{{0.0, 0.0}, {60.0, 200.0}, {120.0, 250.0}}});
  }
  problem.vehicles.assign(static_cast<std::size_t>(tasks), vehicle);
  return problem;
}

TourSolution solve(const TourProblem& problem, int exact_up_to_tasks) {
  TourOptions options;
  options.exact_up_to_tasks = exact_up_to_tasks;
  return solve_tour(problem, options).value();
}

void print_gaps() {
  fmt::print("{} instances each\n{:<8}{:>10}{:>16}{:>22}\n", kInstances, "tasks", "proven",
             "search: equal", "worst above exact");
  for (const int tasks : {6, 9, 12}) {
    int proven = 0;
    int equal = 0;
    double worst = 0.0;
    for (std::uint64_t seed = 1; seed <= kInstances; ++seed) {
      const TourProblem problem = random_problem(tasks, seed);
      const TourSolution exact = solve(problem, tasks);
      const double above = solve(problem, 0).cost / exact.cost - 1.0;
      proven += exact.optimal ? 1 : 0;
      equal += above < 1e-9 ? 1 : 0;
      worst = std::max(worst, above);
    }
    fmt::print("{:<8}{:>10}{:>16}{:>20.3f} %\n", tasks, proven, equal, 100.0 * worst);
  }
}

void run(benchmark::State& state, bool exact) {
  const int tasks = static_cast<int>(state.range(0));
  std::uint64_t seed = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const TourProblem problem = random_problem(tasks, 1 + seed++ % kInstances);
    state.ResumeTiming();
    benchmark::DoNotOptimize(solve(problem, exact ? tasks : 0));
  }
}

void tour_exact(benchmark::State& state) { run(state, true); }
void tour_search(benchmark::State& state) { run(state, false); }

// Each instance once a repetition; the median holds off what else the machine does.
void repeated(benchmark::internal::Benchmark* entry) {
  entry->Iterations(kInstances)
      ->Repetitions(5)
      ->ReportAggregatesOnly(true)
      ->Unit(benchmark::kMillisecond);
}
BENCHMARK(tour_exact)->Arg(6)->Arg(9)->Arg(12)->Apply(repeated);
BENCHMARK(tour_search)->Arg(6)->Arg(9)->Arg(12)->Arg(50)->Apply(repeated);

}  // namespace
}  // namespace headland

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  headland::print_gaps();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
