// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "perception/tracking/assignment.hpp"

namespace headland {

/// Someone at one moment, as it is or as a tracker says.
struct TrackPoint {
  int id = 0;
  Point2 position{0.0, 0.0};  ///< in `map` [m]
  Point2 velocity{0.0, 0.0};  ///< [m/s]
  /// Of the truth: false where no sensor could see it. Then neither finding nor missing it counts.
  bool counts = true;
};

/// How well a tracker follows: CLEAR MOT (Bernardin and Stiefelhagen 2008), IDF1 (Ristani et al.
/// 2016).
struct AgentTrackingScore {
  int truth_count = 0;             ///< all who were there, over all moments
  int match_count = 0;             ///< ... and were found
  int miss_count = 0;              ///< ... and were not
  int false_count = 0;             ///< tracks of nobody
  int switch_count = 0;            ///< somebody got another id than before
  double mota = 0.0;               ///< 1 - (misses + false + switches) / truth; 0 without any truth
  double motp_m = 0.0;             ///< mean distance of the matches [m]
  double idf1 = 0.0;               ///< F1 of the best lasting pairing of ids, 0 to 1
  double position_rmse_m = 0.0;    ///< of the matches [m]
  double velocity_rmse_mps = 0.0;  ///< ... [m/s]
};

/// Gathers the score, moment by moment. A track and someone within `reach` [m] can match; matches
/// of the moment before stay as long as they can, the others get the least sum of distances.
class AgentTrackingMetrics {
 public:
  explicit AgentTrackingMetrics(double reach_m) : reach_m_(reach_m) {}

  /// Ids are each unique within a moment.
  void add(std::span<const TrackPoint> truth, std::span<const TrackPoint> tracks);
  AgentTrackingScore score() const;

 private:
  void pair_up(std::span<const TrackPoint> truth, std::span<const TrackPoint> tracks);

  double reach_m_;
  AgentTrackingScore sum_;
  double distance_sum_ = 0.0;
  double square_sum_ = 0.0;
  double velocity_square_sum_ = 0.0;
  int track_count_ = 0;            // over all moments, but for those of whom nobody could see
  std::map<int, int> matched_to_;  // id of the truth -> id of the track, as last matched
  std::map<std::pair<int, int>, int> together_;  // ids within reach of each other: moments
  PairCosts costs_;
  PairAssignment assignment_;
  std::vector<int> match_;  // of each of the truth: place among the tracks, -1
};

}  // namespace headland
