// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/run/row_sight.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kStill = 1e-3;  // slower counts as standing [m/s]
constexpr double kWindow = 3.0;  // of the path, in which a position is projected [m]

double yaw_rate_of(const Vehicle& vehicle, const VehicleState& state) {
  if (vehicle.steering == Steering::kDifferential) return state.yaw_rate;
  return state.speed * std::tan(state.steering) / vehicle.wheelbase_m;
}

Pose2 moved_in(const Vehicle& vehicle, const VehicleState& state, double duration) {
  const double yaw_rate = yaw_rate_of(vehicle, state);
  if (std::abs(state.speed) < kStill) return {0.0, 0.0, yaw_rate * duration};
  return advance(Pose2{}, yaw_rate / state.speed, state.speed * duration);
}

// Points as they would be had all been shot at the scan's end (seed 000 leaves that to its LIO).
void deskew(const Vehicle& vehicle, const VehicleState& state, double duration,
            std::vector<LidarPoint>& points) {
  for (LidarPoint& point : points) {
    const Pose2 then = moved_in(vehicle, state, static_cast<double>(point.offset_s) - duration);
    const Point2 p = then * Point2(point.position.x(), point.position.y());
    point.position.x() = static_cast<float>(p.x());
    point.position.y() = static_cast<float>(p.y());
  }
}

RowDetectorConfig detector_for(const SensorMount& mount, RowDetectorConfig rows, double width) {
  rows.row_width_m = width;
  rows.sensor_x_m = mount.x_m;
  rows.sensor_y_m = mount.y_m;
  rows.sensor_z_m = mount.z_m;
  return rows;
}

}  // namespace

void RowSightMetrics::add(const RowSightMetrics& other) {
  scans += other.scans;
  valid += other.valid;
  error_m += other.error_m;
  largest_m = std::max(largest_m, other.largest_m);
  blind_m = std::max(blind_m, other.blind_m);
}

RowSight::RowSight(const Vehicle& vehicle, const PerceptionConfig& config, double cycle)
    : vehicle_(vehicle), config_(config), cycle_(cycle) {}

void RowSight::begin_row(double width) {
  detector_.reset();
  row_ = {};
  since_ = {};
  blind_m_ = 0.0;
  if (width > 0.0) detector_.emplace(detector_for(*vehicle_.lidar, config_.rows, width));
}

void RowSight::step(double time, const LidarScan* scan, const Pose2& truth, const Path& path,
                    double s, VehicleEstimate& known) {
  if (!detector_) return;
  since_ = since_ * moved_in(vehicle_, known.state, cycle_);
  blind_m_ += std::abs(known.state.speed) * cycle_;
  if (scan != nullptr) {
    look(time, *scan, known.state);
    score(truth, path, s);
  }
  if (row_.valid) blind_m_ = 0.0;
  metrics_.blind_m = std::max(metrics_.blind_m, blind_m_);
  if (!row_.valid) return;
  // The row's middle in this base, then this base beside the path.
  const Pose2 T_scan_row{-row_.offset_m * std::sin(row_.heading_rad),
                         row_.offset_m * std::cos(row_.heading_rad), row_.heading_rad};
  const Pose2 T_row_base = inverse(T_scan_row) * since_;
  const Point2 place = known.state.pose.position();
  const double at = path.project(place, std::max(0.0, s - kWindow), s + kWindow).s;
  const Pose2 on_path = path.at(at).pose;
  known.state.pose = on_path * Pose2{0.0, T_row_base.y, T_row_base.yaw};
}

void RowSight::look(double time, const LidarScan& scan, const VehicleState& known) {
  crop_to_base(scan.points, vehicle_.lidar->pose(), config_.view, points_);
  deskew(vehicle_, known, time - scan.time_s, points_);
  row_ = detector_->update(points_, since_, time);
  since_ = {};
}

void RowSight::score(const Pose2& truth, const Path& path, double s) {
  ++metrics_.scans;
  if (!row_.valid) return;
  ++metrics_.valid;
  const double from = std::max(0.0, s - kWindow);
  const double off = path.project(truth.position(), from, s + kWindow).lateral_error;
  const double error = std::abs(-row_.offset_m - off);
  metrics_.error_m += error;
  metrics_.largest_m = std::max(metrics_.largest_m, error);
}

}  // namespace headland
