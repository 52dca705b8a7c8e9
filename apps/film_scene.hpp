// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/report.hpp"
#include "sim/lab/film.hpp"

namespace headland::apps {

/// Frames of a film longer than this are thinned out evenly; the page moves things between them.
inline constexpr int kMostFilmFrames = 500;

/// A film as the report plays it: the planned path, places, what happened, the robot's drive, and
/// those around it.
ReportEpisode film_episode(const Film& film);

}  // namespace headland::apps
