// SPDX-License-Identifier: Apache-2.0
#include "perception/rows/lane_search.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"

namespace headland {
namespace {

// What a width at the edge of the tolerance costs, as a share of the score.
constexpr double kWidthCost = 0.2;

}  // namespace

void LaneSearch::sum_up(std::span<const internal::Column> columns, double heading_rad,
                        double reach) {
  reach_m_ = reach;
  const auto bins = static_cast<std::size_t>(std::ceil(2.0 * reach / config_.bin_m));
  below_.assign(bins + 1, 0.0);
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  for (const internal::Column& column : columns) {
    const double along = c * column.x + s * column.y;
    if (along > config_.ahead_m || along < -config_.behind_m) continue;
    const double across = c * column.y - s * column.x;
    const double bin = (across + reach) / config_.bin_m;
    if (!(bin >= 0.0 && bin < static_cast<double>(bins))) continue;
    below_[static_cast<std::size_t>(bin) + 1] += column.weight;
  }
  for (std::size_t i = 1; i < below_.size(); ++i) below_[i] += below_[i - 1];
}

void LaneSearch::keep_best_pair(double heading_rad, double width_m, LaneHypothesis& best) {
  // All in bins; line i lies at the edge below bin i.
  const auto in_bins = [&](double length) {
    return static_cast<int>(std::round(length / config_.bin_m));
  };
  const int last = static_cast<int>(below_.size()) - 1;
  const auto between = [&](int low, int high) {
    return below_[static_cast<std::size_t>(std::min(high, last))] -
           below_[static_cast<std::size_t>(std::max(low, 0))];
  };
  const int wall = in_bins(config_.wall_m);
  const int robot = in_bins(reach_m_);
  const int least = std::max(2, in_bins(width_m - config_.narrower_m));
  const int most = in_bins(width_m + config_.wider_m);
  for (int left = robot + 1; left < robot + most; ++left) {
    const double support_left = between(left - wall, left + wall);
    for (int width = std::max(least, left - robot + 1); width <= most; ++width) {
      const int right = left - width;
      const double support_right = between(right - wall, right + wall);
      const int half_inside = in_bins(0.5 * config_.inside_ratio * width * config_.bin_m);
      const int centre = (left + right) / 2;
      const double inside = between(centre - half_inside, centre + half_inside);
      const double wider = width * config_.bin_m - width_m;
      const double off = wider / (wider > 0.0 ? config_.wider_m : config_.narrower_m);
      const double support = (support_left + support_right) * (1.0 - kWidthCost * off * off);
      const double score = support - config_.inside_weight * inside;
      if (score <= best.score) continue;
      best = {heading_rad,
              (left - robot) * config_.bin_m,
              (right - robot) * config_.bin_m,
              score,
              support_left,
              support_right,
              inside};
    }
  }
}

std::optional<LaneHypothesis> LaneSearch::search(std::span<const internal::Column> columns,
                                                 double width_m, double expected_heading_rad) {
  const double reach = width_m + config_.wider_m + config_.wall_m + config_.bin_m;
  LaneHypothesis best;
  const auto look = [&](double middle, double span, double step) {
    const int steps = static_cast<int>(std::round(span / step));
    for (int i = -steps; i <= steps; ++i) {
      const double heading = middle + i * step;
      sum_up(columns, heading, reach);
      keep_best_pair(heading, width_m, best);
    }
  };
  const double coarse = deg_to_rad(config_.heading_step_deg);
  look(expected_heading_rad, deg_to_rad(config_.heading_span_deg), coarse);
  if (!(best.score > 0.0)) return std::nullopt;
  look(best.heading_rad, coarse, deg_to_rad(config_.fine_step_deg));
  return best;
}

}  // namespace headland
