// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/prediction/sampled_tracks.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

// Recordings pause, and go on between two samples of the clock before: rounding down keeps what
// was sampled together together.
int sample_of(double time_s, double step_s) {
  constexpr double kRounding = 0.01;
  return static_cast<int>(std::floor(time_s / step_s + kRounding));
}

}  // namespace

SampledTracks::SampledTracks(const TrackSet& set, double noise) : step_s_(set.step_s) {
  for (const Track& track : set.tracks) {
    Recorded recorded;
    recorded.agent = track.at(track.time_s.front()).value();
    recorded.agent.velocity.setZero();
    recorded.agent.noise_m = noise;
    recorded.first = sample_of(track.time_s.front(), step_s_);
    for (std::size_t i = 0; i < track.time_s.size(); ++i) {
      const int sample = sample_of(track.time_s[i], step_s_);
      recorded.positions.resize(static_cast<std::size_t>(sample - recorded.first + 1));
      recorded.positions.back() = track.position[i];
      samples_ = std::max(samples_, sample + 1);
    }
    tracks_.push_back(std::move(recorded));
  }
}

std::optional<Point2> SampledTracks::position(int track, int sample) const {
  const Recorded& recorded = at(track);
  const int index = sample - recorded.first;
  if (index < 0 || index >= std::ssize(recorded.positions)) return std::nullopt;
  return recorded.positions[static_cast<std::size_t>(index)];
}

void SampledTracks::see(int sample, std::vector<Agent>& agents) const {
  agents.clear();
  for (int i = 0; i < tracks(); ++i) {
    if (const auto seen = position(i, sample)) {
      agents.push_back(at(i).agent);
      agents.back().position = *seen;
    }
  }
}

}  // namespace headland
