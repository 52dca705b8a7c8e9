// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/base/random.hpp"
#include "core/geometry/region.hpp"
#include "core/world/ground.hpp"
#include "global_planner/roadmap/goal_graph.hpp"
#include "tests/support/outline_checker.hpp"

// Fields to plan on, and an independent judge of the paths there.
namespace headland::test {

inline Polygon box(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

/// A square field with keep-outs. Holds the farm, for the judge, and what planners want of it.
struct Field {
  Farm farm;
  Region region;
  Ground ground;

  Field(double side, const std::vector<Polygon>& keep_outs, std::optional<Terrain> terrain = {}) {
    farm.free_parcels.push_back({"field", box(0.0, 0.0, side, side)});
    for (const Polygon& polygon : keep_outs) farm.keep_outs.push_back({"keep out", polygon});
    region = Region(drivable_area(farm));
    ground = Ground(farm, std::move(terrain));
  }
};

/// Boxes strewn over a square field.
inline std::vector<Polygon> strewn_boxes(double side, int count, double smallest, double largest) {
  RandomStream random(5, "boxes");
  std::vector<Polygon> boxes;
  for (int i = 0; i < count; ++i) {
    const double w = random.uniform(smallest, largest);
    const double h = random.uniform(smallest, largest);
    const double x = random.uniform(0.05, 0.9) * side;
    const double y = random.uniform(0.05, 0.9) * side;
    boxes.push_back(box(x, y, x + w, y + h));
  }
  return boxes;
}

/// Terrain of a formula over a square field, with a rim around it.
template <class Height>
Terrain terrain_of(double side, double cell, Height height) {
  const double rim = 10.0;
  const int count = static_cast<int>((side + 2.0 * rim) / cell) + 1;
  std::vector<double> heights;
  for (int row = 0; row < count; ++row) {
    for (int column = 0; column < count; ++column) {
      heights.push_back(height(column * cell - rim, row * cell - rim));
    }
  }
  return Terrain::from_grid({-rim, -rim}, cell, count, count, std::move(heights));
}

inline Vehicle robot() {
  Vehicle vehicle;
  vehicle.name = "robot";
  return vehicle;
}

/// Places with room to turn, driven into and out of in the same heading.
inline std::vector<Site> random_goals(const Field& field, const Vehicle& vehicle, double side,
                                      int count) {
  RandomStream random(9, "goals");
  std::vector<Site> goals;
  while (static_cast<int>(goals.size()) < count) {
    const Pose2 pose{random.uniform(0.0, side), random.uniform(0.0, side),
                     random.uniform(-kPi, kPi)};
    Path here;
    here.append_straight(pose, 1e-3, 0);
    if (!field.region.contains(pose, vehicle.footprint, 2.5 * vehicle.turning_radius())) continue;
    if (check_slopes(vehicle, field.ground, here)) continue;
    goals.push_back({pose, pose, fmt::format("goal {}", goals.size())});
  }
  return goals;
}

/// Empty if the path is one that the vehicle can drive forwards: it bends no more than the turning
/// radius allows, its pieces join, pitch and roll are within the vehicle's limits.
inline std::string drive_complaint(const Vehicle& vehicle, const Ground& ground, const Path& path,
                                   double spacing) {
  const double most = 1.0 / vehicle.turning_radius();
  const PathPiece* before = nullptr;
  for (const PathPiece& piece : path.pieces()) {
    if (piece.gear != Gear::kForward) return "reverses";
    if (std::abs(piece.curvature) > most * (1.0 + 1e-12) ||
        std::abs(piece.end_curvature()) > most * (1.0 + 1e-9)) {
      return fmt::format("bends by {} and {} 1/m", piece.curvature, piece.end_curvature());
    }
    if (before) {
      const Pose2 end = before->pose_at(before->length);
      const double gap = (end.position() - piece.start.position()).norm();
      if (gap > 1e-7 || std::abs(wrap_angle(end.yaw - piece.start.yaw)) > 1e-7) {
        return fmt::format("a gap of {} m", gap);
      }
    }
    before = &piece;
  }
  for (const PathSample& sample : path.sample(spacing)) {
    const auto here = ground.sample(sample.pose.position());
    if (!here) return fmt::format("off the terrain at s = {:.2f} m", sample.s);
    const double pitch = std::atan(here->gradient.dot(sample.pose.heading()));
    const double roll = std::atan(here->gradient.dot(sample.pose.left()));
    if (std::abs(rad_to_deg(pitch)) > vehicle.max_pitch_deg ||
        std::abs(rad_to_deg(roll)) > vehicle.max_roll_deg) {
      return fmt::format("pitch {:.2f}, roll {:.2f} deg at s = {:.2f} of {:.2f} m",
                         rad_to_deg(pitch), rad_to_deg(roll), sample.s, path.length());
    }
  }
  return {};
}

}  // namespace headland::test
