// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "control/tracker.hpp"
#include "core/model/command_delay.hpp"
#include "core/model/kinematics.hpp"

namespace headland::testing {

inline constexpr double kCycle = 0.02;

/// What became of a drive.
struct HorizonDrive {
  TrackStatus last = TrackStatus::kTracking;
  double rms = 0.0;      ///< of the cross-track error [m]
  double largest = 0.0;  ///< [m]
  double duration = 0.0;
  int against_gear = 0;  ///< ticks
  VehicleState end;
  std::vector<double> errors;  ///< [m], of every tick on the path
  std::vector<double> places;  ///< progress at those ticks [m]
};

/// How a drive goes: the slip at a progress, and what the tracker is told of the truth.
struct HorizonWorld {
  std::function<Slip(double s)> slip = [](double) { return Slip{}; };
  std::function<VehicleEstimate(const VehicleState& truth, const Slip& slip)> estimate =
      [](const VehicleState& truth, const Slip& known) { return VehicleEstimate(truth, known); };
  double ignore_before = 0.0;  ///< of the path, in the figures [m]
};

/// Drives a reference from `state` with the vehicle's dead times, lags and limits.
inline HorizonDrive drive(const Vehicle& vehicle, Tracker& tracker, const Reference& reference,
                          VehicleState state, const HorizonWorld& world = {}) {
  HorizonDrive result;
  if (!tracker.start(reference)) {
    result.last = TrackStatus::kSolverFailed;
    return result;
  }
  CommandDelay delay(vehicle, kCycle);
  double s = 0.0;
  for (int tick = 0; tick < 60000; ++tick) {
    const Slip slip = world.slip(s);
    const TrackOutput out = tracker.step(world.estimate(state, slip), kCycle);
    result.last = out.status;
    result.duration = tick * kCycle;
    if (failed(out.status)) break;
    if (out.status == TrackStatus::kDone && std::abs(state.speed) < 1e-9) break;
    state = step_vehicle(vehicle, state, delay.push(out.command), kCycle, slip);
    s = out.s;
    const PathSample at = reference.path.at(std::max(0.0, s - 1e-6));
    const PathSegment& segment = reference.path.segments()[static_cast<std::size_t>(at.segment)];
    const Projection near =
        reference.path.project(state.pose.position(), std::max(segment.begin_s, s - 1.0),
                               std::min(segment.end_s, s + 1.0));
    if (state.speed * sign(at.gear) < -1e-3) ++result.against_gear;
    if (s < world.ignore_before) continue;
    result.errors.push_back(near.lateral_error);
    result.places.push_back(s);
    result.largest = std::max(result.largest, std::abs(near.lateral_error));
  }
  double sum = 0.0;
  for (const double e : result.errors) sum += e * e;
  result.rms = std::sqrt(sum / std::max(1.0, static_cast<double>(result.errors.size())));
  result.end = state;
  return result;
}

/// Straight, half circle to the left, straight.
inline Reference u_turn(double radius, double speed, double straight = 15.0) {
  Reference reference;
  reference.path.append({{0.0, 0.0, 0.0}, 0.0, straight, Gear::kForward, 0});
  reference.path.append({{straight, 0.0, 0.0}, 1.0 / radius, kPi * radius, Gear::kForward, 0});
  reference.path.append({{straight, 2.0 * radius, kPi}, 0.0, straight, Gear::kForward, 0});
  reference.leg_speed = {speed};
  return reference;
}

/// Straight, fishtail (quarter forwards, straight in reverse, quarter forwards), straight back,
/// `apart` [m] to the left.
inline Reference fishtail_course(double radius, double apart, double speed,
                                 double straight = 10.0) {
  Reference reference;
  Path& path = reference.path;
  path.append({{0.0, 0.0, 0.0}, 0.0, straight, Gear::kForward, 0});
  path.append({path.end_pose(), 1.0 / radius, 0.5 * kPi * radius, Gear::kForward, 0});
  path.append({path.end_pose(), 0.0, 2.0 * radius - apart, Gear::kReverse, 0});
  path.append({path.end_pose(), 1.0 / radius, 0.5 * kPi * radius, Gear::kForward, 0});
  path.append({path.end_pose(), 0.0, straight, Gear::kForward, 0});
  reference.leg_speed = {speed};
  return reference;
}

}  // namespace headland::testing
