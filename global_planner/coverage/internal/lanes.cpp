// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/internal/lanes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace headland::coverage {
namespace {

constexpr double kBlockGap = 0.4;          // [m] rows nearer than this make up one block
constexpr double kOpenSpacing = 8.0;       // [m] of the grid on open ground
constexpr double kMostOpenPoints = 600.0;  // a coarser grid where there would be more

Pose2 looking(const Point2& at, const Point2& along) {
  return {at.x(), at.y(), std::atan2(along.y(), along.x())};
}

// Poses evenly along a line, at most `spacing` apart; the heading is that of the chord around.
std::vector<Pose2> poses_along(const Polyline& line, bool closed, double spacing) {
  Polyline points = line;
  if (closed) points.push_back(line.front());
  std::vector<double> s{0.0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    s.push_back(s.back() + (points[i] - points[i - 1]).norm());
  }
  const double total = s.back();
  std::vector<Pose2> poses;
  if (total <= 0.0) return poses;
  const auto at = [&](double where) -> Point2 {
    if (closed) where -= total * std::floor(where / total);
    where = std::clamp(where, 0.0, total);
    const auto next = std::upper_bound(s.begin() + 1, s.end() - 1, where);
    const auto i = static_cast<std::size_t>(next - s.begin());
    const double step = s[i] - s[i - 1];
    return points[i - 1] +
           (step > 0.0 ? (where - s[i - 1]) / step : 0.0) * (points[i] - points[i - 1]);
  };
  const int count = std::max(1, static_cast<int>(std::ceil(total / spacing)));
  const double reach = std::min(0.3, 0.25 * total / count);
  for (int k = 0; k < count; ++k) {
    // In the middle of each stretch, so that corners of open lines keep their distance.
    const double where = (k + 0.5) * total / count;
    poses.push_back(looking(at(where), at(where + reach) - at(where - reach)));
  }
  return poses;
}

// Poses in a grid, to find those near a place.
class NearbyPoses {
 public:
  explicit NearbyPoses(double cell) : cell_(cell) {}
  void add(const Pose2& pose) { cells_[key(pose.position(), 0, 0)].push_back(pose); }
  bool any_within(const Point2& p, double distance) const {
    return any_around(p, [&](const Pose2& q) { return (p - q.position()).norm() < distance; });
  }
  // A pose that serves as well: about as far along, and in the same line.
  bool any_alike(const Pose2& pose) const {
    return any_around(pose.position(), [&](const Pose2& q) {
      const Point2 d = q.position() - pose.position();
      return std::abs(d.dot(pose.heading())) < 0.5 * cell_ && std::abs(d.dot(pose.left())) < 0.7 &&
             std::abs(std::sin(q.yaw - pose.yaw)) < 0.05;
    });
  }

 private:
  template <class Test>
  bool any_around(const Point2& p, Test test) const {
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const auto cell = cells_.find(key(p, dx, dy));
        if (cell == cells_.end()) continue;
        if (std::any_of(cell->second.begin(), cell->second.end(), test)) return true;
      }
    }
    return false;
  }
  std::pair<int, int> key(const Point2& p, int dx, int dy) const {
    return {static_cast<int>(std::floor(p.x() / cell_)) + dx,
            static_cast<int>(std::floor(p.y() / cell_)) + dy};
  }
  double cell_;
  std::map<std::pair<int, int>, std::vector<Pose2>> cells_;
};

// Ends of a segment, and where others meet it.
std::vector<Point2> meetings(const Polyline& segment, const std::vector<Polyline>& others) {
  constexpr double kTouch = 3.0;  // [m] a road may end this short of another's centre line
  std::vector<Point2> points{segment[0], segment[1]};
  const Point2 d = segment[1] - segment[0];
  for (const Polyline& other : others) {
    for (const Point2& end : other) {
      if (distance_to_segment(end, segment[0], segment[1]) < kTouch) points.push_back(end);
    }
    const Point2 e = other[1] - other[0];
    const double turn = d.x() * e.y() - d.y() * e.x();
    if (std::abs(turn) < 1e-9) continue;
    const Point2 gap = other[0] - segment[0];
    const double t = (gap.x() * e.y() - gap.y() * e.x()) / turn;
    const double u = (gap.x() * d.y() - gap.y() * d.x()) / turn;
    if (t >= 0.0 && t <= 1.0 && u >= 0.0 && u <= 1.0) points.push_back(segment[0] + t * d);
  }
  return points;
}

class LaneMaker {
 public:
  LaneMaker(const FreeSpace& space, double clearance, double radius)
      : space_(space),
        clearance_(clearance),
        radius_(radius),
        spacing_(std::clamp(1.5 * radius, 4.0, 8.0)),
        nearby_(std::max(kOpenSpacing, spacing_)) {}

  // Densely around corners and junctions: there a pose must lie where the curve begins, lest the
  // curve cut the corner.
  void along_roads(const Farm& farm) {
    std::vector<Polyline> segments;
    for (const Road& road : farm.roads) {
      for (std::size_t i = 1; i < road.line.size(); ++i) {
        segments.push_back({road.line[i - 1], road.line[i]});
      }
    }
    const double fine = std::clamp(0.5 * radius_, 1.0, 2.0);
    const int stride = std::max(1, static_cast<int>(std::lround(spacing_ / fine)));
    for (const Polyline& segment : segments) {
      const std::vector<Point2> corners = meetings(segment, segments);
      const std::vector<Pose2> all = poses_along(segment, false, fine);
      std::vector<Pose2> chosen;
      for (std::size_t k = 0; k < all.size(); ++k) {
        const bool at_corner =
            std::any_of(corners.begin(), corners.end(), [&](const Point2& corner) {
              return (corner - all[k].position()).norm() < 2.5 * radius_;
            });
        if (at_corner || static_cast<int>(k) % stride == stride / 2) chosen.push_back(all[k]);
      }
      add(chosen);
    }
  }

  void around_rows(const std::vector<RowBody>& rows) {
    std::vector<Polygon> bodies;
    for (const RowBody& row : rows) {
      const std::vector<Polygon> body = widen(row.line, row.spacing);
      bodies.insert(bodies.end(), body.begin(), body.end());
    }
    const double smoothing = std::max(radius_, 3.0);
    // Far enough out for a quarter turn from a row's end, and for the nose to swing; closer where
    // there is no room for that.
    const double wide = std::max({clearance_, radius_, space_.swing(radius_)}) + 0.2;
    std::vector<double> clearances{wide};
    for (double c = wide - 1.5; c > clearance_ + 0.5; c -= 1.5) clearances.push_back(c);
    if (wide > clearance_ + 0.2) clearances.push_back(clearance_);
    for (const Polygon& block : grow(bodies, 0.5 * kBlockGap)) {
      const Polygon outline{block.outer, {}};
      for (const double c : clearances) {
        // Closing evens out the steps of staggered row ends.
        const auto rings = grow(grow({outline}, c - 0.5 * kBlockGap + smoothing), -smoothing);
        // A closer pose is of use only where no wider one is.
        for (const Polygon& ring : rings) {
          add(poses_along(ring.outer, true, spacing_), c == wide ? 0.0 : 0.6 * spacing_);
        }
      }
    }
  }

  void at_gates(const Farm& farm) {
    for (const Gate& gate : farm.gates) add_star(gate.position);
  }

  void over_open_ground(const std::vector<Polygon>& drivable) {
    Point2 low(1e300, 1e300);
    Point2 high = -low;
    for (const Polygon& polygon : drivable) {
      for (const Point2& p : polygon.outer) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
    if (low.x() > high.x()) return;
    double step = std::max(kOpenSpacing, spacing_);
    std::vector<Point2> open;
    for (;; step *= 1.3) {
      open.clear();
      for (double y = low.y() + 0.5 * step; y < high.y(); y += step) {
        for (double x = low.x() + 0.5 * step; x < high.x(); x += step) {
          const Point2 p(x, y);
          if (nearby_.any_within(p, 0.8 * kOpenSpacing)) continue;
          if (space_.fits({x, y, 0.0}, Travel::kBoth, {}) ||
              space_.fits({x, y, 0.5 * kPi}, Travel::kBoth, {})) {
            open.push_back(p);
          }
        }
      }
      if (static_cast<double>(open.size()) <= kMostOpenPoints) break;
    }
    for (const Point2& p : open) add_star(p);
  }

  std::vector<Pose2> take() { return std::move(poses_); }

 private:
  void add(const std::vector<Pose2>& poses, double apart = 0.0) {
    std::vector<Pose2> fitting;
    for (const Pose2& pose : poses) {
      if (apart > 0.0 && nearby_.any_within(pose.position(), apart)) continue;
      if (nearby_.any_alike(pose)) continue;
      if (space_.fits(pose, Travel::kBoth, {})) fitting.push_back(pose);
    }
    for (const Pose2& pose : fitting) nearby_.add(pose);
    poses_.insert(poses_.end(), fitting.begin(), fitting.end());
  }

  void add_star(const Point2& p) {
    std::vector<Pose2> star;
    for (int k = 0; k < 4; ++k) star.push_back({p.x(), p.y(), k * kPi / 4.0});
    add(star);
  }

  const FreeSpace& space_;
  double clearance_;
  double radius_;
  double spacing_;
  NearbyPoses nearby_;
  std::vector<Pose2> poses_;
};

}  // namespace

std::vector<Pose2> lane_poses(const Farm& farm, const std::vector<Polygon>& drivable,
                              const std::vector<RowBody>& rows, const FreeSpace& space,
                              double clearance, double radius) {
  LaneMaker maker(space, clearance, radius);
  maker.along_roads(farm);
  maker.around_rows(rows);
  maker.at_gates(farm);
  maker.over_open_ground(drivable);
  return maker.take();
}

}  // namespace headland::coverage
