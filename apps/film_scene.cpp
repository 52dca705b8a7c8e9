// SPDX-License-Identifier: Apache-2.0
#include "apps/film_scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "apps/agent_tracks.hpp"
#include "core/geometry/angle.hpp"

namespace headland::apps {
namespace {

constexpr int kCorners = 48;  // of a drawn circle

Polygon circle(const Point2& centre, double radius) {
  Polygon polygon;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * kPi * i / kCorners;
    polygon.outer.push_back(centre + radius * Point2(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

std::vector<ReportFeature> features_of(const Film& film, double first_s, double last_s) {
  std::vector<ReportFeature> features;
  ReportFeature path = ReportFeature::line("plan", "", film.path);
  path.leg_kind = "transit";
  if (film.path.size() > 1) features.push_back(std::move(path));
  for (std::size_t i = 0; i < film.places.size(); ++i) {
    const FilmPlace& place = film.places[i];
    ReportFeature goal =
        ReportFeature::polygon("goal", place.name, circle(place.position, place.radius_m));
    goal.leg = static_cast<int>(i);
    features.push_back(std::move(goal));
    features.push_back(ReportFeature::point("poi", place.name, place.position));
  }
  for (const FilmEvent& event : film.events) {
    if (event.time_s < first_s || event.time_s > last_s) continue;
    ReportFeature mark = ReportFeature::point(event.kind, event.text, event.position);
    mark.t_s = event.time_s;
    features.push_back(std::move(mark));
  }
  return features;
}

ReportSeries series_of(const std::vector<const FilmFrame*>& frames) {
  ReportSeries series;
  for (const FilmFrame* frame : frames) {
    series.s_m.push_back(frame->driven_m);
    series.x_m.push_back(frame->robot.x);
    series.y_m.push_back(frame->robot.y);
    series.error_m.push_back(frame->off_m);
    series.steering_deg.push_back(rad_to_deg(frame->steering_rad));
    series.speed_mps.push_back(frame->speed_mps);
    series.leg.push_back(frame->place);
    series.t_s.push_back(frame->time_s);
    series.yaw_rad.push_back(wrap_angle(frame->robot.yaw));
    series.clearance_m.push_back(frame->clearance_m);
  }
  const bool steers = std::any_of(series.steering_deg.begin(), series.steering_deg.end(),
                                  [](double angle) { return angle != 0.0; });
  if (!steers) series.steering_deg.clear();
  return series;
}

// Three quarters of the way through what is shown.
double worst_moment(const Film& film) {
  for (const char* kind : {"given_up", "contact", "near_robot", "near_agent"}) {
    for (const FilmEvent& event : film.events) {
      if (event.kind == kind) return event.time_s;
    }
  }
  return 0.0;
}

std::vector<const FilmFrame*> shown_frames(const Film& film) {
  std::vector<const FilmFrame*> shown;
  if (film.frames.size() < 2) return shown;
  const double step = film.frames[1].time_s - film.frames[0].time_s;
  const std::size_t longest = std::max<std::size_t>(1, std::lround(kLongestPeriod / step));
  const std::size_t stride = std::min(longest, film.frames.size() / kMostFilmFrames + 1);
  const std::size_t length = std::min(film.frames.size(), stride * kMostFilmFrames);
  const double before = 0.75 * static_cast<double>(length);
  const double first = std::max(0.0, worst_moment(film) / step - before);
  const std::size_t begin = std::min(static_cast<std::size_t>(first), film.frames.size() - length);
  for (std::size_t i = begin; i < begin + length; i += stride) shown.push_back(&film.frames[i]);
  return shown;
}

}  // namespace

ReportEpisode film_episode(const Film& film) {
  const std::vector<const FilmFrame*> frames = shown_frames(film);
  ReportEpisode episode{film.name, film.note, {}};
  if (frames.empty()) return episode;
  episode.scene.features = features_of(film, frames.front()->time_s, frames.back()->time_s);
  std::vector<AgentsAt> sights;
  for (const FilmFrame* frame : frames) sights.push_back({frame->time_s, frame->agents});
  episode.scene.agents = agent_tracks(sights);
  episode.scene.vehicles = {
      {.name = "robot", .series = series_of(frames), .outline = film.outline}};
  return episode;
}

}  // namespace headland::apps
