// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/report.hpp"
#include "sim/lab/film.hpp"

namespace headland::apps {

/// Longer films are thinned out evenly (the page moves things between frames) to kLongestPeriod; of
/// those that are still longer, the time around the worst event is shown.
inline constexpr int kMostFilmFrames = 500;
inline constexpr double kLongestPeriod = 0.5;  // [s]

/// A film as the report plays it: the planned path, places, what happened, the robot's drive, and
/// those around it.
ReportEpisode film_episode(const Film& film);

}  // namespace headland::apps
