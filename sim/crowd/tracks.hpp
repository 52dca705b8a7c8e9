// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/world/agent.hpp"

namespace headland {

/// Where someone was recorded to be, over time.
struct Track {
  int id = 0;
  AgentKind kind = AgentKind::kPerson;
  std::vector<double> time_s;    ///< rising; never empty
  std::vector<Point2> position;  ///< [m], one per time

  /// At a time between the first and the last: on the straight between two samples, with its
  /// velocity. At a sample that is the velocity since the sample before, so that a predictor that
  /// sees it is not told the future. O(log n).
  std::optional<Agent> at(double time_s) const;
};

/// A recording: tracks that share a clock, which begins at 0, and a frame [m].
struct TrackSet {
  std::string name;
  double step_s = 0.0;  ///< between samples
  std::vector<Track> tracks;

  double end_s() const;
  /// All who are there at a time, in the order of tracks; `agents` is overwritten.
  void at(double time_s, std::vector<Agent>& agents) const;
};

/// Pedestrians, as the obsmat.txt of OpenTraj's ETH and UCY scenes: per line frame, id, x, z, y and
/// three components of velocity, which are not used; or the four columns frame, id, x, y that
/// benchmarks of prediction use (Social GAN's). Samples are 0.4 s apart; how many frames that
/// is differs (6 in eth, 10 in hotel and zara01), so it is taken to be the smallest distance of two
/// frames of a track. Errors: kFileNotFound; kSyntax with the line.
Result<TrackSet> read_obsmat(const std::string& file);

/// Sheep, a dog and a shepherd, as sheep_dog_drives.csv (Jadhav et al. 2024; columns trial, drive,
/// t_s, agent, role, x_m, y_m): one set a drive, named such as `1/2`. Errors as above.
Result<std::vector<TrackSet>> read_sheep_dog(const std::string& file);

}  // namespace headland
