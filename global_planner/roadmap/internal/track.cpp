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
      step_(ground.flat() ? kStep : std::min(kStep, ground.step())),
      slope_stride_(ground.flat() ? 1 : static_cast<int>(std::min(ground.step(), 100.0) / step_)),
      both_(vehicle.footprint),
      most_pitch_(std::tan(deg_to_rad(vehicle.max_pitch_deg - kSlopeSlack))),
      most_roll_(std::tan(deg_to_rad(vehicle.max_roll_deg - kSlopeSlack))) {
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

Ways TrackMaker::open_ways(const Track& track, double margin, Ways wanted) const {
  const double kept = margin + sweep_;
  Ways open = wanted;
  // Most tracks that do not fit are found out by a coarse look.
  for (const double longest : {kCoarse * step_, step_}) {
    for (int i = 0; i < track.count && open.any(); ++i) {
      int k = 0;
      walk(track.pieces[static_cast<std::size_t>(i)], longest,
           [&](const Pose2& pose, const Point2& heading) {
             if (k++ % slope_stride_ == 0 && !level_enough(pose.position(), heading))
               open = {false, false};
             if (!open.any() || drivable_.contains(pose, both_, kept)) return open.any();
             open.forwards = open.forwards && drivable_.contains(pose, vehicle_.footprint, kept);
             open.backwards =
                 open.backwards && drivable_.contains(reversed(pose), vehicle_.footprint, kept);
             return open.any();
           });
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
