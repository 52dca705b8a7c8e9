// SPDX-License-Identifier: Apache-2.0
// What a step of a crowd takes; items are agent-steps.
#include <benchmark/benchmark.h>

#include "bench/crowd_scenes.hpp"

namespace headland::bench {
namespace {

void run(benchmark::State& state, const Scene& scene) {
  for (auto _ : state) {
    Crowd crowd(scene.config, scene.agents, OrcaObstacles(scene.walls));
    for (int i = 0; i < scene.steps; ++i) crowd.step(scene.step);
    benchmark::DoNotOptimize(crowd.agents().data());
  }
  state.SetItemsProcessed(state.iterations() * scene.steps *
                          static_cast<std::int64_t>(scene.agents.size()));
}

// A flock that a robot drives through, again and again.
void flock(benchmark::State& state) {
  Scene scene = field(200);
  for (CrowdAgent& agent : scene.agents) {
    agent.kind = AgentKind::kSheep;
    agent.behaviour = Behaviour::kHerd;
  }
  Crowd crowd(scene.config, scene.agents);
  int i = 0;
  for (auto _ : state) {
    CrowdRobot robot;
    robot.position = {0.1 * (i++ % 1000), 50.0};
    robot.velocity = {1.0, 0.0};
    crowd.step(scene.step, {&robot, 1});
  }
  state.SetItemsProcessed(state.iterations() * 200);
}

// Agents among the rows of an orchard: 100 obstacles of four edges.
void orchard(benchmark::State& state) {
  Scene scene = field(200);
  scene.steps = 100;
  for (int i = 0; i < 100; ++i) {
    const double x = i;
    scene.walls.push_back({{x, 0.0}, {x + 0.1, 0.0}, {x + 0.1, 45.0}, {x, 45.0}});
  }
  run(state, scene);
}

BENCHMARK_CAPTURE(run, circle_of_250, circle())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, blocks_of_100, blocks())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, hectare_of_1000, field(1000))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, hectare_of_200, field(200))->Unit(benchmark::kMillisecond);
BENCHMARK(flock)->Unit(benchmark::kMicrosecond);
BENCHMARK(orchard)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace headland::bench

BENCHMARK_MAIN();
