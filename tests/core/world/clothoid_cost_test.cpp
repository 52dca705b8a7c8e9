// SPDX-License-Identifier: Apache-2.0
// What driving a clothoid costs: as many short arcs of its curvature.
#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "core/world/ground.hpp"

namespace headland {
namespace {

Path clothoid(double from, double to) {
  Path path;
  path.append({{5.0, 10.0, 0.4}, from, 30.0, Gear::kForward, 0, (to - from) / 30.0});
  return path;
}

Path short_arcs(const Path& path, int count) {
  Path arcs;
  const PathPiece& piece = path.pieces().front();
  const double step = piece.length / count;
  Pose2 pose = piece.start;
  for (int i = 0; i < count; ++i) {
    arcs.append({pose, piece.curvature_at((i + 0.5) * step), step, Gear::kForward, 0});
    pose = arcs.end_pose();
  }
  return arcs;
}

TEST(ClothoidCost, IsThatOfManyShortArcs) {
  Vehicle vehicle;
  vehicle.energy.turn_loss_ratio = 0.5;
  vehicle.energy.recuperation_efficiency_ratio = 0.5;
  HillSpec hills;
  hills.relief_m = 10.0;
  hills.cell_m = 1.0;
  const Ground slopes(Farm{}, Terrain::hills(hills, {-60.0, -60.0}, {60.0, 60.0}));
  for (const Ground& ground : {Ground(), slopes}) {
    for (const auto& [from, to] : {std::pair(0.0, 0.2), {-0.1, 0.3}, {0.3, -0.05}}) {
      const Path path = clothoid(from, to);
      const DriveCost cost = path_cost(vehicle, ground, path, LegKind::kTransit).value();
      const DriveCost arcs =
          path_cost(vehicle, ground, short_arcs(path, 600), LegKind::kTransit).value();
      EXPECT_NEAR(cost.length_m, 30.0, 1e-9);
      EXPECT_NEAR(cost.energy_j, arcs.energy_j, 0.01 * std::abs(arcs.energy_j));
    }
  }
}

}  // namespace
}  // namespace headland
