// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/curve.hpp"
#include "core/geometry/region.hpp"
#include "core/model/vehicle.hpp"
#include "core/world/farm.hpp"

namespace headland::coverage {

/// Rows that a way joins: it may be inside their bodies, but not cross their sides. -1: none.
struct OwnRows {
  int first = -1;
  int second = -1;
  bool has(int row) const { return row == first || row == second; }
};

/// In which sense a track is driven. Driven back from its end to its start, the vehicle looks the
/// other way, so that its front takes the place of its rear; kBoth asks for both at once.
enum class Travel { kForth, kBack, kBoth };

/// A row and how much ground it takes.
struct RowBody {
  Polyline line;         ///< [m, map]
  double spacing = 0.0;  ///< from side to side [m]
};

inline constexpr double kSlit = 0.02;  ///< [m] between the bodies of neighbouring rows

/// Where the outline of one vehicle may be outside rows: the drivable area less the rows' bodies.
/// Thread-safe; queries do not allocate.
class FreeSpace {
 public:
  /// @param margin     Kept to the edge of the drivable area [m].
  /// @param row_margin Kept to the bodies of rows [m].
  FreeSpace(const std::vector<Polygon>& drivable, const std::vector<RowBody>& rows,
            const Footprint& outline, double margin, double row_margin);

  bool fits(const Pose2& pose, Travel travel, OwnRows own) const;
  /// The whole band that the outline sweeps along a straight line of signed `length` [m]; exact.
  bool fits_straight(const Pose2& from, double length, Travel travel, OwnRows own) const;
  /// The outline along the whole curve. Arcs and clothoids are sampled so densely that no point of
  /// the outline moves by more than twice the margin between two samples: a sample vouches, with
  /// its margin, for the outline halfway to its neighbours. Samples run from coarse to fine, so
  /// that a curve that does not fit is found out early.
  bool fits(const Pose2& from, const Curve& curve, Travel travel, OwnRows own) const;
  /// How far the outline can run straight on from `from`: the largest multiple of `step` up to
  /// `most` [m]; -1 if it does not even fit there.
  double free_run(const Pose2& from, double most, double step, Travel travel, OwnRows own) const;
  /// How far the outline with its margin reaches out of a curve of that radius, to its outer side
  /// [m].
  double swing(double radius) const;
  /// Length [m] of the strip as wide as the vehicle that is free ahead of `from`, up to `most`; for
  /// messages.
  double room_ahead(const Pose2& from, double most, OwnRows own) const;
  const Footprint& outline() const { return outline_; }
  const std::vector<Polygon>& drivable() const { return area_.polygons(); }
  /// The row whose body holds `p`, or -1.
  int row_at(const Point2& p) const;

 private:
  // One straight stretch of a row's body.
  struct Slab {
    Point2 center;
    Point2 axis;
    double half_length = 0.0;
    double half_width = 0.0;
    double side = 0.0;  // from the centre line to the row's sides [m]
    int row = -1;
  };
  Footprint outline(Travel travel) const;
  bool fits(const Pose2& pose, const Footprint& shape, OwnRows own) const;
  bool clear_of_rows(const Pose2& pose, const Footprint& shape, double margin, OwnRows own) const;
  void enter_slabs();
  std::size_t cell_index(int column, int row) const {
    return static_cast<std::size_t>(row * columns_ + column);
  }

  Region area_;
  Footprint outline_;
  double margin_;
  double row_margin_;
  double arc_step_;  // largest movement of a point of the outline between two samples [m]
  std::vector<Slab> slabs_;
  Point2 corner_{0.0, 0.0};  // of the grid of slabs, lower left
  int columns_ = 0;
  int grid_rows_ = 0;
  std::vector<int> cell_begin_;
  std::vector<int> cell_slabs_;
};

}  // namespace headland::coverage
