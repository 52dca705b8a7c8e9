// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/path.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"

namespace headland {
namespace {

constexpr double kJointTolerance = 1e-6;  // [m, rad]

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
  const Pose2 foot = piece.pose_at(driven);
  const Point2 offset = p_map - foot.position();
  return {driven, offset.dot(foot.left()), offset.norm()};
}

void keep_nearer(Projection& best, const Projection& candidate) {
  if (candidate.distance < best.distance) best = candidate;
}

/// Nearest point of a clothoid: half the squared distance D from it to a point has a minimum where
/// D' = 0 and D'' > 0.
class ClothoidProjection {
 public:
  ClothoidProjection(const PathPiece& piece, const Point2& p_map) : piece_(piece), p_(p_map) {}

  Projection nearest() {
    const double most = std::max(std::abs(piece_.curvature), std::abs(piece_.end_curvature()));
    const int count = 1 + static_cast<int>(std::min(most * piece_.length / kStretchTurn, 1e4));
    At begin = at(0.0);
    best_ = begin.projection;
    for (int i = 1; i <= count; ++i) {
      const At end = at(piece_.length * i / count);
      keep_nearer(best_, end.projection);
      search(begin, end, kMostHalvings);
      begin = end;
    }
    return best_;
  }

 private:
  static constexpr double kStretchTurn = 0.5;  // [rad]
  static constexpr int kMostHalvings = 20;
  static constexpr int kMostIterations = 60;  // of Newton's method, by halves at worst

  struct At {
    Projection projection;
    double first = 0.0;   // D' [m]
    double second = 0.0;  // D'' = 1 - curvature * lateral error
  };
  At at(double driven) const {
    const Pose2 foot = piece_.pose_at(driven);
    const Point2 offset = p_ - foot.position();
    const double lateral = offset.dot(foot.left());
    return {{driven, lateral, offset.norm()},
            -sign(piece_.gear) * offset.dot(foot.heading()),
            1.0 - piece_.curvature_at(driven) * lateral};
  }

  void search(const At& a, const At& b, int halvings) {
    // A metre of the way brings the point nearer by at most a metre.
    const double stretch = b.projection.s - a.projection.s;
    if (a.projection.distance + b.projection.distance - stretch >= 2.0 * best_.distance) return;
    if ((a.second > 0.0) != (b.second > 0.0) && halvings > 0) {
      const At middle = at(a.projection.s + 0.5 * stretch);
      keep_nearer(best_, middle.projection);
      search(a, middle, halvings - 1);
      search(middle, b, halvings - 1);
    } else if (a.first < 0.0 && b.first > 0.0) {
      keep_nearer(best_, foot_between(a.projection.s, b.projection.s).projection);
    }
  }

  /// Newton's method on D', halving the bracket where it would leave it.
  At foot_between(double low, double high) const {
    At now = at(0.5 * (low + high));
    for (int i = 0; i < kMostIterations && high - low > 1e-13 * (1.0 + high); ++i) {
      const double s = now.projection.s;
      (now.first < 0.0 ? low : high) = s;
      const double wanted = s - now.first / now.second;
      const bool inside = wanted > low && wanted < high;  // false for NaN
      now = at(inside ? wanted : 0.5 * (low + high));
      if (std::abs(now.projection.s - s) <= 1e-13 * (1.0 + s)) break;
    }
    return now;
  }

  PathPiece piece_;
  Point2 p_;
  Projection best_;
};

/// Nearest point of a straight or an arc.
Projection project_on_arc(const PathPiece& piece, const Point2& p_map) {
  const double driven = nearest_on_carrier(piece, p_map);
  if (driven >= 0.0 && driven <= piece.length) return project_on(piece, p_map, driven);
  Projection best = project_on(piece, p_map, 0.0);
  keep_nearer(best, project_on(piece, p_map, piece.length));
  return best;
}

/// Nearest point of the piece with driven distance in [low, high].
Projection project_piece(PathPiece piece, const Point2& p_map, double low, double high) {
  piece.start = piece.pose_at(low);
  piece.curvature = piece.curvature_at(low);
  piece.length = high - low;
  Projection best = piece.sharpness == 0.0 ? project_on_arc(piece, p_map)
                                           : ClothoidProjection(piece, p_map).nearest();
  best.s += low;
  return best;
}

}  // namespace

PathPiece turned_round(const PathPiece& piece) {
  PathPiece back = piece;
  back.start = reversed(piece.pose_at(piece.length));
  back.curvature = -piece.end_curvature();
  return back;  // the sharpness keeps its sign: both the curvature and the way are reversed
}

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
    append(PathPiece{start, piece.curvature, std::abs(piece.length), gear, leg,
                     sign(gear) * piece.sharpness});
    start = piece.end_pose(start);
  }
}

void Path::append(const Clothoid& clothoid, int leg) {
  append(PathPiece{clothoid.start, clothoid.curvature, clothoid.length, Gear::kForward, leg,
                   clothoid.sharpness});
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
  return pieces_.back().pose_at(pieces_.back().length);
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
  const double driven = clamped - begin_s;
  return {
      piece.pose_at(driven), clamped, piece.curvature_at(driven), piece.gear, segment, piece.leg};
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

Path Path::slice(double from_s, double to_s) const {
  Path part;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const double begin = i == 0 ? 0.0 : ends_[i - 1];
    const double first = std::max(from_s, begin);
    const double last = std::min(to_s, ends_[i]);
    if (last <= first) continue;
    PathPiece piece = pieces_[i];
    const double gone = first - begin;
    if (gone > 0.0) {
      piece.start = piece.pose_at(gone);
      piece.curvature = piece.curvature_at(gone);
    }
    piece.length = last - first;
    part.append(piece);
  }
  return part;
}

}  // namespace headland
