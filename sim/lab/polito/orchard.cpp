// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/polito/orchard.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace headland {

std::optional<Error> ParametricOrchardConfig::check() const {
  if (row_width_m >= pitch()) {
    return Error{ErrorCode::kBadGeometry,
                 fmt::format("tree rows {} m wide fill the pitch of {} m", row_width_m, pitch()),
                 "make the rows narrower, fewer, or the field wider",
                 {{}, 0, "row_width_m"}};
  }
  if (row_end() > field_length_m) {
    return Error{ErrorCode::kBadGeometry,
                 fmt::format("the tree rows end at {} m, outside the field of {} m", row_end(),
                             field_length_m),
                 "row_start_m + row_length_m <= field_length_m",
                 {{}, 0, "row_length_m"}};
  }
  return std::nullopt;
}

OrchardGrid rasterize(const ParametricOrchardConfig& orchard, double cells_per_m2) {
  OrchardGrid grid;
  grid.cell_m = 1.0 / std::sqrt(cells_per_m2);
  grid.columns = static_cast<int>(std::ceil(orchard.field_width_m / grid.cell_m - 1e-9));
  grid.rows = static_cast<int>(std::ceil(orchard.field_length_m / grid.cell_m - 1e-9));
  grid.cells.reserve(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
  for (int row = 0; row < grid.rows; ++row) {
    const double y = (row + 0.5) * grid.cell_m;
    const bool along = y >= orchard.row_start_m && y <= orchard.row_end();
    for (int column = 0; column < grid.columns; ++column) {
      const double x = (column + 0.5) * grid.cell_m;
      const int nearest = std::clamp(static_cast<int>(std::lround(x / orchard.pitch())) - 1, 0,
                                     orchard.tree_rows_count - 1);
      const bool across = std::abs(x - orchard.tree_row_x(nearest)) <= 0.5 * orchard.row_width_m;
      grid.cells.push_back(along && across ? 1 : 0);
    }
  }
  return grid;
}

std::optional<ThreePointArc> arc_through(const Point2& from, const Point2& apex, const Point2& to) {
  const Point2 a = apex - from;
  const Point2 b = to - from;
  const double cross = a.x() * b.y() - a.y() * b.x();
  if (std::abs(cross) <= 1e-12 * a.norm() * b.norm()) return std::nullopt;
  // The circumcentre of the three points, seen from the first.
  const Point2 center = Point2(b.y() * a.squaredNorm() - a.y() * b.squaredNorm(),
                               a.x() * b.squaredNorm() - b.x() * a.squaredNorm()) /
                        (2.0 * cross);
  const double side = cross > 0.0 ? 1.0 : -1.0;  // the points turn to the left, or to the right
  const double radius = center.norm();
  const auto bearing = [&](const Point2& p) {
    return std::atan2(p.y() - center.y(), p.x() - center.x());
  };
  const double start = bearing({0.0, 0.0});
  const double turn = wrap_positive(side * (bearing(b) - start), 1e-12);
  ThreePointArc arc;
  arc.start = {from.x(), from.y(), wrap_angle(start + side * 0.5 * kPi)};
  arc.curvature = side / radius;
  arc.length = radius * turn;
  return arc;
}

Result<OrchardPath> plan_orchard(const ParametricOrchardConfig& orchard) {
  if (auto error = orchard.check()) return tl::unexpected<Error>(*error);
  const double half = 0.5 * orchard.pitch();
  const double room = std::min(orchard.row_start_m, orchard.field_length_m - orchard.row_end());
  if (half > room) {
    return fail(ErrorCode::kTurnDoesNotFit,
                fmt::format("the hairpin needs {} m beyond the tree rows, the headland has {} m",
                            half, room),
                "shorten row_length_m or add tree rows");
  }
  OrchardPath plan;
  const auto leg = [&plan](LegKind kind) {
    plan.legs.push_back(kind);
    return static_cast<int>(plan.legs.size()) - 1;
  };
  Pose2 at{orchard.alley_x(0), 0.0, 0.5 * kPi};
  plan.checkpoints.push_back(at.position());
  plan.path.append_straight(at, orchard.row_start_m, leg(LegKind::kTransit));
  for (int alley = 0; alley < orchard.alleys(); ++alley) {
    const bool up = alley % 2 == 0;
    const double x = orchard.alley_x(alley);
    const double exit_y = up ? orchard.row_end() : orchard.row_start_m;
    at = {x, up ? orchard.row_start_m : orchard.row_end(), up ? 0.5 * kPi : -0.5 * kPi};
    plan.checkpoints.push_back(at.position());
    plan.path.append_straight(at, orchard.row_length_m, leg(LegKind::kRow));
    plan.checkpoints.emplace_back(x, exit_y);
    if (alley + 1 == orchard.alleys()) {
      const double out = up ? orchard.field_length_m - exit_y : exit_y;
      plan.path.append_straight({x, exit_y, at.yaw}, out, leg(LegKind::kTransit));
      plan.checkpoints.emplace_back(x, up ? orchard.field_length_m : 0.0);
      break;
    }
    const Point2 apex(x + half, exit_y + (up ? half : -half));
    plan.checkpoints.push_back(apex);
    const auto arc = arc_through({x, exit_y}, apex, {x + orchard.pitch(), exit_y});
    HEADLAND_CHECK(arc.has_value(), "the points of a hairpin lie on a line");
    plan.path.append(
        {arc->start, arc->curvature, arc->length, Gear::kForward, leg(LegKind::kTurn)});
  }
  return plan;
}

std::vector<Point2> waypoints(const Path& path, double pitch) {
  const int gaps = std::max(1, static_cast<int>(std::lround(path.length() / pitch)));
  std::vector<Point2> points;
  points.reserve(static_cast<std::size_t>(gaps) + 1);
  for (int i = 0; i <= gaps; ++i) {
    points.push_back(path.at(path.length() * i / gaps).pose.position());
  }
  return points;
}

}  // namespace headland
