// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "core/geometry/path.hpp"
#include "core/model/drive_cost.hpp"

namespace headland {

/// The parametric orchard of (004) Sec. 2.2; the defaults are its Fig. 4. The field spans
/// [0, field_width] x [0, field_length] in `map`; tree rows run along y.
struct ParametricOrchardConfig {
  int tree_rows_count = 9;        ///< n
  double row_width_m = 2.0;       ///< w
  double row_length_m = 80.0;     ///< l
  double field_width_m = 100.0;   ///< L1
  double field_length_m = 100.0;  ///< L2
  double row_start_m = 10.0;      ///< Ys: where the tree rows begin

  int alleys() const { return tree_rows_count + 1; }                   ///< N, (004) Eq. 3
  double pitch() const { return field_width_m / alleys(); }            ///< P [m], (004) Eq. 4
  double row_end() const { return row_start_m + row_length_m; }        ///< [m]
  double alley_x(int alley) const { return (alley + 0.5) * pitch(); }  ///< its middle [m]
  double tree_row_x(int row) const { return (row + 1) * pitch(); }     ///< its middle [m]

  std::optional<Error> check() const;

  template <class V>
  void visit(V& v) {
    v("tree_rows_count", tree_rows_count, config::Range{1, 1000}, "n: rows of trees");
    v("row_width_m", row_width_m, config::kPositive, "w: width of a tree row [m]");
    v("row_length_m", row_length_m, config::kPositive, "l: length of a tree row [m]");
    v("field_width_m", field_width_m, config::kPositive, "L1: across the rows [m]");
    v("field_length_m", field_length_m, config::kPositive, "L2: along the rows [m]");
    v("row_start_m", row_start_m, config::kNonNegative, "Ys: where the tree rows begin [m]");
  }
};

/// The map matrix of (004) Fig. 2: 1 where trees stand, 0 where the rover may drive; row by row
/// from y = 0.
struct OrchardGrid {
  int columns = 0;
  int rows = 0;
  double cell_m = 0.0;
  std::vector<std::uint8_t> cells;

  std::uint8_t at(int column, int row) const {
    return cells[static_cast<std::size_t>(row * columns + column)];
  }
};
/// `cells_per_m2`: m, the mesh refinement; a cell is occupied when its centre lies in a tree row.
OrchardGrid rasterize(const ParametricOrchardConfig& orchard, double cells_per_m2);

/// The rover's way through all alleys, and the kind of each of its legs.
struct OrchardPath {
  Path path;
  std::vector<LegKind> legs;
  std::vector<Point2> checkpoints;  ///< the red stars of (004) Fig. 6
};

/// (004) Sec. 2.3: straight up and down the alleys, from the field's edge in the first alley to the
/// edge where the last one leads, with a three-point arc around the end of each tree row.
/// @return kTurnDoesNotFit when the headland is shorter than half the pitch.
Result<OrchardPath> plan_orchard(const ParametricOrchardConfig& orchard);

/// The circular arc from `from` to `to` through `apex`, driven forward.
struct ThreePointArc {
  Pose2 start;
  double curvature = 0.0;  ///< [1/m]
  double length = 0.0;     ///< [m]
};
/// Nothing when the three points lie on a line.
std::optional<ThreePointArc> arc_through(const Point2& from, const Point2& apex, const Point2& to);

/// Waypoints along a path at equal driven distances, both ends included: WPP is the path's length
/// over the number of gaps, the nearest to `pitch` [m] that fits ((004) Sec. 3).
std::vector<Point2> waypoints(const Path& path, double pitch);

}  // namespace headland
