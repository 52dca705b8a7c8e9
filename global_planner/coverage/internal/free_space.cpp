// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/internal/free_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace headland::coverage {
namespace {

constexpr double kCell = 4.0;              // [m] of the grid of slabs
constexpr double kSmallestArcStep = 0.05;  // [m]
constexpr double kTouch = 1e-9;            // [m] an outline may touch a body

// A rectangle: centre, unit axis along its length, half its sizes.
struct Box {
  Point2 center;
  Point2 axis;
  double half_length;
  double half_width;

  Point2 reach() const {
    return {std::abs(axis.x()) * half_length + std::abs(axis.y()) * half_width,
            std::abs(axis.y()) * half_length + std::abs(axis.x()) * half_width};
  }
};

// Separating axes of two rectangles: the two of each.
bool overlap(const Box& a, const Box& b) {
  const Point2 d = b.center - a.center;
  const double c = std::abs(a.axis.dot(b.axis));
  const double s = std::abs(a.axis.x() * b.axis.y() - a.axis.y() * b.axis.x());
  const auto along = [&d](const Box& box) { return std::abs(d.dot(box.axis)); };
  const auto across = [&d](const Box& box) {
    return std::abs(d.y() * box.axis.x() - d.x() * box.axis.y());
  };
  return along(a) < a.half_length + b.half_length * c + b.half_width * s &&
         across(a) < a.half_width + b.half_length * s + b.half_width * c &&
         along(b) < b.half_length + a.half_length * c + a.half_width * s &&
         across(b) < b.half_width + a.half_length * s + a.half_width * c;
}

// Samples of an arc or clothoid so that no point of the outline moves farther than `step` between
// them.
int arc_samples(const CurvePiece& piece, const Footprint& outline, double step) {
  const double radius = 1.0 / piece.max_abs_curvature();
  const double corner =
      std::hypot(radius + 0.5 * outline.width_m, std::max(outline.front_m, outline.rear_m));
  const double moved = std::abs(piece.length) * corner / radius;
  return std::max(1, static_cast<int>(std::ceil(moved / step)));
}

// A pose on a piece, to a micrometre on clothoids: three nodes of Gauss' quadrature, as the samples
// of a curve are many.
Pose2 sample_pose(const CurvePiece& piece, const Pose2& start, double u) {
  constexpr double kMostTurn = 1.0;  // [rad] of a stretch
  const double turn = piece.max_abs_curvature() * std::abs(u);
  if (piece.sharpness == 0.0 || turn > kMostTurn) return piece.pose_at(start, u);
  constexpr double kNode = 0.7745966692414834;
  const auto yaw = [&](double t) {
    return start.yaw + (piece.curvature + 0.5 * piece.sharpness * t) * t;
  };
  Point2 sum(0.0, 0.0);
  for (const auto& [place, weight] :
       {std::pair(-kNode, 5.0), std::pair(0.0, 8.0), std::pair(kNode, 5.0)}) {
    const double angle = yaw(0.5 * u * (1.0 + place));
    sum += weight * Point2(std::cos(angle), std::sin(angle));
  }
  return {start.x + u / 18.0 * sum.x(), start.y + u / 18.0 * sum.y(), yaw(u)};
}

}  // namespace

FreeSpace::FreeSpace(const std::vector<Polygon>& drivable, const std::vector<RowBody>& rows,
                     const Footprint& outline, double margin, double row_margin)
    : area_(drivable),
      outline_(outline),
      margin_(margin),
      row_margin_(row_margin),
      arc_step_(std::max(2.0 * std::min(margin, row_margin), kSmallestArcStep)) {
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Polyline& line = rows[r].line;
    for (std::size_t i = 1; i < line.size(); ++i) {
      const double length = (line[i] - line[i - 1]).norm();
      if (length <= 0.0) continue;
      slabs_.push_back({0.5 * (line[i] + line[i - 1]), (line[i] - line[i - 1]) / length,
                        0.5 * length, 0.5 * (rows[r].spacing - kSlit), 0.5 * rows[r].spacing,
                        static_cast<int>(r)});
    }
  }
  if (!slabs_.empty()) enter_slabs();
}

void FreeSpace::enter_slabs() {
  const auto box_of = [](const Slab& s) { return Box{s.center, s.axis, s.half_length, s.side}; };
  Point2 low = slabs_.front().center;
  Point2 high = low;
  for (const Slab& slab : slabs_) {
    low = low.cwiseMin(slab.center - box_of(slab).reach());
    high = high.cwiseMax(slab.center + box_of(slab).reach());
  }
  corner_ = low;
  columns_ = static_cast<int>((high.x() - low.x()) / kCell) + 1;
  grid_rows_ = static_cast<int>((high.y() - low.y()) / kCell) + 1;
  std::vector<std::vector<int>> cells(static_cast<std::size_t>(columns_ * grid_rows_));
  for (std::size_t i = 0; i < slabs_.size(); ++i) {
    const Box box = box_of(slabs_[i]);
    const Point2 first = (box.center - box.reach() - corner_) / kCell;
    const Point2 last = (box.center + box.reach() - corner_) / kCell;
    for (int row = static_cast<int>(first.y()); row <= static_cast<int>(last.y()); ++row) {
      for (int col = static_cast<int>(first.x()); col <= static_cast<int>(last.x()); ++col) {
        const Box cell{corner_ + kCell * Point2(col + 0.5, row + 0.5),
                       {1.0, 0.0},
                       0.5 * kCell + kTouch,
                       0.5 * kCell + kTouch};
        if (overlap(box, cell)) cells[cell_index(col, row)].push_back(static_cast<int>(i));
      }
    }
  }
  cell_begin_.reserve(cells.size() + 1);
  for (const auto& cell : cells) {
    cell_begin_.push_back(static_cast<int>(cell_slabs_.size()));
    cell_slabs_.insert(cell_slabs_.end(), cell.begin(), cell.end());
  }
  cell_begin_.push_back(static_cast<int>(cell_slabs_.size()));
}

Footprint FreeSpace::outline(Travel travel) const {
  Footprint f = outline_;
  if (travel == Travel::kBack) std::swap(f.front_m, f.rear_m);
  if (travel == Travel::kBoth) f.front_m = f.rear_m = std::max(f.front_m, f.rear_m);
  return f;
}

bool FreeSpace::clear_of_rows(const Pose2& pose, const Footprint& shape, double margin,
                              OwnRows own) const {
  if (slabs_.empty()) return true;
  const Point2 axis = pose.heading();
  const Box box{pose.position() + 0.5 * (shape.front_m - shape.rear_m) * axis, axis,
                0.5 * (shape.front_m + shape.rear_m) + margin - kTouch,
                0.5 * shape.width_m + margin - kTouch};
  const Point2 low = (box.center - box.reach() - corner_) / kCell;
  const Point2 high = (box.center + box.reach() - corner_) / kCell;
  if (!(high.x() >= 0.0 && high.y() >= 0.0 && low.x() < columns_ && low.y() < grid_rows_)) {
    return true;
  }
  const int first_col = std::max(0, static_cast<int>(low.x()));
  const int last_col = std::min(columns_ - 1, static_cast<int>(high.x()));
  const int last_row = std::min(grid_rows_ - 1, static_cast<int>(high.y()));
  for (int row = std::max(0, static_cast<int>(low.y())); row <= last_row; ++row) {
    const int begin = cell_begin_[cell_index(first_col, row)];
    const int end = cell_begin_[cell_index(last_col, row) + 1];
    for (int k = begin; k < end; ++k) {
      const int index = cell_slabs_[static_cast<std::size_t>(k)];
      const Slab& slab = slabs_[static_cast<std::size_t>(index)];
      if (!own.has(slab.row)) {
        if (overlap(box, {slab.center, slab.axis, slab.half_length, slab.half_width})) return false;
        continue;
      }
      const Point2 side = slab.side * Point2(-slab.axis.y(), slab.axis.x());
      if (overlap(box, {slab.center + side, slab.axis, slab.half_length, 0.0}) ||
          overlap(box, {slab.center - side, slab.axis, slab.half_length, 0.0})) {
        return false;
      }
    }
  }
  return true;
}

bool FreeSpace::fits(const Pose2& pose, const Footprint& shape, OwnRows own) const {
  return clear_of_rows(pose, shape, row_margin_, own) && area_.contains(pose, shape, margin_);
}

bool FreeSpace::fits(const Pose2& pose, Travel travel, OwnRows own) const {
  return fits(pose, outline(travel), own);
}

bool FreeSpace::fits_straight(const Pose2& from, double length, Travel travel, OwnRows own) const {
  Footprint swept = outline(travel);
  swept.front_m += std::max(length, 0.0);
  swept.rear_m += std::max(-length, 0.0);
  return fits(from, swept, own);
}

bool FreeSpace::fits(const Pose2& from, const Curve& curve, Travel travel, OwnRows own) const {
  const Footprint shape = outline(travel);
  std::array<Pose2, Curve::kMaxPieces> starts;
  std::array<int, Curve::kMaxPieces> counts{};
  Pose2 pose = from;
  int most = 1;
  for (int i = 0; i < curve.count(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const CurvePiece& piece = curve.begin()[i];
    starts[at] = pose;
    pose = sample_pose(piece, pose, piece.length);
    if (piece.curvature == 0.0 && piece.sharpness == 0.0) {
      if (!fits_straight(starts[at], piece.length, travel, own)) return false;
    } else {
      counts[at] = arc_samples(piece, shape, arc_step_);
      most = std::max(most, counts[at]);
    }
  }
  if (!fits(from, shape, own) || !fits(pose, shape, own)) return false;
  int stride = 1;
  while (stride < most) stride *= 2;
  for (bool coarsest = true; stride >= 1; stride /= 2, coarsest = false) {
    for (int n = 0; n < curve.count(); ++n) {
      // From the middle to the ends: there a turn swings out the farthest.
      const int i = (curve.count() + (n % 2 == 0 ? n : -n - 1)) / 2;
      const auto at = static_cast<std::size_t>(i);
      const CurvePiece& piece = curve.begin()[i];
      // The multiples of the stride that no coarser stride has seen.
      for (int k = coarsest ? 0 : stride; k <= counts[at]; k += coarsest ? stride : 2 * stride) {
        if (counts[at] == 0) break;
        const double s = piece.length * k / counts[at];
        if (!fits(sample_pose(piece, starts[at], s), shape, own)) return false;
      }
    }
  }
  return true;
}

double FreeSpace::free_run(const Pose2& from, double most, double step, Travel travel,
                           OwnRows own) const {
  if (!fits(from, travel, own)) return -1.0;
  int low = 0;
  int high = static_cast<int>(std::floor(most / step + 1e-9));
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (fits_straight(from, middle * step, travel, own)) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low * step;
}

double FreeSpace::swing(double radius) const {
  return std::hypot(radius + 0.5 * outline_.width_m + margin_,
                    std::max(outline_.front_m, outline_.rear_m) + margin_) -
         radius;
}

double FreeSpace::room_ahead(const Pose2& from, double most, OwnRows own) const {
  constexpr double kStep = 0.1;
  Footprint strip{0.0, 0.0, outline_.width_m};
  int steps = 0;
  while (strip.front_m < most) {
    strip.front_m = (steps + 1) * kStep;
    if (!clear_of_rows(from, strip, 0.0, own) || !area_.contains(from, strip)) break;
    ++steps;
  }
  return steps * kStep;
}

int FreeSpace::row_at(const Point2& p) const {
  for (const Slab& slab : slabs_) {
    const Point2 d = p - slab.center;
    if (std::abs(d.dot(slab.axis)) <= slab.half_length &&
        std::abs(d.y() * slab.axis.x() - d.x() * slab.axis.y()) <= slab.half_width) {
      return slab.row;
    }
  }
  return -1;
}

}  // namespace headland::coverage
