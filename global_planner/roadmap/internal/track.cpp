// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/internal/track.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/dubins.hpp"

namespace headland::internal {
namespace {

constexpr double kStep = 0.25;         // [m]
constexpr double kStepsPerCell = 4.0;  // of the terrain
// The slope changes along a step, and other checks sample other points.
constexpr double kSlopeSlack = 0.25;   // [deg]
constexpr double kLongestRatio = 2.0;  // of a clothoid to its chord

}  // namespace

double Track::length() const {
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += pieces[static_cast<std::size_t>(i)].length;
  return sum;
}

Path Track::path(bool backwards) const {
  Path path;
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(backwards ? count - 1 - i : i);
    path.append(backwards ? turned_round(pieces[k]) : pieces[k]);
  }
  return path;
}

TrackMaker::TrackMaker(const Region& drivable, const Ground& ground, const Vehicle& vehicle,
                       EdgeCurve curve)
    : drivable_(drivable),
      ground_(ground),
      vehicle_(vehicle),
      curve_(curve),
      radius_(vehicle.turning_radius()),
      step_(ground.flat() ? kStep : std::min(kStep, 2.0 * ground.step() / kStepsPerCell)),
      both_(vehicle.footprint),
      most_pitch_(deg_to_rad(vehicle.max_pitch_deg - kSlopeSlack)),
      most_roll_(deg_to_rad(vehicle.max_roll_deg - kSlopeSlack)) {
  both_.front_m = std::max(both_.front_m, both_.rear_m);
  both_.rear_m = both_.front_m;
  // Every point of the outline turns about a centre no further away than this: the sagitta.
  const double reach = radius_ + std::hypot(both_.front_m, 0.5 * both_.width_m);
  sweep_ = reach * step_ * step_ / (8.0 * radius_ * radius_);
}

std::optional<Track> TrackMaker::join(const Pose2& from, const Pose2& to, EdgeCurve curve) const {
  Track track;
  if (curve == EdgeCurve::kClothoid) {
    const auto fit = fit_clothoid(from, to);
    if (!fit || fit->curve.max_abs_curvature() * radius_ > 1.0) return std::nullopt;
    const double chord = (to.position() - from.position()).norm();
    if (fit->curve.length > kLongestRatio * chord) return std::nullopt;
    const Clothoid& c = fit->curve;
    track.pieces[0] = {c.start, c.curvature, c.length, Gear::kForward, 0, c.sharpness};
    track.count = 1;
    return track;
  }
  Path path;
  path.append(shortest_dubins(from, to, radius_), from, 0);
  for (const PathPiece& piece : path.pieces()) {
    track.pieces[static_cast<std::size_t>(track.count++)] = piece;
  }
  return track;
}

bool TrackMaker::level_enough(const Pose2& pose) const {
  if (ground_.flat()) return true;
  const auto here = ground_.sample(pose.position());
  if (!here) return false;
  const Attitude tilt = attitude(*here, pose.yaw);
  return std::abs(tilt.pitch) <= most_pitch_ && std::abs(tilt.roll) <= most_roll_;
}

bool TrackMaker::fits(const Pose2& pose, double margin) const {
  return drivable_.contains(pose, vehicle_.footprint, margin) && level_enough(pose);
}

Ways TrackMaker::open_ways(const Track& track, double margin, Ways wanted) const {
  const double kept = margin + sweep_;
  Ways open = wanted;
  const auto check = [&](const Pose2& pose) {
    if (!level_enough(pose)) open = {false, false};
    if (!open.any() || drivable_.contains(pose, both_, kept)) return;
    open.forwards = open.forwards && drivable_.contains(pose, vehicle_.footprint, kept);
    open.backwards = open.backwards && drivable_.contains(reversed(pose), vehicle_.footprint, kept);
  };
  for (int i = 0; i < track.count && open.any(); ++i) {
    const PathPiece& piece = track.pieces[static_cast<std::size_t>(i)];
    const int count = static_cast<int>(std::ceil(piece.length / step_));
    const double step = piece.length / count;
    Pose2 pose = piece.start;
    check(pose);
    for (int k = 0; k < count && open.any(); ++k) {
      pose = advance(pose, piece.curvature_at(k * step), piece.sharpness, step);
      check(pose);
    }
  }
  return open;
}

std::optional<DriveCost> TrackMaker::cost(const Track& track, bool backwards) const {
  const auto cost = path_cost(vehicle_, ground_, track.path(backwards), LegKind::kTransit);
  return cost ? std::optional(*cost) : std::nullopt;
}

double TrackMaker::height(const Point2& p_map) const {
  const auto here = ground_.sample(p_map);
  return here ? here->height : 0.0;
}

}  // namespace headland::internal
