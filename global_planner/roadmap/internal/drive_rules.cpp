// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/internal/drive_rules.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/dubins.hpp"
#include "core/geometry/reeds_shepp.hpp"

namespace headland::roadmap {
namespace {

constexpr double kSliver = 1e-9;  // [m] shorter pieces are rounding

// The Dubins curve of the vehicle seen from behind, driven in reverse.
Curve backward_dubins(const Pose2& from, const Pose2& to, double radius) {
  Curve curve;
  for (const CurvePiece& piece : shortest_dubins(reversed(from), reversed(to), radius)) {
    curve.add({-piece.curvature, -piece.length});
  }
  return curve;
}

Curve without_slivers(const Curve& curve) {
  Curve clean;
  for (const CurvePiece& piece : curve) {
    if (std::abs(piece.length) > kSliver) clean.add(piece);
  }
  return clean;
}

}  // namespace

double DriveRules::cost(const CurvePiece& piece) const {
  const double length = std::abs(piece.length);
  return length * (piece.length > 0.0 ? 1.0 : reverse_weight) +
         steering_weight * length * std::abs(piece.curvature);
}

double DriveRules::cost(const Curve& curve) const {
  double sum = cusp_cost * curve.cusps();
  for (const CurvePiece& piece : curve) sum += cost(piece);
  return sum;
}

double DriveRules::cost(const Path& path) const {
  double sum = cusp_cost * std::max(static_cast<int>(path.segments().size()) - 1, 0);
  for (const PathPiece& piece : path.pieces()) {
    sum += cost(CurvePiece{piece.curvature, sign(piece.gear) * piece.length});
  }
  return sum;
}

double DriveRules::open_distance(const Pose2& from, const Pose2& to) const {
  return reverses ? reeds_shepp_length(from, to, radius) : dubins_length(from, to, radius);
}

std::vector<Join> joins(const DriveRules& rules, const Pose2& from, const Pose2& to) {
  std::vector<Join> found;
  const auto offer = [&](const Curve& raw) {
    const Curve curve = without_slivers(raw);
    if (curve.count() > 0) found.push_back({rules.cost(curve), curve});
  };
  offer(shortest_dubins(from, to, rules.radius));
  if (rules.reverses) {
    offer(shortest_reeds_shepp(from, to, rules.radius));
    offer(backward_dubins(from, to, rules.radius));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Join& a, const Join& b) { return a.cost < b.cost; });
  return found;
}

void PathBuilder::add(PathPiece piece) {
  if (piece.length <= kSliver) return;
  if (!pieces_.empty() && pieces_.back().curvature == piece.curvature &&
      pieces_.back().gear == piece.gear) {
    pieces_.back().length += piece.length;
  } else {
    pieces_.push_back(piece);
  }
}

void PathBuilder::add(const Pose2& from, const CurvePiece& piece) {
  add(PathPiece{from, piece.curvature, std::abs(piece.length), Join::gear_of(piece), 0});
}

void PathBuilder::add(const Pose2& from, const Curve& curve) {
  Pose2 start = from;
  for (const CurvePiece& piece : curve) {
    add(start, piece);
    start = advance(start, piece.curvature, piece.length);
  }
}

Path PathBuilder::path() const {
  Path path;
  for (const PathPiece& piece : pieces_) path.append(piece);
  return path;
}

}  // namespace headland::roadmap
