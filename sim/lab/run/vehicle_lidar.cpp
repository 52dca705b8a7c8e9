// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/run/vehicle_lidar.hpp"

#include <algorithm>

namespace headland {
namespace {

constexpr double kSameTick = 1e-6;  // [s]

}  // namespace

VehicleLidar::VehicleLidar(const SensorMount& mount, const LidarConfig& config, double period,
                           const LidarScene& scene, std::uint64_t seed)
    : period_(period), scene_(scene), lidar_(config, mount, seed) {}

const LidarScan* VehicleLidar::step(double time, const Pose2& truth, std::span<const Agent> agents,
                                    bool wanted) {
  const LidarScan* ended = nullptr;
  if (scanning_ && time >= began_s_ + duration() - kSameTick) {
    scanning_ = false;
    scene_.set_agents(agents);
    const auto motion = linear_motion(scene_.pose_on_ground(began_at_),
                                      scene_.pose_on_ground(truth), time - began_s_);
    lidar_.scan(scene_, motion, began_s_, scan_);
    ended = &scan_;
  }
  if (!scanning_ && wanted && time >= due_s_ - kSameTick) {
    scanning_ = true;
    began_at_ = truth;
    began_s_ = time;
    due_s_ = std::max(due_s_ + period_, time + period_);
  }
  return ended;
}

}  // namespace headland
