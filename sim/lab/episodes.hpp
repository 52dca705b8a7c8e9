// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "sim/lab/episode_log.hpp"

namespace headland {

/// What one episode found.
struct Episode {
  EpisodeRows rows;  ///< a line of episodes.csv each, at least one (a waypoint each, say)
  /// Processor time of each decision [ms]; kept apart (times.csv), as it is another each time.
  std::vector<double> plan_ms{};
};

/// A study of independent episodes: `runs_count` of each cell.
struct EpisodeGrid {
  std::string study;
  std::string config_yaml;  ///< all that an episode depends on; not runs_count
  std::vector<std::string> columns;
  std::vector<std::string> cells;  ///< names, such as mcts/visible
  int runs_count = 1;
};

/// How a study is run. What it finds does not depend on it.
struct StudyRun {
  int jobs = 1;                            ///< episodes at once
  std::filesystem::path out{};             ///< an existing folder; empty: nothing is kept
  std::function<void(double)> progress{};  ///< gets the share that is done; one call at a time
  std::function<bool()> stopped{};         ///< whether no more episodes shall begin
};

/// Runs `work` for each cell and run, `run.jobs` at once (it must be safe for that, and depend on
/// nothing but its arguments: run k is the same scenario in every cell). Each finished episode goes
/// to episodes.csv and times.csv in `run.out`; those that are there, of the same study and
/// configuration, are not run again. In the end both files are in order, and episodes.csv is the
/// same to the byte whatever the jobs and the interruptions.
/// @return The episodes by cell and run; plan_ms ascending, with two digits. kFileNotWritable if
/// the files are of another configuration or more runs, or there is no space; kStopped if stopped
/// before the end.
Result<std::vector<std::vector<Episode>>> run_episodes(
    const EpisodeGrid& grid, const StudyRun& run,
    const std::function<Episode(int cell, int run)>& work);

/// What run_episodes leaves in its folder.
std::vector<std::string> episode_files();

}  // namespace headland
