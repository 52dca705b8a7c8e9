// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "control/pure_pursuit/seed_pure_pursuit.hpp"
#include "core/config/visit.hpp"
#include "core/geometry/path.hpp"
#include "core/model/drive_cost.hpp"
#include "global_planner/tour/row_tour.hpp"

namespace headland {

/// Seed 002's field: rows along y from y = 0, their middles W / 2, 3 W / 2, ... in x; the depot
/// stands 3 W to the left of the field at half a row's length, facing the field. (002) part A
struct Ebs221Field {
  int rows_count = 10;                ///< N
  double row_width_m = 2.5;           ///< W
  double row_length_m = 20.0;         ///< RL
  double planning_wheelbase_m = 3.0;  ///< of the turning radius; the drives have 2.5 m

  double row_x(int row) const { return (row + 0.5) * row_width_m; }  ///< row: from 0 [m]
  Pose2 depot() const { return {-3.0 * row_width_m, 0.5 * row_length_m, 0.0}; }
  /// R = L / tan(steering limit) [m].
  double radius(double max_steering_deg) const;

  template <class V>
  void visit(V& v) {
    v("rows_count", rows_count, config::Range{1, 16}, "N: rows");
    v("row_width_m", row_width_m, config::kPositive, "W: between the middles of two rows [m]");
    v("row_length_m", row_length_m, config::kPositive, "RL: length of a row [m]");
    v("planning_wheelbase_m", planning_wheelbase_m, config::kPositive,
      "L of the turning radius in plans [m]");
  }
};

/// Rows (counted from 0) in the order of work.
using RowOrder = std::vector<RowVisit>;

/// The order that alternates the direction from row to row. `rows`: counted from 1, as (002) does.
RowOrder alternating_order(const std::vector<int>& rows, bool first_from_top);

/// One link of the drive: from the depot, a row, a turn, ..., back to the depot.
struct FieldLink {
  Pose2 from;
  Pose2 to;
  LegKind kind = LegKind::kRow;  ///< the ways from and to the depot are transits
};
std::vector<FieldLink> field_links(const Ebs221Field& field, const RowOrder& order);

enum class TurnShape {
  kDubins,
  kFishtail,  ///< where it is shorter: between rows nearer than 2 R; Dubins elsewhere
};

/// The drive as an exact path; leg numbers are link numbers.
struct FieldPath {
  Path path;
  std::vector<LegKind> kinds;
};
FieldPath field_path(const std::vector<FieldLink>& links, double radius, TurnShape shape);

/// Spacing of seed 002's waypoints.
inline constexpr double kSeedRowSpacing = 0.5;    // [m]; a row has ceil(length / this) points
inline constexpr double kSeedTurnSpacing = 0.25;  // [m]

/// The same drive as the waypoints of (002) part C: the first point of each link left out, the
/// ends of curves left out too where the spacing does not meet them. With kFishtail, turns between
/// rows nearer than 2 R get the points of (002)'s fishtail, see seed_fishtail_points().
SeedRoute seed_route(const std::vector<FieldLink>& links, double radius, double middle_y,
                     TurnShape shape = TurnShape::kDubins);

/// True for a turn between rows nearer than 2 R, which (002) drives as a fishtail.
bool seed_fishtails(const FieldLink& link, double radius);

/// The points of (002)'s fishtail, the first left out: its two quarter circles each run out and
/// back on themselves, so that it only gets to the next row by its last point.
std::vector<Point2> seed_fishtail_points(const FieldLink& link, double radius);

/// Kinds of a route's links as (002) counts them: the ways from and to the depot are turns.
std::vector<LegKind> seed_kinds(const SeedRoute& route);

}  // namespace headland
