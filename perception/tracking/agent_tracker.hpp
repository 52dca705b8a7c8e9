// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/config/visit.hpp"
#include "core/world/agent.hpp"
#include "perception/tracking/assignment.hpp"
#include "perception/tracking/detection.hpp"
#include "perception/tracking/tracked_agent.hpp"
#include "perception/tracking/view.hpp"

namespace headland {

namespace tracking {
class MergedBodies;
}

/// When one cluster is taken for several bodies.
struct SplitConfig {
  double merged_ratio = 1.4;
  double class_ratio = 1.6;
  double person_m = 0.7;
  double livestock_m = 2.4;
  double vehicle_m = 5.0;

  template <class V>
  void visit(V& v) {
    v("merged_ratio", merged_ratio, config::kPositive,
      "A cluster with several tracks in it is split if it is so much longer than their bodies");
    v("class_ratio", class_ratio, config::kPositive,
      "... and one without, if it is so much longer than a body of its class");
    v("person_m", person_m, config::kPositive, "Length of a body [m]");
    v("livestock_m", livestock_m, config::kPositive, "[m]");
    v("vehicle_m", vehicle_m, config::kPositive, "[m]");
  }
};

struct AgentTrackerConfig {
  MotionConfig motion;
  BodyConfig body;
  SplitConfig split;
  double gate_ratio = 0.999;
  double detection_ratio = 0.9;
  double newcomer_m2 = 1000.0;
  int strong_points_count = 4;
  double visible_patience_s = 0.5;
  double hidden_patience_s = 1.5;
  double lost_m = 1.5;
  double slowing_s = 0.5;
  double part_noise_m = 0.3;
  double class_weight = 0.2;
  double stale_s = 1.0;

  template <class V>
  void visit(V& v) {
    v("motion", motion, "Of those who are followed");
    v("body", body, "Of those who are split from others");
    v("split", split, "Clusters of several bodies");
    v("gate_ratio", gate_ratio, config::Range{0.5, 0.999999},
      "Detections within this quantile of a track's error can be its own (2 degrees of freedom)");
    v("detection_ratio", detection_ratio, config::Range{0.1, 0.99},
      "Of those in full view, so many are detected");
    v("newcomer_m2", newcomer_m2, config::kPositive,
      "Someone new, or something false, appears on so large an area in a scan [m2]");
    v("strong_points_count", strong_points_count, config::Range{1, 100000},
      "Clusters with fewer points can only continue tracks");
    v("visible_patience_s", visible_patience_s, config::kPositive,
      "Who ought to be seen and is not is given up after [s]");
    v("hidden_patience_s", hidden_patience_s, config::kPositive,
      "... and who is hidden or out of range, after [s]");
    v("lost_m", lost_m, config::kPositive,
      "Given up when its position has this standard deviation [m]");
    v("slowing_s", slowing_s, config::kPositive,
      "Time constant at which those not seen are taken to slow down, as they turn or stop [s]");
    v("part_noise_m", part_noise_m, config::kNonNegative,
      "Standard deviation of the centre of a body that is hidden but for an edge [m]");
    v("class_weight", class_weight, config::kFraction,
      "How much of a scan's evidence for a class is new, as scans are alike");
    v("stale_s", stale_s, config::kPositive, "No agents so long after the last scan [s]");
  }
};

enum class AgentTrackerStatus : std::int8_t {
  kUpdated,
  kRestarted,  ///< time went back or jumped ahead by more than both patiences: all are new
  kBadTime     ///< no number, or a little before the last scan: the scan was ignored
};

/// Follows tens of people, or a herd: who is where, and how fast. One Kalman filter each at
/// constant velocity; detections and tracks are paired so that the pairing is the most likely one
/// (global nearest neighbour), first those of many points, then of few (after ByteTrack, Zhang et
/// al. 2022); clusters of several bodies are taken apart by where their tracks are expected. A
/// track is confirmed when seen in two of its first three scans, and dies by what the sensor could
/// see: soon where it ought to be seen, later where it is hidden. Seed 003, III-B.
///
/// Deterministic. One object per thread. O(t d (t + d)) for t tracks and d detections; does not
/// allocate once it has held as many of both.
class AgentTracker {
 public:
  explicit AgentTracker(const AgentTrackerConfig& config = {});
  ~AgentTracker();
  AgentTracker(AgentTracker&&) noexcept;
  AgentTracker& operator=(AgentTracker&&) noexcept;

  /// One scan. Detections that are not sound are left out; of several on one body all but one are,
  /// too. None is fine: those who ought to be seen age.
  AgentTrackerStatus update(std::span<const Detection> detections, const SensorView& view,
                            double time_s);

  /// All, also those not yet confirmed, as of the last scan. Ids are never used again, not even
  /// after a restart.
  std::span<const TrackedAgent> tracks() const { return tracks_; }

  /// Those confirmed, moved on to `time_s`, for planners. False, and nobody, if there was no scan,
  /// or it is older than stale_s or newer than `time_s`.
  bool agents_at(double time_s, std::vector<Agent>& agents) const;

 private:
  AgentTrackerStatus advance(double time_s, double& dt);
  void take(std::span<const Detection> detections);
  void cast_shadows(const SensorView& view);
  void doubt_parts(const SensorView& view);
  void look(const SensorView& view);
  void pair(bool strong);
  void correct_paired(double time_s);
  void age(double dt);
  void begin_new(double time_s);
  bool is_on_a_body(const Detection& detection) const;
  bool is_strong(const Detection& detection) const {
    return detection.points_count >= config_.strong_points_count;
  }

  AgentTrackerConfig config_;
  double gate_ = 0.0;
  double last_s_ = 0.0;
  bool has_scan_ = false;
  int next_id_ = 1;
  std::vector<TrackedAgent> tracks_;

  // Of the scan at hand.
  std::unique_ptr<tracking::MergedBodies> merged_;
  std::vector<Detection> detections_;
  std::vector<HiddenArc> shadows_;
  std::vector<double> visible_;   // share of each track
  std::vector<int> paired_with_;  // detection of each track, -1
  std::vector<char> is_taken_;    // each detection
  PairCosts costs_;
  PairAssignment assignment_;
};

}  // namespace headland
