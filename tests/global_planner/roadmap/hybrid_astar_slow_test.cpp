// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdio>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "global_planner/roadmap/hybrid_astar.hpp"
#include "tests/global_planner/roadmap/yards.hpp"

namespace headland {
namespace {

constexpr double kSide = 100.0;  // [m]
constexpr int kObstacles = 20;
constexpr int kQueries = 200;

Region random_yard(RandomStream& random) {
  std::vector<Polygon> obstacles;
  for (int i = 0; i < kObstacles; ++i) {
    const double x = random.uniform(2.0, 86.0);
    const double y = random.uniform(2.0, 86.0);
    obstacles.push_back(
        test::box(x, y, x + random.uniform(2.0, 12.0), y + random.uniform(2.0, 12.0)));
  }
  return test::yard(kSide, obstacles);
}

Pose2 random_fitting_pose(RandomStream& random, const Region& area, const Vehicle& vehicle) {
  for (;;) {
    const Pose2 pose{random.uniform(0.0, kSide), random.uniform(0.0, kSide),
                     random.uniform(-kPi, kPi)};
    if (area.contains(pose, vehicle.footprint, HybridAstarOptions{}.margin_m)) return pose;
  }
}

void print_times(const char* name, std::vector<double> times) {
  std::sort(times.begin(), times.end());
  std::printf("%s: %zu queries, median %.1f ms, 90th percentile %.1f ms, worst %.1f ms\n", name,
              times.size(), 1e3 * times[times.size() / 2], 1e3 * times[times.size() * 9 / 10],
              1e3 * times.back());
}

// Ten yards of random boxes; every path found obeys the laws, and only few poses are hopeless.
void drive_random_yards(const char* name, const Vehicle& vehicle, int most_failures) {
  std::vector<double> times;
  int failures = 0;
  for (int y = 0; y < 10; ++y) {
    RandomStream random(static_cast<std::uint64_t>(y), "yards");
    const Region area = random_yard(random);
    const HybridAstar planner(area, vehicle);
    for (int q = 0; q < kQueries / 10; ++q) {
      const Pose2 from = random_fitting_pose(random, area, vehicle);
      const Pose2 to = random_fitting_pose(random, area, vehicle);
      const auto begin = std::chrono::steady_clock::now();
      const Result<Path> path = planner.plan(from, to);
      times.push_back(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
      failures += path ? 0 : 1;
      if (path) {
        EXPECT_EQ(test::complaint(*path, from, to, area, vehicle), "") << y << ", " << q;
      } else {
        std::printf("yard %d: %s\n", y, to_string(path.error()).c_str());
      }
    }
  }
  print_times(name, times);
  EXPECT_LE(failures, most_failures);
}

TEST(HybridAstarSlow, CrossesRandomYardsWithinTheLaws) {
  drive_random_yards("both gears", test::small_tractor(), 0);
}

TEST(HybridAstarSlow, CrossesRandomYardsForwards) {
  Vehicle vehicle = test::small_tractor();
  vehicle.can_reverse = false;
  drive_random_yards("forwards only", vehicle, kQueries / 10);  // poses before a wall are hopeless
}

}  // namespace
}  // namespace headland
