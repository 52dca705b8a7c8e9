// SPDX-License-Identifier: Apache-2.0
#include "perception/tracking/metrics.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kAnyMatch = 1e6;   // outweighs all distances [m]
constexpr double kSameMatch = 1e3;  // ... and this all that speak for another track [m]

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

void AgentTrackingMetrics::pair_up(std::span<const TrackPoint> truth,
                                   std::span<const TrackPoint> tracks) {
  costs_.reset(static_cast<int>(truth.size()), static_cast<int>(tracks.size()));
  for (int i = 0; i < costs_.rows(); ++i) {
    const auto before = matched_to_.find(truth[at(i)].id);
    for (int j = 0; j < costs_.columns(); ++j) {
      const double distance = (truth[at(i)].position - tracks[at(j)].position).norm();
      if (!(distance <= reach_m_)) continue;
      const bool same = before != matched_to_.end() && before->second == tracks[at(j)].id;
      // Kept matches come before the number of matches, as CLEAR MOT has it.
      costs_.at(i, j) = distance - kSameMatch - (same ? kAnyMatch : 0.0);
    }
  }
  const std::span<const int> found = assignment_.solve(costs_);
  match_.assign(found.begin(), found.end());
}

void AgentTrackingMetrics::add(std::span<const TrackPoint> truth,
                               std::span<const TrackPoint> tracks) {
  pair_up(truth, tracks);
  int excused = 0;
  for (int i = 0; i < costs_.rows(); ++i) {
    const TrackPoint& someone = truth[at(i)];
    const int j = match_[at(i)];
    if (!someone.counts) {
      if (j >= 0) ++excused;
      continue;
    }
    ++sum_.truth_count;
    for (const TrackPoint& track : tracks) {
      if ((track.position - someone.position).norm() <= reach_m_) {
        ++together_[{someone.id, track.id}];
      }
    }
    if (j < 0) {
      ++sum_.miss_count;
      continue;
    }
    ++sum_.match_count;
    const TrackPoint& track = tracks[at(j)];
    const auto [before, is_first] = matched_to_.try_emplace(someone.id, track.id);
    if (!is_first && before->second != track.id) ++sum_.switch_count;
    before->second = track.id;
    const double distance = (track.position - someone.position).norm();
    distance_sum_ += distance;
    square_sum_ += distance * distance;
    velocity_square_sum_ += (track.velocity - someone.velocity).squaredNorm();
  }
  const int counted = static_cast<int>(tracks.size()) - excused;
  track_count_ += counted;
  sum_.false_count = track_count_ - sum_.match_count;
}

AgentTrackingScore AgentTrackingMetrics::score() const {
  AgentTrackingScore score = sum_;
  if (score.truth_count > 0) {
    score.mota =
        1.0 - static_cast<double>(score.miss_count + score.false_count + score.switch_count) /
                  score.truth_count;
  }
  if (score.match_count > 0) {
    score.motp_m = distance_sum_ / score.match_count;
    score.position_rmse_m = std::sqrt(square_sum_ / score.match_count);
    score.velocity_rmse_mps = std::sqrt(velocity_square_sum_ / score.match_count);
  }
  // The pairing of ids that is together for the most moments.
  std::map<int, int> rows;
  std::map<int, int> columns;
  for (const auto& [ids, moments] : together_) {
    rows.try_emplace(ids.first, static_cast<int>(rows.size()));
    columns.try_emplace(ids.second, static_cast<int>(columns.size()));
  }
  PairCosts costs;
  costs.reset(static_cast<int>(rows.size()), static_cast<int>(columns.size()));
  for (const auto& [ids, moments] : together_) {
    costs.at(rows[ids.first], columns[ids.second]) = -moments;
  }
  PairAssignment assignment;
  double together = 0.0;
  const std::span<const int> pairs = assignment.solve(costs);
  for (int i = 0; i < costs.rows(); ++i) {
    if (pairs[at(i)] >= 0) together -= costs.at(i, pairs[at(i)]);
  }
  const int all = score.truth_count + track_count_;
  score.idf1 = all > 0 ? 2.0 * together / all : 0.0;
  return score;
}

}  // namespace headland
