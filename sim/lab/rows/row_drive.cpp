// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/rows/row_drive.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace headland {
namespace {

constexpr double kEndCounts = 8.0;   // the end's errors are taken so near to it [m]
constexpr double kBlockApart = 0.5;  // the headland ends so far ahead of the next block [m]

// A lidar on a robot: scans from still poses (as after deskewing), in base.
class Rig {
 public:
  Rig(const LidarScene& scene, const LidarConfig& lidar, const SensorMount& mount,
      std::uint64_t seed)
      : scene_(scene), simulator_(lidar, mount, seed), T_base_sensor_(mount.pose().cast<float>()) {}

  const std::vector<LidarPoint>& scan(const Pose2& pose, double time) {
    const Eigen::Isometry3d T_map_base = scene_.pose_on_ground(pose);
    simulator_.scan(
        scene_, [&](double) { return T_map_base; }, time, scan_);
    for (LidarPoint& point : scan_.points) point.position = T_base_sensor_ * point.position;
    return scan_.points;
  }

 private:
  const LidarScene& scene_;
  LidarSimulator simulator_;
  Eigen::Isometry3f T_base_sensor_;
  LidarScan scan_;
};

class Odometry {
 public:
  Odometry(const RowDriveConfig& config, std::uint64_t seed)
      : config_(config), random_(seed, "row_odometry") {}

  Pose2 moved_to(const Pose2& pose) {
    Pose2 moved = is_first_ ? Pose2{} : inverse(last_) * pose;
    is_first_ = false;
    last_ = pose;
    moved.x *= 1.0 + config_.scale_ratio;
    moved.yaw += deg_to_rad(config_.turn_noise_deg) * random_.normal();
    return moved;
  }

 private:
  const RowDriveConfig& config_;
  RandomStream random_;
  Pose2 last_;
  bool is_first_ = true;
};

// The line half way between the rows beside y = 0, from the plants as they were meant.
class CentreLine {
 public:
  explicit CentreLine(const LidarScene& scene) {
    const auto& lines = scene.plant_lines();
    for (const Polyline& line : lines) {
      if (line.empty() || line.front().x() > 1.0) continue;  // the next block's
      const double y = line.front().y();
      if (y >= 0.0 && (left_ == nullptr || y < left_->front().y())) left_ = &line;
      if (y < 0.0 && (right_ == nullptr || y > right_->front().y())) right_ = &line;
    }
  }

  double y(double x) const { return 0.5 * (y_of(left_, x) + y_of(right_, x)); }
  double heading(double x) const { return std::atan((y(x + 0.5) - y(x - 0.5))); }
  // Of the line from the robot, left positive.
  double offset(const Pose2& pose) const {
    return (y(pose.x) - pose.y) * std::cos(heading(pose.x));
  }

 private:
  static double y_of(const Polyline* line, double x) {
    if (line == nullptr) return 0.0;
    const auto after =
        std::find_if(line->begin(), line->end(), [x](const Point2& p) { return p.x() >= x; });
    if (after == line->begin()) return line->front().y();
    if (after == line->end()) return line->back().y();
    const Point2& a = *(after - 1);
    const double share = (x - a.x()) / (after->x() - a.x());
    return a.y() + share * (after->y() - a.y());
  }

  const Polyline* left_ = nullptr;
  const Polyline* right_ = nullptr;
};

RowEstimate timed_update(RowDetector& detector, const std::vector<LidarPoint>& points,
                         const Pose2& moved, double time, RowDrive& result) {
  const std::clock_t begin = std::clock();
  const RowEstimate lane = detector.update(points, moved, time);
  result.scan_ms.push_back(1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  return lane;
}

void score(const RowEstimate& lane, const Pose2& pose, const CentreLine& centre,
           const RowLayout& layout, RowDrive& result) {
  const double left = layout.length_m - pose.x;
  if (pose.x < 0.0 || left < 0.0) {
    ++result.headland_scans;
    result.false_lanes += lane.valid ? 1 : 0;
    return;
  }
  ++result.lane_scans;
  if (!lane.valid) return;
  result.way_m.push_back(pose.x);
  result.errors_m.push_back(lane.offset_m - centre.offset(pose));
  result.headings_rad.push_back(wrap_angle(lane.heading_rad + pose.yaw - centre.heading(pose.x)));
  if (!lane.row_end.seen) return;
  if (result.end_first_m == 0.0) result.end_first_m = left;
  if (left <= kEndCounts) result.end_errors_m.push_back(lane.row_end.distance_m - left);
}

}  // namespace

std::vector<RowDrive> wander_through(const LidarScene& scene, const RowLayout& layout,
                                     const LidarConfig& lidar, const SensorMount& mount,
                                     const RowDriveConfig& drive,
                                     const std::vector<RowDetectorConfig>& detectors,
                                     std::uint64_t seed) {
  Rig rig(scene, lidar, mount, seed);
  Odometry odometry(drive, seed);
  const CentreLine centre(scene);
  std::vector<RowDetector> eyes(detectors.begin(), detectors.end());
  std::vector<RowDrive> results(detectors.size());
  // A sine with both largest offset and largest angle as given.
  const double steepest = std::tan(deg_to_rad(drive.wander_deg));
  const double wave = drive.wander_m > 0.0 ? steepest / drive.wander_m : 0.0;
  const double phase = 2.0 * kPi * RandomStream(seed, "row_wander").uniform();
  double last = layout.length_m + drive.leave_m;
  if (layout.next_block_m > 0.0) {
    last = std::min(last, layout.length_m + layout.next_block_m - kBlockApart);
  }
  double time = 0.0;
  for (double x = -drive.approach_m; x <= last; x += drive.step_m) {
    const double slope =
        std::tan(centre.heading(x)) + drive.wander_m * wave * std::cos(wave * x + phase);
    const Pose2 pose{x, centre.y(x) + drive.wander_m * std::sin(wave * x + phase),
                     std::atan(slope)};
    const auto& points = rig.scan(pose, time);
    const Pose2 moved = odometry.moved_to(pose);
    for (std::size_t i = 0; i < eyes.size(); ++i) {
      const RowEstimate lane = timed_update(eyes[i], points, moved, time, results[i]);
      score(lane, pose, centre, layout, results[i]);
    }
    time += drive.step_m / drive.speed_mps;
  }
  return results;
}

RowDrive follow_lane(const LidarScene& scene, const RowLayout& layout, const LidarConfig& lidar,
                     const SensorMount& mount, const RowDriveConfig& drive,
                     const RowDetectorConfig& detector, std::uint64_t seed) {
  Rig rig(scene, lidar, mount, seed);
  Odometry odometry(drive, seed);
  const CentreLine centre(scene);
  RowDetector eyes(detector);
  RowDrive result;
  Pose2 pose{0.0, centre.y(0.0) + drive.wander_m, centre.heading(0.0)};
  double time = 0.0;
  while (pose.x <= layout.length_m) {
    const double offset = centre.offset(pose);
    if (std::abs(offset) > 0.5 * layout.spacing_m || std::cos(pose.yaw) < 0.5) break;
    result.differences_m.push_back(2.0 * offset);
    const RowEstimate lane =
        timed_update(eyes, rig.scan(pose, time), odometry.moved_to(pose), time, result);
    score(lane, pose, centre, layout, result);
    double curvature = 0.0;
    if (lane.valid) {
      const double aside = lane.offset_m + drive.lookahead_m * std::sin(lane.heading_rad);
      const double distance = std::hypot(aside, drive.lookahead_m);
      curvature = 2.0 * aside / (distance * distance);
    }
    pose = advance(pose, curvature, drive.step_m);
    time += drive.step_m / drive.speed_mps;
    result.driven_ratio = std::min(1.0, pose.x / layout.length_m);
  }
  return result;
}

}  // namespace headland
