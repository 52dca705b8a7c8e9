// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/run/row_sight.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kWindow = 3.0;     // of the path, in which a position is projected [m]
constexpr double kSameTick = 1e-6;  // [s]

double yaw_rate_of(const Vehicle& vehicle, const VehicleState& state) {
  if (vehicle.steering == Steering::kDifferential) return state.yaw_rate;
  return state.speed * std::tan(state.steering) / vehicle.wheelbase_m;
}

// Points as they would be had all been shot at the scan's end (seed 000 leaves that to its LIO).
void deskew(double speed, double yaw_rate, double duration, std::vector<LidarPoint>& points) {
  for (LidarPoint& point : points) {
    const double ago = duration - static_cast<double>(point.offset_s);
    const double curvature = std::abs(speed) > 1e-3 ? yaw_rate / speed : 0.0;
    const Pose2 then = advance(Pose2{}, curvature, -speed * ago);
    const Point2 p = then * Point2(point.position.x(), point.position.y());
    point.position.x() = static_cast<float>(p.x());
    point.position.y() = static_cast<float>(p.y());
  }
}

RowDetectorConfig detector_for(const PerceptionConfig& config, double width) {
  RowDetectorConfig rows = config.rows;
  rows.row_width_m = width;
  rows.sensor_x_m = config.mount.x_m;
  rows.sensor_y_m = config.mount.y_m;
  rows.sensor_z_m = config.mount.z_m;
  return rows;
}

}  // namespace

OrchardConfig plants_of(Crop crop) {
  const bool in_leaf = crop == Crop::kOrchardLeaf || crop == Crop::kVineyardLeaf;
  const bool vines = crop == Crop::kVineyardBare || crop == Crop::kVineyardLeaf;
  return vines ? vineyard(in_leaf) : fruit_orchard(in_leaf);
}

void RowSightMetrics::add(const RowSightMetrics& other) {
  scans += other.scans;
  valid += other.valid;
  error_m += other.error_m;
  largest_m = std::max(largest_m, other.largest_m);
  blind_m = std::max(blind_m, other.blind_m);
}

RowSight::RowSight(const Vehicle& vehicle, const PerceptionConfig& config, const LidarScene& scene,
                   std::uint64_t seed, double cycle)
    : vehicle_(vehicle),
      config_(config),
      scene_(scene),
      lidar_(config.lidar, config.mount, seed),
      cycle_(cycle) {}

void RowSight::begin_row(double width) {
  detector_.reset();
  row_ = {};
  since_ = {};
  is_scanning_ = false;
  blind_m_ = 0.0;
  if (width > 0.0) detector_.emplace(detector_for(config_, width));
}

Pose2 RowSight::moved_in(const VehicleState& known, double duration) const {
  const double yaw_rate = yaw_rate_of(vehicle_, known);
  if (std::abs(known.speed) < 1e-3) return {0.0, 0.0, yaw_rate * duration};
  return advance(Pose2{}, yaw_rate / known.speed, known.speed * duration);
}

void RowSight::step(double time, const VehicleState& truth, const Path& path, double s,
                    VehicleEstimate& known) {
  if (!detector_) return;
  since_ = since_ * moved_in(known.state, cycle_);
  blind_m_ += std::abs(known.state.speed) * cycle_;
  const double begin = due_s_ - lidar_.duration();
  if (!is_scanning_ && time >= begin - kSameTick) {
    is_scanning_ = true;
    scan_begin_ = truth.pose;
    due_s_ = std::max(due_s_, time + lidar_.duration());
  }
  if (is_scanning_ && time >= due_s_ - kSameTick) {
    look(time, truth, known.state);
    score(truth, path, s);
    is_scanning_ = false;
    due_s_ += config_.period_s;
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

void RowSight::look(double time, const VehicleState& truth, const VehicleState& known) {
  const auto motion = linear_motion(scene_.pose_on_ground(scan_begin_),
                                    scene_.pose_on_ground(truth.pose), lidar_.duration());
  lidar_.scan(scene_, motion, time - lidar_.duration(), scan_);
  crop_to_base(scan_.points, config_.mount.pose(), config_.view, points_);
  deskew(known.speed, yaw_rate_of(vehicle_, known), lidar_.duration(), points_);
  row_ = detector_->update(points_, since_, time);
  since_ = {};
}

void RowSight::score(const VehicleState& truth, const Path& path, double s) {
  ++metrics_.scans;
  if (!row_.valid) return;
  ++metrics_.valid;
  const double from = std::max(0.0, s - kWindow);
  const double off = path.project(truth.pose.position(), from, s + kWindow).lateral_error;
  const double error = std::abs(-row_.offset_m - off);
  metrics_.error_m += error;
  metrics_.largest_m = std::max(metrics_.largest_m, error);
}

}  // namespace headland
