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

double LaneSearch::weight_between(double low, double high) const {
  const auto edge = [&](double across) {
    const double index = std::round((across + reach_m_) / config_.bin_m);
    return static_cast<std::size_t>(std::clamp(index, 0.0, static_cast<double>(below_.size() - 1)));
  };
  return below_[edge(high)] - below_[edge(low)];
}

void LaneSearch::keep_best_pair(double heading_rad, double width_m, LaneHypothesis& best) const {
  const double tolerance = config_.width_tolerance_m;
  const double widest = width_m + tolerance;
  for (double left = config_.bin_m; left < widest; left += config_.bin_m) {
    const double support_left = weight_between(left - config_.wall_m, left + config_.wall_m);
    const double narrowest = std::max(width_m - tolerance, left + config_.bin_m);
    for (double width = narrowest; width <= widest; width += config_.bin_m) {
      const double right = left - width;
      const double support_right = weight_between(right - config_.wall_m, right + config_.wall_m);
      const double centre = 0.5 * (left + right);
      const double half_inside = 0.5 * config_.inside_ratio * width;
      const double inside = weight_between(centre - half_inside, centre + half_inside);
      const double off = (width - width_m) / tolerance;
      const double support = (support_left + support_right) * (1.0 - kWidthCost * off * off);
      const double score = support - config_.inside_weight * inside;
      if (score > best.score) {
        best = {heading_rad, left, right, score, support_left, support_right, inside};
      }
    }
  }
}

std::optional<LaneHypothesis> LaneSearch::search(std::span<const internal::Column> columns,
                                                 double width_m, double expected_heading_rad) {
  const double reach = width_m + config_.width_tolerance_m + config_.wall_m + config_.bin_m;
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
