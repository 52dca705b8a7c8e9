// SPDX-License-Identifier: Apache-2.0
// What costs along paths over terrain take to compute: 1 km each, on a grid of 1 m.
#include <benchmark/benchmark.h>

#include "core/world/ground.hpp"

namespace headland {
namespace {

const Point2 kCorner(-600.0, -600.0);

Farm farm_with_soils() {
  Farm farm;
  farm.roads.push_back({"road", {{-500.0, 0.0}, {500.0, 10.0}}, 4.0});
  for (int i = 0; i < 10; ++i) {
    const double x = -400.0 + 80.0 * i;
    farm.soils.push_back({"wet",
                          SoilClass::kSoft,
                          {{{x, -200.0}, {x + 50, -200.0}, {x + 50, 200.0}, {x, 200.0}}, {}}});
  }
  return farm;
}

Path straight() {
  Path path;
  path.append_straight({-490.0, 20.0, 0.01}, 1000.0, 0);
  return path;
}

Path winding() {
  Path path;
  Pose2 pose{-400.0, 0.0, 0.5};
  for (int i = 0; i < 100; ++i) {
    path.append(PathPiece{pose, i % 2 == 0 ? -0.1 : 0.1, 10.0, Gear::kForward, 0});
    pose = path.end_pose();
  }
  return path;
}

void cost_of(benchmark::State& state, const Farm& farm, const Path& path) {
  const Ground ground(farm, Terrain::hills({3, 30.0, 200.0, 1.0}, kCorner, -kCorner));
  const Vehicle vehicle;
  for (auto _ : state) {
    benchmark::DoNotOptimize(path_cost(vehicle, ground, path, LegKind::kTransit));
  }
}

void hills(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(Terrain::hills({3, 30.0, 200.0, 1.0}, kCorner, -kCorner));
  }
}

BENCHMARK_CAPTURE(cost_of, straight, Farm(), straight())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cost_of, winding, Farm(), winding())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cost_of, straight_over_soils, farm_with_soils(), straight())
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(hills)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace headland

BENCHMARK_MAIN();
