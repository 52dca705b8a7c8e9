// SPDX-License-Identifier: Apache-2.0
// u, v: along and across the row at its present heading, from the robot.
#include "perception/rows/lane_refine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace headland {
namespace {

constexpr double kTukey = 4.685;  // biweight, 95 % efficient with normal residuals
constexpr double kMadToDeviation = 1.4826;
constexpr double kLeastDeviation = 0.05;  // [m]
constexpr double kNearAhead = 4.0;        // [m]
constexpr double kBeginsBehind = 1.5;     // [m]
constexpr double kLeastWeight = 0.5;      // of a station
constexpr double kInsideShare = 0.5;      // of the width, about the centre
constexpr std::array kHalfWidths = {-3.0, -1.0, 1.0, 3.0};

}  // namespace

// Calls take(row, u, v, residual, weight) for each column within the gate of its nearest row.
template <class Frame, class Take>
static void for_each_near(std::span<const internal::Column> columns, const Frame& frame,
                          const LaneRefineConfig& config, Take take) {
  const double c = std::cos(frame.heading_rad);
  const double s = std::sin(frame.heading_rad);
  const double gate = config.gate_ratio * frame.width_m;
  for (const internal::Column& column : columns) {
    const double u = c * column.x + s * column.y;
    if (u > config.ahead_m || u < -config.behind_m) continue;
    const double v = c * column.y - s * column.x;
    const double from_centre = v - frame.offset_m - 0.5 * frame.curvature_1pm * u * u;
    const double half_widths = from_centre / (0.5 * frame.width_m);
    const auto row = static_cast<int>(std::floor(half_widths / 2.0)) + 2;
    if (row < 0 || row > 3) continue;
    const double residual =
        from_centre - kHalfWidths[static_cast<std::size_t>(row)] * 0.5 * frame.width_m;
    if (std::abs(residual) > gate) continue;
    take(static_cast<std::size_t>(row), u, v, residual, static_cast<double>(column.weight));
  }
}

double LaneRefine::deviation_of(std::span<const internal::Column> columns, const Frame& frame) {
  residuals_.clear();
  for_each_near(columns, frame, config_,
                [&](std::size_t row, double, double, double residual, double) {
                  if (row == 1 || row == 2) residuals_.push_back(std::abs(residual));
                });
  if (residuals_.empty()) return kLeastDeviation;
  const auto middle = residuals_.begin() + static_cast<std::ptrdiff_t>(residuals_.size() / 2);
  std::nth_element(residuals_.begin(), middle, residuals_.end());
  return std::max(kLeastDeviation, kMadToDeviation * *middle);
}

void LaneRefine::fill_stations(std::span<const internal::Column> columns, const Frame& frame,
                               double deviation) {
  const auto count = static_cast<std::size_t>(
      std::ceil((config_.ahead_m + config_.behind_m) / config_.station_m) + 1);
  for (auto& row : stations_) row.assign(count, Station{});
  for_each_near(columns, frame, config_,
                [&](std::size_t row, double u, double v, double residual, double column_weight) {
                  const double scaled = residual / (kTukey * deviation);
                  if (std::abs(scaled) >= 1.0) return;
                  const double kept = 1.0 - scaled * scaled;
                  const double weight = column_weight * kept * kept;
                  const auto index =
                      static_cast<std::size_t>((u + config_.behind_m) / config_.station_m);
                  Station& station = stations_[row][index];
                  station.weight += weight;
                  station.u += weight * u;
                  station.v += weight * v;
                });
}

// One step of Gauss-Newton: turns and shifts `frame`, gives the covariance of (offset, heading,
// width, curvature).
Eigen::Matrix4d LaneRefine::solve(Frame& frame, double width_m) const {
  const auto per_variance = [](double deviation) { return 1.0 / (deviation * deviation); };
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  information.diagonal() << per_variance(10.0), per_variance(1.0),
      per_variance(config_.width_deviation_m), per_variance(config_.curvature_1pm);
  right(0) = frame.offset_m * information(0, 0);
  right(2) = width_m * information(2, 2);
  for (std::size_t row = 0; row < stations_.size(); ++row) {
    const double share = row == 1 || row == 2 ? 1.0 : config_.outer_weight;
    for (const Station& station : stations_[row]) {
      if (station.weight < kLeastWeight || share == 0.0) continue;
      const double u = station.u / station.weight;
      const double v = station.v / station.weight;
      const double variance =
          config_.plant_m * config_.plant_m + config_.column_m * config_.column_m / station.weight;
      const Eigen::Vector4d gradient(1.0, u, 0.5 * kHalfWidths[row], 0.5 * u * u);
      information += (share / variance) * gradient * gradient.transpose();
      right += (share / variance * v) * gradient;
    }
  }
  const Eigen::Matrix4d covariance = information.inverse();
  const Eigen::Vector4d solution = covariance * right;
  frame.offset_m = solution(0) * std::cos(std::atan(solution(1)));
  frame.heading_rad += std::atan(solution(1));
  frame.width_m = solution(2);
  frame.curvature_1pm = solution(3);
  return covariance;
}

LaneFit LaneRefine::summary(std::span<const internal::Column> columns, const Frame& frame,
                            const Eigen::Matrix4d& covariance) const {
  LaneFit fit;
  fit.offset_m = frame.offset_m;
  fit.heading_rad = frame.heading_rad;
  fit.width_m = frame.width_m;
  fit.curvature_1pm = frame.curvature_1pm;
  fit.covariance = covariance.topLeftCorner<3, 3>();
  for (std::size_t side = 0; side < 2; ++side) {
    fit.begins_m[side] = std::numeric_limits<double>::infinity();
    for (const Station& station : stations_[side + 1]) {
      if (station.weight < kLeastWeight) continue;
      ++fit.stations[side];
      fit.support[side] += station.weight;
      const double u = station.u / station.weight;
      if (u >= 0.0 && u <= kNearAhead) ++fit.near_stations[side];
      if (u >= -kBeginsBehind) fit.begins_m[side] = std::min(fit.begins_m[side], u);
    }
  }
  const double c = std::cos(frame.heading_rad);
  const double s = std::sin(frame.heading_rad);
  for (const internal::Column& column : columns) {
    const double u = c * column.x + s * column.y;
    if (u > config_.ahead_m || u < -config_.behind_m) continue;
    const double across = c * column.y - s * column.x - frame.offset_m;
    if (std::abs(across) <= 0.5 * kInsideShare * frame.width_m) fit.inside += column.weight;
  }
  return fit;
}

LaneFit LaneRefine::refine(std::span<const internal::Column> columns, const LaneHypothesis& start,
                           double width_m) {
  Frame frame{start.heading_rad, 0.5 * (start.left_m + start.right_m), start.left_m - start.right_m,
              0.0};
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
  for (int pass = 0; pass < config_.passes_count; ++pass) {
    fill_stations(columns, frame, deviation_of(columns, frame));
    covariance = solve(frame, width_m);
    // A frame that ran away has lost its columns; the summary will say so.
    frame.width_m = std::clamp(frame.width_m, 0.5 * width_m, 1.5 * width_m);
  }
  return summary(columns, frame, covariance);
}

}  // namespace headland
