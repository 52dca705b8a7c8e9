// SPDX-License-Identifier: Apache-2.0
#include "core/world/clearance_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/region.hpp"

namespace headland {
namespace {

constexpr double kNothing = 1e12;  // squared distance where no obstacle is [cells2]
constexpr double kHalfDiagonal = 0.7071067811865476;

// Squared distances along one line of cells to the lower envelope of parabolas with their feet at
// `f` (Felzenszwalb and Huttenlocher 2012, algorithm 1), in place.
class LineTransform {
 public:
  void apply(std::vector<double>& f) {
    const int n = static_cast<int>(f.size());
    foot_.resize(f.size());
    from_.resize(f.size() + 1);
    value_ = f;
    const auto meets = [&](int q, int p) {
      const double dq = q;
      const double dp = p;
      return (value_[index(q)] + dq * dq - value_[index(p)] - dp * dp) / (2.0 * (dq - dp));
    };
    int k = 0;
    foot_[0] = 0;
    from_[0] = -std::numeric_limits<double>::infinity();
    from_[1] = std::numeric_limits<double>::infinity();
    for (int q = 1; q < n; ++q) {
      double s = meets(q, foot_[index(k)]);
      while (s <= from_[index(k)]) s = meets(q, foot_[index(--k)]);
      foot_[index(++k)] = q;
      from_[index(k)] = s;
      from_[index(k) + 1] = std::numeric_limits<double>::infinity();
    }
    k = 0;
    for (int q = 0; q < n; ++q) {
      while (from_[index(k) + 1] < q) ++k;
      const double off = q - foot_[index(k)];
      f[index(q)] = off * off + value_[index(foot_[index(k)])];
    }
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  std::vector<int> foot_;
  std::vector<double> from_;
  std::vector<double> value_;
};

struct Box {
  Point2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point2 high = -low;

  explicit Box(const std::vector<Polygon>& polygons) {
    for (const Polygon& polygon : polygons) {
      for (const Point2& p : polygon.outer) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
  }
};

// The cells whose centres `blocks`, over a box widened by `margin`.
template <class Blocks>
ClearanceMap rasterise(const Box& box, double cell, double margin, const Blocks& blocks) {
  const Point2 corner = box.low - Point2(margin, margin);
  const Point2 size = box.high - box.low + Point2(2.0 * margin, 2.0 * margin);
  const int columns = static_cast<int>(std::ceil(size.x() / cell));
  const int rows = static_cast<int>(std::ceil(size.y() / cell));
  std::vector<std::uint8_t> blocked(static_cast<std::size_t>(columns) *
                                    static_cast<std::size_t>(rows));
  std::size_t i = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column, ++i) {
      blocked[i] = blocks(Point2(corner + cell * Point2(column + 0.5, row + 0.5))) ? 1 : 0;
    }
  }
  return ClearanceMap(corner, cell, columns, rows, blocked);
}

}  // namespace

ClearanceMap::ClearanceMap(const Point2& corner, double cell, int columns, int rows,
                           const std::vector<std::uint8_t>& blocked)
    : corner_(corner), cell_(cell), per_metre_(1.0 / cell), columns_(columns), rows_(rows) {
  if (std::find(blocked.begin(), blocked.end(), 1) == blocked.end()) return;
  const auto width = static_cast<std::size_t>(columns);
  const auto height = static_cast<std::size_t>(rows);
  std::vector<double> squared(width * height);
  for (std::size_t i = 0; i < squared.size(); ++i) squared[i] = blocked[i] != 0 ? 0.0 : kNothing;
  LineTransform transform;
  std::vector<double> line(height);
  for (std::size_t c = 0; c < width; ++c) {
    for (std::size_t r = 0; r < height; ++r) line[r] = squared[r * width + c];
    transform.apply(line);
    for (std::size_t r = 0; r < height; ++r) squared[r * width + c] = line[r];
  }
  line.resize(width);
  distance_.resize(squared.size());
  for (std::size_t r = 0; r < height; ++r) {
    const auto begin = squared.begin() + static_cast<std::ptrdiff_t>(r * width);
    std::copy_n(begin, width, line.begin());
    transform.apply(line);
    for (std::size_t c = 0; c < width; ++c) {
      // From anywhere in this cell to anywhere in the blocked one.
      const double sure = cell_ * (std::sqrt(line[c]) - 2.0 * kHalfDiagonal);
      distance_[r * width + c] = static_cast<float>(std::clamp(sure, 0.0, kFar));
    }
  }
}

ClearanceMap ClearanceMap::around(const std::vector<Polygon>& free, double cell, double margin) {
  if (free.empty()) return {};
  return rasterise(Box(free), cell, margin,
                   [area = Region(free)](const Point2& p) { return !area.contains(p); });
}

ClearanceMap ClearanceMap::of(const std::vector<Polygon>& obstacles, double cell, double reach) {
  if (obstacles.empty()) return {};
  return rasterise(Box(obstacles), cell, reach,
                   [area = Region(obstacles)](const Point2& p) { return area.contains(p); });
}

// The nearest cell of the grid is nearer to the point than any obstacle is.
double ClearanceMap::off_grid(const Point2& p) const {
  if (!p.allFinite()) return 0.0;
  const Point2 high = corner_ + cell_ * Point2(columns_ - 1e-6, rows_ - 1e-6);
  const Point2 inside = p.cwiseMax(corner_).cwiseMin(high);
  return std::max((p - inside).norm(), clearance(inside) - (p - inside).norm());
}

bool ClearanceMap::disc_passes(const Point2& a, const Point2& b, double radius) const {
  if (distance_.empty()) return true;
  const double length = (b - a).norm();
  double at = 0.0;
  for (;;) {
    const double free = clearance(length > 0.0 ? Point2(a + (at / length) * (b - a)) : a) - radius;
    if (free <= 0.0) return false;
    if (at >= length) return true;
    at = std::min(length, at + std::max(free, 0.25 * cell_));
  }
}

Point2 ClearanceMap::away(const Point2& p) const {
  if (distance_.empty()) return {0.0, 0.0};
  const Point2 dx(cell_, 0.0);
  const Point2 dy(0.0, cell_);
  const Point2 slope(clearance(p + dx) - clearance(p - dx), clearance(p + dy) - clearance(p - dy));
  const double norm = slope.norm();
  return norm > 1e-9 ? Point2(slope / norm) : Point2(0.0, 0.0);
}

}  // namespace headland
