// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "global_planner/coverage/internal/row_line.hpp"
#include "global_planner/coverage/transitions.hpp"

namespace headland {
namespace coverage {
namespace {

void keep_farthest(const Polyline& line, std::size_t first, std::size_t last, double tolerance,
                   std::vector<bool>& kept) {
  std::size_t farthest = first;
  double most = tolerance;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double d = distance_to_segment(line[i], line[first], line[last]);
    if (d > most) {
      most = d;
      farthest = i;
    }
  }
  if (farthest == first) return;
  kept[farthest] = true;
  keep_farthest(line, first, farthest, tolerance, kept);
  keep_farthest(line, farthest, last, tolerance, kept);
}

}  // namespace

Polyline simplified(const Polyline& line, double tolerance) {
  if (line.size() < 3) return line;
  std::vector<bool> kept(line.size(), false);
  kept.front() = kept.back() = true;
  keep_farthest(line, 0, line.size() - 1, tolerance, kept);
  Polyline out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (kept[i]) out.push_back(line[i]);
  }
  return out;
}

}  // namespace coverage

namespace {

// The arc that rounds a corner: it begins and ends `tangent` from the corner.
struct Fillet {
  double tangent = 0.0;  // [m]
  double angle = 0.0;    // [rad], signed
  double radius = 0.0;   // [m]
};

// Rounds the corner at line[i] with at least `radius`, wider where that keeps within the survey's
// tolerance; none if the sides are too short for it.
std::optional<Fillet> fillet(const Polyline& line, std::size_t i, double radius) {
  const Point2 in = line[i] - line[i - 1];
  const Point2 out = line[i + 1] - line[i];
  Fillet f;
  f.angle = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
  const double half = 0.5 * std::abs(f.angle);
  if (half < 1e-9) return f;
  const double room = 0.5 * std::min(in.norm(), out.norm());
  const double least = radius * std::tan(half);
  if (half > 0.45 * kPi || least > room) return std::nullopt;
  // The arc passes the corner at tangent * tan(half / 2).
  const double within_survey = coverage::kSurveyTolerance / std::tan(0.5 * half);
  f.tangent = std::clamp(within_survey, least, std::max(least, 0.8 * room));
  f.radius = f.tangent / std::tan(half);
  return f;
}

std::optional<Path> rounded(const Polyline& line, double radius) {
  Path path;
  const Point2 first = line[1] - line[0];
  Pose2 pose{line[0].x(), line[0].y(), std::atan2(first.y(), first.x())};
  double used = 0.0;  // of the segment, by the fillet at its beginning
  for (std::size_t i = 1; i < line.size(); ++i) {
    Fillet f;
    if (i + 1 < line.size()) {
      const std::optional<Fillet> corner = fillet(line, i, radius);
      if (!corner) return std::nullopt;
      f = *corner;
    }
    path.append_straight(pose, (line[i] - line[i - 1]).norm() - used - f.tangent, 0);
    if (!path.empty()) pose = path.end_pose();
    used = f.tangent;
    if (f.tangent <= 0.0) continue;
    Curve arc;
    arc.add({std::copysign(1.0 / f.radius, f.angle), f.radius * std::abs(f.angle)});
    path.append(arc, pose, 0);
    pose = path.end_pose();
  }
  return path;
}

}  // namespace

Path row_path(const Row& row, int entry, double radius) {
  HEADLAND_CHECK(row.line.size() >= 2, "a row needs two points");
  HEADLAND_CHECK(entry == 0 || entry == 1, "a row has two ends");
  // Sharper bends than the vehicle can follow are cut, ever more boldly.
  for (double tolerance = coverage::kSurveyTolerance;; tolerance *= 2.0) {
    Polyline line = coverage::simplified(row.line, tolerance);
    const bool straight = line.size() == 2;
    if (entry == 1) std::reverse(line.begin(), line.end());
    const std::optional<Path> path = rounded(line, radius);
    if (path) return *path;
    HEADLAND_CHECK(!straight, "a straight line needs no rounding");
  }
}

}  // namespace headland
