// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/path.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"

namespace headland {
namespace {

constexpr double kJointTolerance = 1e-6;  // [m, rad]

Pose2 pose_on(const PathPiece& piece, double driven) {
  return advance(piece.start, piece.curvature, sign(piece.gear) * driven);
}

/// Driven distance [m] of the point of the piece's whole line or circle that is nearest to `p_map`;
/// on a circle in [0, one turn).
double nearest_on_carrier(const PathPiece& piece, const Point2& p_map) {
  const Point2 p = inverse(piece.start) * p_map;
  if (piece.curvature == 0.0) return sign(piece.gear) * p.x();
  // The centre lies at (0, 1 / curvature); this form keeps its digits as the curvature vanishes.
  const double turned = std::atan2(piece.curvature * p.x(), 1.0 - piece.curvature * p.y());
  const double driven = sign(piece.gear) * turned / piece.curvature;
  return driven < 0.0 ? driven + 2.0 * kPi / std::abs(piece.curvature) : driven;
}

Projection project_on(const PathPiece& piece, const Point2& p_map, double driven) {
  const Pose2 foot = pose_on(piece, driven);
  const Point2 offset = p_map - foot.position();
  return {driven, offset.dot(foot.left()), offset.norm()};
}

/// Nearest point of the piece with driven distance in [low, high].
Projection project_piece(PathPiece piece, const Point2& p_map, double low, double high) {
  piece.start = pose_on(piece, low);
  piece.length = high - low;
  const double driven = nearest_on_carrier(piece, p_map);
  Projection best;
  if (driven >= 0.0 && driven <= piece.length) {
    best = project_on(piece, p_map, driven);
  } else {
    best = project_on(piece, p_map, 0.0);
    const Projection at_end = project_on(piece, p_map, piece.length);
    if (at_end.distance < best.distance) best = at_end;
  }
  best.s += low;
  return best;
}

}  // namespace

void Path::append(const PathPiece& piece) {
  HEADLAND_CHECK(piece.length > 0.0 && std::isfinite(piece.length), "a piece of no length");
  if (!empty()) {
    const Pose2 end = end_pose();
    HEADLAND_CHECK((piece.start.position() - end.position()).norm() <= kJointTolerance &&
                       std::abs(wrap_angle(piece.start.yaw - end.yaw)) <= kJointTolerance,
                   "a piece that does not start where the path ends");
  }
  const double begin_s = length();
  const double end_s = begin_s + piece.length;
  pieces_.push_back(piece);
  ends_.push_back(end_s);
  if (segments_.empty() || segments_.back().gear != piece.gear) {
    segments_.push_back({begin_s, end_s, piece.gear});
  } else {
    segments_.back().end_s = end_s;
  }
}

void Path::append(const Curve& curve, const Pose2& from, int leg) {
  Pose2 start = from;
  for (const CurvePiece& piece : curve) {
    const Gear gear = piece.length > 0.0 ? Gear::kForward : Gear::kReverse;
    append(PathPiece{start, piece.curvature, std::abs(piece.length), gear, leg});
    start = advance(start, piece.curvature, piece.length);
  }
}

void Path::append_straight(const Pose2& from, double length, int leg) {
  if (length > 0.0) append(PathPiece{from, 0.0, length, Gear::kForward, leg});
}

void Path::append(const Path& other, int leg_offset) {
  // By index and up to the old size: a path may be appended to itself.
  const std::size_t count = other.pieces_.size();
  for (std::size_t i = 0; i < count; ++i) {
    PathPiece piece = other.pieces_[i];
    piece.leg += leg_offset;
    append(piece);
  }
}

Pose2 Path::start_pose() const {
  HEADLAND_CHECK(!empty(), "the start of an empty path");
  return pieces_.front().start;
}

Pose2 Path::end_pose() const {
  HEADLAND_CHECK(!empty(), "the end of an empty path");
  return pose_on(pieces_.back(), pieces_.back().length);
}

PathSample Path::at(double s) const {
  HEADLAND_CHECK(!empty(), "a sample of an empty path");
  const double clamped = std::clamp(s, 0.0, length());
  const auto past = std::upper_bound(ends_.begin(), ends_.end(), clamped);
  const std::size_t i =
      past == ends_.end() ? ends_.size() - 1 : static_cast<std::size_t>(past - ends_.begin());
  const double begin_s = i == 0 ? 0.0 : ends_[i - 1];
  const auto next_segment = std::upper_bound(
      segments_.begin(), segments_.end(), clamped,
      [](double value, const PathSegment& segment) { return value < segment.end_s; });
  const int segment = std::min(static_cast<int>(next_segment - segments_.begin()),
                               static_cast<int>(segments_.size()) - 1);
  const PathPiece& piece = pieces_[i];
  return {
      pose_on(piece, clamped - begin_s), clamped, piece.curvature, piece.gear, segment, piece.leg};
}

std::vector<PathSample> Path::sample(double spacing) const {
  HEADLAND_CHECK(spacing > 0.0, "a sample spacing that is not positive");
  std::vector<PathSample> samples;
  if (empty()) return samples;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const double begin_s = i == 0 ? 0.0 : ends_[i - 1];
    const int count = std::max(1, static_cast<int>(std::ceil(pieces_[i].length / spacing)));
    for (int k = 0; k < count; ++k) samples.push_back(at(begin_s + pieces_[i].length * k / count));
  }
  samples.push_back(at(length()));
  return samples;
}

Projection Path::project(const Point2& p_map, double from_s, double to_s) const {
  HEADLAND_CHECK(!empty(), "a projection on an empty path");
  const double low = std::clamp(from_s, 0.0, length());
  const double high = std::clamp(to_s, low, length());
  const auto first = std::lower_bound(ends_.begin(), ends_.end(), low);
  Projection best;
  bool found = false;
  for (auto i = static_cast<std::size_t>(first - ends_.begin()); i < pieces_.size(); ++i) {
    const double begin_s = i == 0 ? 0.0 : ends_[i - 1];
    if (begin_s > high) break;
    Projection candidate = project_piece(pieces_[i], p_map, std::max(low - begin_s, 0.0),
                                         std::min(high - begin_s, pieces_[i].length));
    candidate.s = std::clamp(candidate.s + begin_s, low, high);
    if (!found || candidate.distance < best.distance) best = candidate;
    found = true;
  }
  return best;
}

std::pair<double, double> Path::leg_range(int leg) const {
  double begin_s = 0.0;
  double end_s = 0.0;
  bool found = false;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (pieces_[i].leg != leg) continue;
    if (!found) begin_s = i == 0 ? 0.0 : ends_[i - 1];
    end_s = ends_[i];
    found = true;
  }
  return {begin_s, end_s};
}

}  // namespace headland
