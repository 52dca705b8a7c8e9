// SPDX-License-Identifier: Apache-2.0
// What a turn of the simulated 16-beam lidar takes among rows; items are shots.
#include <benchmark/benchmark.h>

#include "sim/lidar/lidar.hpp"

namespace headland::bench {
namespace {

void scan(benchmark::State& state, double spacing, double length, const OrchardConfig& config) {
  RowLayout layout;
  layout.rows_count = 10;
  layout.spacing_m = spacing;
  layout.length_m = length;
  const LidarScene scene = LidarScene::rows(layout, config, 1);
  SensorMount mount;
  mount.z_m = 1.45;
  LidarSimulator lidar(LidarConfig(), mount, 7);
  const Eigen::Isometry3d pose = scene.pose_on_ground({30.0, 0.1, 0.03});
  LidarScan out;
  for (auto _ : state) {
    lidar.scan(
        scene, [&](double) { return pose; }, 0.0, out);
    benchmark::DoNotOptimize(out.points.data());
  }
  state.SetItemsProcessed(state.iterations() * 28800);
}

BENCHMARK_CAPTURE(scan, vineyard_in_leaf, 2.5, 65.0, vineyard(true))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan, vineyard_bare, 2.5, 65.0, vineyard(false))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan, orchard_in_leaf, 3.8, 130.0, fruit_orchard(true))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan, orchard_bare, 3.8, 130.0, fruit_orchard(false))
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace headland::bench

BENCHMARK_MAIN();
