// SPDX-License-Identifier: Apache-2.0
// A roadmap of 2 000 samples on a square kilometre: its time, and every edge checked.
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "global_planner/roadmap/roadmap.hpp"
#include "tests/global_planner/roadmap/fields.hpp"

namespace headland {
namespace {

using namespace test;

constexpr double kSide = 1000.0;

// Processor time [s] of this process, which other processes disturb less than the clock on the
// wall.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Plan {
  Roadmap roadmap;
  GoalGraph ways;
  double seconds = 0.0;
};

Plan plan(const Field& field, const Vehicle& vehicle, const std::vector<Site>& goals,
          const RoadmapOptions& options) {
  const double begin = processor_seconds();
  Roadmap roadmap = Roadmap::build(field.region, field.ground, vehicle, options).value();
  GoalGraph ways = roadmap.connect(goals).value();
  return {std::move(roadmap), std::move(ways), processor_seconds() - begin};
}

TEST(SquareKilometre, IsPlannedInFiveSecondsAndAgainInHalfASecond) {
  HillSpec hills;
  hills.relief_m = 15.0;
  hills.cell_m = 1.0;
  const Field field(kSide, strewn_boxes(kSide, 30, 10.0, 60.0),
                    Terrain::hills(hills, {-10.0, -10.0}, {kSide + 10.0, kSide + 10.0}));
  Vehicle vehicle = robot();
  vehicle.energy.recuperation_efficiency_ratio = 0.5;
  const std::vector<Site> goals = random_goals(field, vehicle, kSide, 12);
  RoadmapOptions options;
  options.cache =
      std::filesystem::temp_directory_path() / fmt::format("headland_roadmap_slow_{}", ::getpid());
  std::filesystem::remove_all(options.cache);
  const Plan first = plan(field, vehicle, goals, options);
  const Plan second = plan(field, vehicle, goals, options);
  std::filesystem::remove_all(options.cache);
  std::printf("2000 samples on 1 km2, 12 goals: %.2f s, %d edges; from the cache %.3f s\n",
              first.seconds, first.roadmap.edges(), second.seconds);
  EXPECT_EQ(first.roadmap.nodes(), 2000);
  EXPECT_TRUE(second.roadmap.from_cache());
  EXPECT_LT(first.seconds, 2.0 * 5.0);
  EXPECT_LT(second.seconds, 2.0 * 0.5);

  OutlineChecker checker(field.farm, {}, 0.0, vehicle.footprint);
  const std::vector<Path> edges = first.roadmap.edge_paths();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    ASSERT_EQ(drive_complaint(vehicle, field.ground, edges[i], 0.4), "") << "edge " << i;
    if (i % 4 == 0) {
      ASSERT_EQ(checker.complaint(edges[i], {}), "") << "edge " << i;
    }
  }
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) {
      if (i == j) continue;
      const GoalGraph::Edge& edge = first.ways.edge(i, j);
      ASSERT_FALSE(edge.path.empty()) << i << " to " << j;
      ASSERT_EQ(drive_complaint(vehicle, field.ground, edge.path, 0.3), "") << i << " to " << j;
      ASSERT_EQ(edge.cost.energy_j, second.ways.edge(i, j).cost.energy_j);
    }
  }
}

TEST(SquareKilometre, WaysOfTheRoadmapAloneAreLittleLongerThanStraightLines) {
  const Field field(kSide, {});
  const Vehicle vehicle = robot();
  // More goals than are joined directly, each pair of them far apart.
  const std::vector<Site> goals = random_goals(field, vehicle, kSide, 60);
  RoadmapOptions options;
  const Plan made = plan(field, vehicle, goals, options);
  double sum = 0.0;
  double most = 0.0;
  int count = 0;
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) {
      const double straight = (goals[static_cast<std::size_t>(i)].depart.position() -
                               goals[static_cast<std::size_t>(j)].arrive.position())
                                  .norm();
      if (straight < 300.0) continue;
      const double ratio = made.ways.edge(i, j).cost.length_m / straight;
      sum += ratio;
      most = std::max(most, ratio);
      ++count;
    }
  }
  std::printf("%d ways over straight lines: mean %.3f, most %.3f\n", count, sum / count, most);
  EXPECT_LT(sum / count, 1.15);
  EXPECT_LT(most, 1.3);
}

}  // namespace
}  // namespace headland
