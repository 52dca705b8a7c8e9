// SPDX-License-Identifier: Apache-2.0
#include "perception/tracking/agent_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "perception/tracking/internal/merged_bodies.hpp"

namespace headland {
namespace {

constexpr int kFirstScans = 3;           // a track is confirmed ...
constexpr int kConfirmingSights = 2;     // ... by so many sights in these
constexpr double kVisible = 0.5;         // share of the width: it ought to be seen
constexpr double kLeastDetection = 0.1;  // of those hidden: some are seen nevertheless
constexpr double kBehind = 0.3;          // a body's shadow begins so far behind its far side [m]
constexpr double kBesides = 0.3;         // of what is seen of a body, there may be more of it [m]
constexpr double kSameBody = 0.3;        // no two bodies are nearer to each other [m]
constexpr double kGrow = 0.2;            // low-pass of a body's size, per scan, ...
constexpr double kShrink = 0.05;         // ... smaller, as what hides a part makes it smaller
constexpr double kSameTime = 1e-6;       // rounding of times [s]
constexpr double kLateScan = 1.0;        // a scan this late is not late: time was set back [s]

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void follow(double& size, double seen) { size += (seen > size ? kGrow : kShrink) * (seen - size); }

}  // namespace

AgentTracker::AgentTracker(const AgentTrackerConfig& config)
    : config_(config),
      gate_(-2.0 * std::log(1.0 - config.gate_ratio)),  // chi-squared, 2 degrees of freedom
      merged_(std::make_unique<tracking::MergedBodies>()) {}
AgentTracker::~AgentTracker() = default;
AgentTracker::AgentTracker(AgentTracker&&) noexcept = default;
AgentTracker& AgentTracker::operator=(AgentTracker&&) noexcept = default;

AgentTrackerStatus AgentTracker::update(std::span<const Detection> detections,
                                        const SensorView& view, double time_s) {
  double dt = 0.0;
  const AgentTrackerStatus status = advance(time_s, dt);
  if (status == AgentTrackerStatus::kBadTime) return status;
  for (TrackedAgent& track : tracks_) {
    predict(track, dt, config_.motion);
    if (track.absence > 0.0) track.state.tail<2>() *= std::exp(-dt / config_.slowing_s);
  }
  take(detections);
  merged_->take_apart(tracks_, view.sensor, config_, detections_);
  cast_shadows(view);
  doubt_parts(view);
  look(view);
  pair(true);
  pair(false);
  correct_paired(time_s);
  age(dt);
  begin_new(time_s);
  return status;
}

AgentTrackerStatus AgentTracker::advance(double time_s, double& dt) {
  if (!std::isfinite(time_s)) return AgentTrackerStatus::kBadTime;
  dt = has_scan_ ? time_s - last_s_ : 0.0;
  const bool is_again = has_scan_ && dt <= 0.0;
  if (is_again && dt > -kLateScan) return AgentTrackerStatus::kBadTime;
  has_scan_ = true;
  last_s_ = time_s;
  if (!is_again && dt <= config_.visible_patience_s + config_.hidden_patience_s) {
    return AgentTrackerStatus::kUpdated;
  }
  tracks_.clear();
  dt = 0.0;
  return AgentTrackerStatus::kRestarted;
}

void AgentTracker::take(std::span<const Detection> detections) {
  detections_.clear();
  for (const Detection& detection : detections) {
    if (is_sound(detection) && detection.points_count > 0) detections_.push_back(detection);
  }
}

void AgentTracker::cast_shadows(const SensorView& view) {
  shadows_.assign(view.hidden.begin(), view.hidden.end());
  for (const Detection& detection : detections_) {
    const double depth = std::max(detection.along_m, detection.across_m);
    shadows_.push_back(
        shadow_of(view.sensor, detection.position, detection.across_m, 0.5 * depth + kBehind));
  }
}

// Where something nearer hides a part of a body, what is seen of it says less about its centre.
void AgentTracker::doubt_parts(const SensorView& view) {
  for (Detection& detection : detections_) {
    const double radius = 0.5 * detection.across_m + kBesides;
    const double hidden = 1.0 - view.visible_share(detection.position, radius, shadows_);
    const double noise = config_.part_noise_m * hidden;
    detection.covariance += noise * noise * Eigen::Matrix2d::Identity();
  }
}

void AgentTracker::look(const SensorView& view) {
  visible_.clear();
  for (const TrackedAgent& track : tracks_) {
    visible_.push_back(view.visible_share(track.position(), track.radius(), shadows_));
  }
  paired_with_.assign(tracks_.size(), -1);
  is_taken_.assign(detections_.size(), 0);
}

// A pair's cost is what it adds to -2 ln of the likelihood of the scan, against the track being
// missed and the detection being of someone new or of nobody.
void AgentTracker::pair(bool strong) {
  costs_.reset(static_cast<int>(tracks_.size()), static_cast<int>(detections_.size()));
  for (int t = 0; t < costs_.rows(); ++t) {
    if (paired_with_[at(t)] >= 0) continue;
    const double seen = std::max(kLeastDetection, config_.detection_ratio * visible_[at(t)]);
    const double alone = 2.0 * std::log(config_.newcomer_m2 / (2.0 * kPi * (1.0 - seen)));
    for (int d = 0; d < costs_.columns(); ++d) {
      const Detection& detection = detections_[at(d)];
      if (is_taken_[at(d)] || is_strong(detection) != strong) continue;
      const Fit fit = fit_of(tracks_[at(t)], detection);
      if (!(fit.distance2 <= gate_)) continue;
      costs_.at(t, d) = fit.distance2 + fit.log_determinant - alone;
    }
  }
  const std::span<const int> found = assignment_.solve(costs_);
  for (int t = 0; t < costs_.rows(); ++t) {
    const int d = found[at(t)];
    if (d < 0) continue;
    paired_with_[at(t)] = d;
    is_taken_[at(d)] = 1;
  }
}

void AgentTracker::correct_paired(double time_s) {
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    TrackedAgent& track = tracks_[t];
    track.cluster = -1;
    if (paired_with_[t] < 0) continue;
    const Detection& detection = detections_[at(paired_with_[t])];
    correct(track, detection);
    follow(track.width_m, detection.across_m);
    follow(track.height_m, detection.height_m);
    track.probability = fuse(track.probability, detection.probability, config_.class_weight);
    track.last_s = time_s;
    track.absence = 0.0;
    track.cluster = detection.cluster;
    ++track.seen_count;
    ++track.chance_count;
    if (track.seen_count >= kConfirmingSights) track.confirmed = true;
  }
}

// Who was not seen gets nearer to being given up: fast if it ought to have been. One whose place is
// taken by another's body is hidden by it.
void AgentTracker::age(double dt) {
  const auto is_lost = [&](const TrackedAgent& track) {
    const double spread = std::sqrt(0.5 * track.position_covariance().trace());
    const bool is_late = !track.confirmed && track.chance_count >= kFirstScans;
    return track.absence >= 1.0 || spread > config_.lost_m || is_late;
  };
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    if (paired_with_[t] >= 0) continue;
    TrackedAgent& track = tracks_[t];
    const bool is_covered =
        std::any_of(detections_.begin(), detections_.end(), [&](const Detection& detection) {
          const double reach = 0.5 * std::max(detection.across_m, detection.along_m);
          return (detection.position - track.position()).norm() < std::max(reach, kSameBody);
        });
    const bool ought = visible_[t] >= kVisible && !is_covered;
    if (ought || is_covered) ++track.chance_count;
    track.absence += dt / (ought ? config_.visible_patience_s : config_.hidden_patience_s);
  }
  std::erase_if(tracks_, is_lost);
}

void AgentTracker::begin_new(double time_s) {
  for (std::size_t d = 0; d < detections_.size(); ++d) {
    if (is_taken_[d] || !is_strong(detections_[d]) || is_on_a_body(detections_[d])) continue;
    tracks_.push_back(begin_track(detections_[d], config_.motion, next_id_++, time_s));
    tracks_.back().cluster = detections_[d].cluster;
  }
}

// A part of somebody who is followed, or a second detection of one.
bool AgentTracker::is_on_a_body(const Detection& detection) const {
  return std::any_of(tracks_.begin(), tracks_.end(), [&](const TrackedAgent& track) {
    const bool is_seen = track.last_s == last_s_;
    return is_seen &&
           (track.position() - detection.position).norm() < std::max(track.radius(), kSameBody);
  });
}

bool AgentTracker::agents_at(double time_s, std::vector<Agent>& agents) const {
  agents.clear();
  const double age = time_s - last_s_;
  if (!has_scan_ || !(age >= -kSameTime && age <= config_.stale_s)) return false;
  for (TrackedAgent track : tracks_) {
    if (!track.confirmed) continue;
    predict(track, std::max(0.0, age), config_.motion);
    agents.push_back(to_agent(track));
  }
  return true;
}

}  // namespace headland
