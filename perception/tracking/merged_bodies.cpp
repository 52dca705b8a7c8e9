// SPDX-License-Identifier: Apache-2.0
#include "perception/tracking/internal/merged_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace headland::tracking {
namespace {

constexpr int kRounds = 5;       // of k-means
constexpr double kReach = 0.15;  // a body's points lie this far off its disc [m]
constexpr int kMostBodies = 8;   // in one cluster
constexpr double kSure = 0.5;    // probability of a class

double length_of(const Detection& detection) {
  return std::hypot(detection.across_m, detection.along_m);
}

bool lies_in(const TrackedAgent& track, const Detection& detection) {
  const double reach = track.radius() + kReach;
  const Point2 position = track.position();
  if ((position - detection.position).norm() > 0.5 * length_of(detection) + reach) return false;
  return std::any_of(detection.points.begin(), detection.points.end(), [&](const Point2& p) {
    return (p - position).squaredNorm() <= reach * reach;
  });
}

}  // namespace

void MergedBodies::seed_from_tracks(std::span<const TrackedAgent> tracks,
                                    const Detection& detection) {
  for (const TrackedAgent& track : tracks) {
    if (static_cast<int>(seeds_.size()) == kMostBodies) return;
    if (track.confirmed && lies_in(track, detection)) {
      seeds_.push_back({track.position(), track.width_m});
    }
  }
}

// As many as fit in, side by side along the longest extent.
void MergedBodies::seed_from_length(const Detection& detection, const SplitConfig& config) {
  const auto sure = std::max_element(detection.probability.begin(), detection.probability.end());
  if (!(*sure > kSure)) return;
  const double lengths[] = {config.person_m, config.livestock_m, config.vehicle_m, 0.0};
  const double body = lengths[sure - detection.probability.begin()];
  const double length = length_of(detection);
  if (body <= 0.0 || length < config.class_ratio * body) return;
  const int count = std::min(kMostBodies, static_cast<int>(std::lround(length / body)));
  const auto farthest = std::max_element(
      detection.points.begin(), detection.points.end(), [&](const Point2& a, const Point2& b) {
        return (a - detection.position).squaredNorm() < (b - detection.position).squaredNorm();
      });
  const Point2 axis = (*farthest - detection.position).normalized();
  for (int i = 0; i < count; ++i) {
    const double along = ((i + 0.5) / count - 0.5) * length;
    seeds_.push_back({detection.position + along * axis, body});
  }
}

// k-means.
void MergedBodies::cluster(std::span<const Point2> points) {
  seed_of_.assign(points.size(), 0);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto nearest =
          std::min_element(seeds_.begin(), seeds_.end(), [&](const Seed& a, const Seed& b) {
            return (a.mean - points[i]).squaredNorm() < (b.mean - points[i]).squaredNorm();
          });
      seed_of_[i] = static_cast<int>(nearest - seeds_.begin());
    }
    for (std::size_t s = 0; s < seeds_.size(); ++s) {
      Point2 sum(0.0, 0.0);
      int count = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (seed_of_[i] != static_cast<int>(s)) continue;
        sum += points[i];
        ++count;
      }
      if (count > 0) seeds_[s].mean = sum / count;
    }
  }
}

void MergedBodies::emit(const Point2& sensor, const AgentTrackerConfig& config, std::size_t whole,
                        std::vector<Detection>& detections) {
  const std::span<const Point2> points = detections[whole].points;
  bool is_first = true;
  for (std::size_t s = 0; s < seeds_.size(); ++s) {
    const std::size_t begin = points_.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (seed_of_[i] == static_cast<int>(s)) points_.push_back(points[i]);
    }
    const std::span<const Point2> own(points_.data() + begin, points_.size() - begin);
    const std::optional<Detection> body = detect_body(own, sensor, config.body, seeds_[s].width);
    if (!body) continue;
    Detection part = detections[whole];
    part.position = body->position;
    // Where the cut runs is a guess.
    part.covariance = 2.0 * body->covariance;
    part.across_m = body->across_m;
    part.along_m = body->along_m;
    part.points_count = body->points_count;
    part.points = own;
    if (is_first) {
      detections[whole] = part;
    } else {
      detections.push_back(part);
    }
    is_first = false;
  }
}

void MergedBodies::take_apart(std::span<const TrackedAgent> tracks, const Point2& sensor,
                              const AgentTrackerConfig& config,
                              std::vector<Detection>& detections) {
  const std::size_t given = detections.size();
  std::size_t most = 0;
  for (const Detection& detection : detections) most += detection.points.size();
  points_.clear();
  points_.reserve(most);  // so that what points into it stays
  for (std::size_t i = 0; i < given; ++i) {
    if (detections[i].points.size() < 2) continue;
    seeds_.clear();
    seed_from_tracks(tracks, detections[i]);
    if (seeds_.size() >= 2) {
      const auto widest =
          std::max_element(seeds_.begin(), seeds_.end(),
                           [](const Seed& a, const Seed& b) { return a.width < b.width; });
      if (length_of(detections[i]) < config.split.merged_ratio * widest->width) continue;
    } else {
      seeds_.clear();
      seed_from_length(detections[i], config.split);
    }
    if (seeds_.size() < 2) continue;
    cluster(detections[i].points);
    emit(sensor, config, i, detections);
  }
}

}  // namespace headland::tracking
