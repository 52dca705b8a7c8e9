// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/geometry/path.hpp"
#include "core/world/farm.hpp"

namespace headland::test {

/// An independent judge of paths: it samples them every 5 cm, and points on the vehicle's outline
/// every 25 cm, and asks polygons and distances alone. It shares nothing with the planner but the
/// farm.
class OutlineChecker {
 public:
  OutlineChecker(const Farm& farm, std::vector<Row> rows, double row_width, Footprint footprint)
      : area_(drivable_area(farm)),
        rows_(std::move(rows)),
        row_width_(row_width),
        reach_(std::hypot(std::max(footprint.front_m, footprint.rear_m), 0.5 * footprint.width_m)) {
    const double half = 0.5 * footprint.width_m;
    corners_ = {Point2(footprint.front_m, half), Point2(-footprint.rear_m, half),
                Point2(-footprint.rear_m, -half), Point2(footprint.front_m, -half)};
    const int along = static_cast<int>((footprint.front_m + footprint.rear_m) / 0.25) + 1;
    const int across = static_cast<int>(footprint.width_m / 0.25) + 1;
    for (int i = 0; i <= along; ++i) {
      const double x = -footprint.rear_m + (footprint.front_m + footprint.rear_m) * i / along;
      outline_.emplace_back(x, half);
      outline_.emplace_back(x, -half);
    }
    for (int i = 0; i <= across; ++i) {
      const double y = -half + footprint.width_m * i / across;
      outline_.emplace_back(footprint.front_m, y);
      outline_.emplace_back(-footprint.rear_m, y);
    }
  }

  /// Empty if the outline stays in the drivable area and off all rows but `own` and those that the
  /// path drives through; else where it does not.
  std::string complaint(const Path& path, std::set<int> own) {
    const std::vector<PathSample> samples = path.sample(0.05);
    for (const PathSample& sample : samples) {
      for (std::size_t r = 0; r < rows_.size(); ++r) {
        const Point2 middle = 0.5 * (rows_[r].line.front() + rows_[r].line.back());
        if ((sample.pose.position() - middle).norm() < 0.05) own.insert(static_cast<int>(r));
      }
    }
    for (const PathSample& sample : samples) {
      near_.clear();
      for (std::size_t r = 0; r < rows_.size(); ++r) {
        if (distance(sample.pose.position(), rows_[r].line) < reach_ + row_width_)
          near_.push_back(r);
      }
      const bool edge_near = border_within(sample.pose.position(), reach_ + 0.1);
      if (!edge_near && !in_area(sample.pose.position())) {
        return fmt::format("at s = {:.2f} of {:.2f} m: outside", sample.s, path.length());
      }
      if (const int row = side_crossed(sample.pose); row >= 0) {
        return fmt::format("at s = {:.2f} of {:.2f} m, ({:.2f}, {:.2f}): across the side of row {}",
                           sample.s, path.length(), sample.pose.x, sample.pose.y,
                           rows_[static_cast<std::size_t>(row)].id);
      }
      for (const Point2& p_base : outline_) {
        const Point2 p = sample.pose * p_base;
        if (edge_near && !in_area(p)) {
          return fmt::format("at s = {:.2f} of {:.2f} m, ({:.2f}, {:.2f}) is not drivable",
                             sample.s, path.length(), p.x(), p.y());
        }
        for (const std::size_t r : near_) {
          if (own.count(static_cast<int>(r)) == 0 && in_row(rows_[r], p)) {
            return fmt::format("at s = {:.2f} of {:.2f} m, ({:.2f}, {:.2f}) is in row {}", sample.s,
                               path.length(), p.x(), p.y(), rows_[r].id);
          }
        }
      }
    }
    return {};
  }

 private:
  // Do two segments cross?
  static bool cross(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
    const auto side = [](const Point2& p, const Point2& q, const Point2& r) {
      return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
    };
    return side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
  }
  // A row that the outline enters or leaves elsewhere than at an end; -1: none.
  int side_crossed(const Pose2& pose) const {
    for (const std::size_t r : near_) {
      const Polyline& line = rows_[r].line;
      for (std::size_t i = 1; i < line.size(); ++i) {
        const Point2 d = (line[i] - line[i - 1]).normalized();
        for (const double half : {0.5 * row_width_, -0.5 * row_width_}) {
          const Point2 off = half * Point2(-d.y(), d.x());
          for (std::size_t k = 0; k < 4; ++k) {
            if (cross(line[i - 1] + off, line[i] + off, pose * corners_[k],
                      pose * corners_[(k + 1) % 4])) {
              return static_cast<int>(r);
            }
          }
        }
      }
    }
    return -1;
  }
  static double distance(const Point2& p, const Polyline& line) {
    double least = 1e300;
    for (std::size_t i = 1; i < line.size(); ++i) {
      least = std::min(least, distance_to_segment(p, line[i - 1], line[i]));
    }
    return least;
  }
  bool border_within(const Point2& p, double limit) const {
    const auto near = [&](const Polyline& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        if (distance_to_segment(p, ring[i], ring[(i + 1) % ring.size()]) < limit) return true;
      }
      return false;
    };
    return std::any_of(area_.begin(), area_.end(), [&](const Polygon& polygon) {
      return near(polygon.outer) || std::any_of(polygon.holes.begin(), polygon.holes.end(), near);
    });
  }
  bool in_area(const Point2& p) const {
    for (const Polygon& polygon : area_) {
      if (contains(polygon, p)) return true;
    }
    return false;
  }
  bool in_row(const Row& row, const Point2& p) const {
    for (std::size_t i = 1; i < row.line.size(); ++i) {
      const Point2 d = row.line[i] - row.line[i - 1];
      const double length = d.norm();
      const Point2 v = p - row.line[i - 1];
      const double along = v.dot(d) / length;
      const double across = (v.y() * d.x() - v.x() * d.y()) / length;
      if (along > 1e-6 && along < length - 1e-6 && std::abs(across) < 0.5 * row_width_ - 1e-6) {
        return true;
      }
    }
    return false;
  }

  std::vector<Polygon> area_;
  std::vector<Row> rows_;
  double row_width_;
  double reach_;                   // farthest point of the outline from base [m]
  std::vector<std::size_t> near_;  // rows around the sample at hand
  std::array<Point2, 4> corners_;  // in base
  std::vector<Point2> outline_;    // in base
};

}  // namespace headland::test
