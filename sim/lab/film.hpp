// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/geometry/polygon.hpp"
#include "core/geometry/pose2.hpp"
#include "core/model/vehicle.hpp"
#include "core/world/agent.hpp"
#include "sim/lab/episode_log.hpp"
#include "sim/lab/episodes.hpp"

namespace headland {

/// A moment of an episode.
struct FilmFrame {
  double time_s = 0.0;
  Pose2 robot;  ///< its base
  double speed_mps = 0.0;
  double steering_rad = 0.0;
  double driven_m = 0.0;        ///< since the start
  double off_m = 0.0;           ///< from the planned path, left positive
  double clearance_m = 0.0;     ///< from the robot to the nearest agent, outline to outline
  int place = 0;                ///< of Film::places: the next one
  std::vector<Agent> agents{};  ///< those near enough to matter
};

/// Something that happened.
struct FilmEvent {
  double time_s = 0.0;
  Point2 position{0.0, 0.0};  ///< [m, map]
  std::string kind;  ///< near_agent, near_robot (by whose doing), near_miss, contact, given_up
  std::string text;
};

struct FilmPlace {
  std::string name;
  Point2 position{0.0, 0.0};  ///< [m, map]
  double radius_m = 1.0;      ///< it is reached within
};

/// An episode of a study, to be looked at: what was where, and what happened.
struct Film {
  std::string name;  ///< of its cell, and its number
  std::string note;  ///< why it was chosen
  Polyline path;     ///< planned; empty: straight to the places
  std::vector<FilmPlace> places;
  Footprint outline;  ///< of the robot
  std::vector<FilmFrame> frames;
  std::vector<FilmEvent> events;
};

/// How far an agent's disc is from the outline of a vehicle at that pose [m]; negative: it
/// overlaps.
double outline_gap(const Footprint& outline, const Pose2& pose, const Point2& agent, double radius);

/// What makes an episode worth a look.
struct FilmReason {
  std::string what;
  std::function<bool(const Episode&)> holds;
};

/// An episode to be filmed, and why.
struct FilmChoice {
  EpisodeKey key;
  std::string why;
};

/// At most `count` episodes that show how planners fare, as many of each, at least one: the first
/// for each reason, in the reasons' order; the first of all if none holds.
/// @param episodes By cell and run.
/// @param planners Of each cell.
std::vector<FilmChoice> choose_films(const std::vector<std::vector<Episode>>& episodes,
                                     const std::vector<std::string>& planners,
                                     const std::vector<FilmReason>& reasons, int count);

}  // namespace headland
