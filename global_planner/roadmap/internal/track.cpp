// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/internal/track.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/dubins.hpp"

namespace headland::internal {
namespace {

constexpr double kStep = 0.25;  // [m]
// The slope changes along a step, and other checks sample other points.
constexpr double kSlopeSlack = 0.25;   // [deg]
constexpr double kCoarse = 8.0;        // steps of the first look at a track
constexpr double kLongestRatio = 1.3;  // of a clothoid to its chord

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
      step_(ground.flat() ? kStep : std::min(kStep, ground.step())),
      both_(vehicle.footprint),
      most_pitch_(std::tan(deg_to_rad(std::max(0.0, vehicle.max_pitch_deg - kSlopeSlack)))),
      most_roll_(std::tan(deg_to_rad(std::max(0.0, vehicle.max_roll_deg - kSlopeSlack)))) {
  both_.front_m = std::max(both_.front_m, both_.rear_m);
  both_.rear_m = both_.front_m;
  // Every point of the outline turns about a centre no further away than this.
  const double reach = radius_ + std::hypot(both_.front_m, 0.5 * both_.width_m);
  stray_ = 0.5 * step_ * reach / radius_;
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

bool TrackMaker::level_enough(const Point2& place, const Point2& heading) const {
  const auto here = ground_.sample(place);
  if (!here) return false;
  const Point2 left(-heading.y(), heading.x());
  return std::abs(here->gradient.dot(heading)) <= most_pitch_ &&
         std::abs(here->gradient.dot(left)) <= most_roll_;
}

bool TrackMaker::fits(const Pose2& pose, double margin) const {
  return drivable_.contains(pose, vehicle_.footprint, margin) &&
         level_enough(pose.position(), pose.heading());
}

// Calls visit(pose, heading) at equal steps of a piece, none longer than `longest` [m], as long as
// it says true. Simpson's rule over a step: to a micrometre.
template <class Visit>
void TrackMaker::walk(const PathPiece& piece, double longest, Visit visit) {
  const int count = std::max(1, static_cast<int>(std::ceil(piece.length / longest)));
  const double step = piece.length / count;
  const auto yaw_at = [&piece](double s) {
    return piece.start.yaw + (piece.curvature + 0.5 * piece.sharpness * s) * s;
  };
  Pose2 pose = piece.start;
  Point2 heading = pose.heading();
  for (int k = 0; visit(pose, heading) && k < count; ++k) {
    const Pose2 middle{0.0, 0.0, yaw_at((k + 0.5) * step)};
    const Pose2 end{0.0, 0.0, yaw_at((k + 1) * step)};
    const Point2 before = heading;
    heading = end.heading();
    const Point2 place = pose.position() + step / 6.0 * (before + 4.0 * middle.heading() + heading);
    pose = {place.x(), place.y(), end.yaw};
  }
}

template <class Visit>
void TrackMaker::walk(const Track& track, double longest, Visit visit) {
  bool go_on = true;
  for (int i = 0; i < track.count && go_on; ++i) {
    walk(track.pieces[static_cast<std::size_t>(i)], longest,
         [&](const Pose2& pose, const Point2& heading) { return go_on = visit(pose, heading); });
  }
}

void TrackMaker::check_outline(const Pose2& pose, double margin, Ways& open) const {
  if (drivable_.contains(pose, both_, margin)) return;
  open.forwards = open.forwards && drivable_.contains(pose, vehicle_.footprint, margin);
  open.backwards = open.backwards && drivable_.contains(reversed(pose), vehicle_.footprint, margin);
}

// A coarse look finds out most tracks that do not fit, and those with room to spare on all sides,
// of which only the slopes remain to be looked at.
Ways TrackMaker::open_ways(const Track& track, double margin, Ways wanted) const {
  const double kept = margin + sweep_;
  Ways open = wanted;
  bool roomy = true;
  walk(track, kCoarse * step_, [&](const Pose2& pose, const Point2& heading) {
    if (!level_enough(pose.position(), heading)) open = {false, false};
    roomy = roomy && drivable_.contains(pose, both_, kept + kCoarse * stray_);
    if (!roomy) check_outline(pose, kept, open);
    return open.any();
  });
  if (!open.any() || (roomy && ground_.flat())) return open;
  walk(track, roomy ? ground_.step() : step_, [&](const Pose2& pose, const Point2& heading) {
    if (!level_enough(pose.position(), heading)) open = {false, false};
    if (!roomy) check_outline(pose, kept, open);
    return open.any();
  });
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
