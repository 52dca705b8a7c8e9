// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/polito/drive.hpp"

#include <algorithm>

#include "core/base/random.hpp"

namespace headland {
namespace {

// (004) Fig. 21: the measured position is the true one plus a random error in +-accuracy, drawn
// anew each cycle. Both followers draw the same errors from the same seed.
class Receiver {
 public:
  explicit Receiver(const RoverDrive& drive)
      : accuracy_(drive.fix_accuracy_m),
        heading_error_(drive.heading_error_rad),
        errors_(drive.seed, "polito/fix") {}

  Pose2 fix(const Pose2& pose) {
    const double dx = accuracy_ * errors_.uniform(-1.0, 1.0);
    const double dy = accuracy_ * errors_.uniform(-1.0, 1.0);
    return {pose.x + dx, pose.y + dy, pose.yaw + heading_error_};
  }

 private:
  double accuracy_;       // [m]
  double heading_error_;  // [rad]
  RandomStream errors_;
};

void move(const RoverDrive& drive, const Vehicle& vehicle, const Command& command,
          VehicleState& state) {
  if (drive.plant == RoverPlant::kArc) {
    state = step_vehicle(vehicle, state, command, drive.cycle_s);
    return;
  }
  state.pose = turn_then_move(state.pose, command.speed, command.yaw_rate, drive.cycle_s);
  state.speed = command.speed;
}

int most_cycles(const RoverDrive& drive, double length, double speed) {
  return static_cast<int>(3.0 * length / (speed * drive.cycle_s)) + 1000;
}

}  // namespace

DrivenTrack drive_seed(const RoverDrive& drive, const SeedLookaheadConfig& config,
                       const std::vector<Point2>& waypoints, double yaw, const Vehicle& vehicle) {
  double length = 0.0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    length += (waypoints[i] - waypoints[i - 1]).norm();
  }
  const int most = most_cycles(drive, length, config.speed_mps);
  SeedLookaheadRover rover(config, waypoints);
  Receiver receiver(drive);
  VehicleState state;
  state.pose = {waypoints.front().x(), waypoints.front().y(), yaw};
  DrivenTrack track;
  for (int cycle = 0; cycle < most; ++cycle) {
    const SeedLookaheadStep step = rover.step(receiver.fix(state.pose), drive.cycle_s);
    track.completed = step.done;
    if (step.done) break;
    move(drive, vehicle, {step.speed, 0.0, step.yaw_rate}, state);
    track.positions.push_back(state.pose.position());
  }
  return track;
}

DrivenTrack drive_ours(const RoverDrive& drive, const RoverTrackerConfig& config,
                       const Reference& reference, const Vehicle& vehicle) {
  const double slowest = *std::min_element(reference.leg_speed.begin(), reference.leg_speed.end());
  const int most = most_cycles(drive, reference.path.length(), slowest);
  RoverTrackerConfig own = config;
  // The turn-then-move rover tells the speed and heading that it had all through the last cycle.
  if (drive.plant == RoverPlant::kTurnThenMove) own.motion_age_s = 0.5 * drive.cycle_s;
  RoverTracker tracker(vehicle, own);
  tracker.start(reference);
  Receiver receiver(drive);
  VehicleState state;
  state.pose = reference.path.start_pose();
  DrivenTrack track;
  for (int cycle = 0; cycle < most; ++cycle) {
    VehicleState measured = state;
    measured.pose = receiver.fix(state.pose);
    measured.speed *= drive.odometry_scale_ratio;
    const TrackOutput out = tracker.step(measured, drive.cycle_s);
    track.completed = out.status == TrackStatus::kDone;
    if (out.status == TrackStatus::kDone || failed(out.status)) break;
    move(drive, vehicle, out.command, state);
    track.positions.push_back(state.pose.position());
  }
  return track;
}

}  // namespace headland
