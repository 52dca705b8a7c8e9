// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/geometry/path.hpp"
#include "core/geometry/region.hpp"

// Yards with obstacles, and what every path through them must obey.
namespace headland::test {

inline Polygon box(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

/// A square yard from (0, 0), less obstacles.
inline Region yard(double side, const std::vector<Polygon>& obstacles) {
  return Region(subtract({box(0.0, 0.0, side, side)}, obstacles));
}

/// A small tractor: 3 m long, 1.4 m wide, turning radius 2.5 m.
inline Vehicle small_tractor() {
  Vehicle vehicle;
  vehicle.name = "tractor";
  vehicle.min_turning_radius_m = 2.5;
  vehicle.wheelbase_m = 1.5;
  vehicle.footprint = {2.2, 0.8, 1.4};
  return vehicle;
}

/// Empty if the path joins the poses exactly, never bends tighter than the vehicle can, reverses
/// only if it may, and keeps the outline in the area; else what it breaks. It looks at the outline
/// every 2 cm, point by point, with no margin and nothing shared with the planner.
inline std::string complaint(const Path& path, const Pose2& from, const Pose2& to,
                             const Region& area, const Vehicle& vehicle) {
  const auto apart = [](const Pose2& a, const Pose2& b) {
    return (a.position() - b.position()).norm() + std::abs(wrap_angle(a.yaw - b.yaw));
  };
  if (path.empty()) return "empty";
  if (!(apart(path.start_pose(), from) < 1e-9)) return "does not start where it should";
  if (!(apart(path.end_pose(), to) < 1e-7)) return "does not end where it should";
  for (const PathPiece& piece : path.pieces()) {
    if (std::abs(piece.curvature) * vehicle.turning_radius() > 1.0 + 1e-12) return "too tight";
    if (piece.gear == Gear::kReverse && !vehicle.can_reverse) return "reverses";
  }
  const Footprint& outline = vehicle.footprint;
  for (const PathSample& sample : path.sample(0.02)) {
    for (int i = 0; i <= 12; ++i) {
      const double x = -outline.rear_m + (outline.front_m + outline.rear_m) * i / 12;
      const double y = outline.width_m * (i / 12.0 - 0.5);
      const double half = 0.5 * outline.width_m;
      for (const Point2& p : {Point2(x, half), Point2(x, -half), Point2(outline.front_m, y),
                              Point2(-outline.rear_m, y)}) {
        const Point2 p_map = sample.pose * p;
        if (!area.contains(p_map)) {
          return fmt::format("at s = {:.2f} of {:.2f} m, ({:.2f}, {:.2f}) is outside", sample.s,
                             path.length(), p_map.x(), p_map.y());
        }
      }
    }
  }
  return {};
}

}  // namespace headland::test
