// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "sim/crowd/tracks.hpp"

namespace headland {

/// A recording by the number of the sample, as it was taken: nothing is interpolated.
class SampledTracks {
 public:
  /// `noise` is the standard deviation of its positions [m], for those who see them.
  explicit SampledTracks(const TrackSet& set, double noise = 0.0);

  double step_s() const { return step_s_; }
  int samples() const { return samples_; }
  int tracks() const { return static_cast<int>(tracks_.size()); }
  AgentKind kind(int track) const { return at(track).agent.kind; }
  int id(int track) const { return at(track).agent.id; }
  /// Where somebody was; none if that was not recorded.
  std::optional<Point2> position(int track, int sample) const;
  /// All who were recorded, without velocities; `agents` is overwritten.
  void see(int sample, std::vector<Agent>& agents) const;

 private:
  struct Recorded {
    Agent agent;
    int first = 0;
    std::vector<std::optional<Point2>> positions;  // from the first sample on
  };
  const Recorded& at(int track) const { return tracks_[static_cast<std::size_t>(track)]; }

  double step_s_ = 0.0;
  int samples_ = 0;
  std::vector<Recorded> tracks_;
};

}  // namespace headland
