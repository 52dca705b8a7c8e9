// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "perception/tracking/agent_tracker.hpp"

namespace headland::tracking {

// Takes clusters that hold several bodies apart.
class MergedBodies {
 public:
  // Replaces each detection in which two or more of the tracks are expected, and which is too large
  // for one of them, by one detection for each, and likewise one that is as long as several bodies
  // of its class. Those without points stay as they are. The points of new detections are kept
  // here, until the next call. Does not allocate once it has held as many.
  void take_apart(std::span<const TrackedAgent> tracks, const Point2& sensor,
                  const AgentTrackerConfig& config, std::vector<Detection>& detections);

 private:
  void seed_from_tracks(std::span<const TrackedAgent> tracks, const Detection& detection);
  void seed_from_length(const Detection& detection, const SplitConfig& config);
  void cluster(std::span<const Point2> points);
  void emit(const Point2& sensor, const AgentTrackerConfig& config, std::size_t whole,
            std::vector<Detection>& detections);

  struct Seed {
    Point2 mean{0.0, 0.0};
    double width = 0.0;
  };
  std::vector<Seed> seeds_;
  std::vector<int> seed_of_;    // each point
  std::vector<int> count_of_;   // points of each seed
  std::vector<Point2> points_;  // of all new detections
};

}  // namespace headland::tracking
