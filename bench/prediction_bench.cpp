// SPDX-License-Identifier: Apache-2.0
// What the learned predictor costs: a sight, and a prediction of 12 steps, by the number of agents.
#include <cmath>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "local_planner/prediction/learned_predictor.hpp"

namespace headland {
namespace {

std::vector<Agent> crowd(int count, double time) {
  std::vector<Agent> agents(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    Agent& agent = agents[static_cast<std::size_t>(i)];
    const double angle = 2.4 * i;  // a sunflower's spiral: 10 m2 for each
    agent.id = i;
    agent.radius_m = 0.5;
    agent.velocity = {std::cos(3.0 * angle), std::sin(3.0 * angle)};
    agent.position = 1.78 * std::sqrt(i + 1.0) * Point2(std::cos(angle), std::sin(angle)) +
                     time * agent.velocity;
  }
  return agents;
}

void run(benchmark::State& state, bool predicts) {
  const auto network = load_network(BENCH_WEIGHTS);
  if (!network) {
    state.SkipWithError(to_string(network.error()).c_str());
    return;
  }
  LearnedPredictor predictor(*network);
  const int agents = static_cast<int>(state.range(0));
  double time = 0.0;
  for (; time < 3.05; time += 0.1) {
    predictor.observe(crowd(agents, time), {time, 0.0}, {1.0, 0.0}, time);
  }
  const std::vector<Agent> now = crowd(agents, time);
  std::vector<Point2> path;
  for (int k = 1; k <= 12; ++k) path.emplace_back(time + 0.4 * k, 0.0);
  Prediction prediction;
  for (auto _ : state) {
    if (predicts) {
      predictor.predict(path, 0.4, 12, prediction);
      benchmark::DoNotOptimize(prediction.mean.data());
    } else {
      predictor.observe(now, {time, 0.0}, {1.0, 0.0}, time);
    }
  }
}

BENCHMARK_CAPTURE(run, observe, false)->Arg(1)->Arg(10)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run, predict, true)->Arg(1)->Arg(10)->Arg(30)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace headland

BENCHMARK_MAIN();
