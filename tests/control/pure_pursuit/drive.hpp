// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "control/pure_pursuit/pure_pursuit.hpp"
#include "core/geometry/dubins.hpp"
#include "core/geometry/fishtail.hpp"

namespace headland::pure_pursuit_test {

/// The vehicle of seed 002, Sec. 4: wheelbase 2.5 m.
inline Vehicle study_vehicle(double max_steering_deg, double steering_rate_radps) {
  Vehicle vehicle;
  vehicle.wheelbase_m = 2.5;
  vehicle.max_steering_deg = max_steering_deg;
  vehicle.steering_rate_radps = steering_rate_radps;
  vehicle.steering_lag_s = 0.0;
  vehicle.acceleration_mps2 = 1.0;
  vehicle.gear_change_s = 1.0;
  return vehicle;
}

enum class Turn { kDubins, kFishtail };

/// Rows of 20 m, 2.5 m apart, up and down in this order (seed 002), at 1 m/s; even legs are rows.
inline Reference rows(const std::vector<int>& order, double radius, Turn turn) {
  constexpr double kLength = 20.0;
  constexpr double kApart = 2.5;
  Reference reference;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool up = i % 2 == 0;
    const Pose2 begin{kApart * order[i], up ? 0.0 : kLength, up ? 0.5 * kPi : -0.5 * kPi};
    const int leg = 2 * static_cast<int>(i);
    if (i > 0) {
      const Pose2 from = reference.path.end_pose();
      const Curve curve = turn == Turn::kDubins ? shortest_dubins(from, begin, radius)
                                                : fishtail(from, begin, radius).value();
      reference.path.append(curve, from, leg - 1);
    }
    reference.path.append_straight(i > 0 ? reference.path.end_pose() : begin, kLength, leg);
  }
  reference.leg_speed.assign(2 * order.size(), 1.0);
  return reference;
}

struct ErrorStats {
  double sum = 0.0;
  int count = 0;
  double most = 0.0;  // [m]
  void add(double distance) {
    sum += distance * distance;
    ++count;
    most = std::max(most, distance);
  }
  double rms() const { return count > 0 ? std::sqrt(sum / count) : 0.0; }
};

struct Drive {
  ErrorStats all;
  ErrorStats rows;
  ErrorStats turns;
  std::vector<VehicleState> states;  // after each tick
  std::vector<TrackOutput> outputs;
  TrackStatus last = TrackStatus::kTracking;
  double s = 0.0;
  double end_distance = 0.0;  // of the last pose from the path's end [m]
  int against_gear = 0;       // ticks that command a speed against the path's gear
  double turn_speed = 0.0;    // mean while driving on turns, gear changes aside [m/s]
};

using Measure = std::function<VehicleState(const VehicleState&)>;

/// Drives the plant along the reference. Errors are true distances from the analytic path: of the
/// plant's pose, near the progress, whatever was measured.
inline Drive drive(const Vehicle& vehicle, const PurePursuitConfig& config,
                   const Reference& reference, VehicleState state, const Measure& measure,
                   double dt = 0.01, const SpeedLimitConfig& limits = {}) {
  const Path& path = reference.path;
  PurePursuit tracker(vehicle, config, limits);
  tracker.start(reference);
  Drive result;
  double turn_distance = 0.0;
  int turn_ticks = 0;
  for (int tick = 0; tick < 300000; ++tick) {
    const TrackOutput out = tracker.step(measure(state), dt);
    const PathSample at = path.at(out.s);
    if (out.command.speed * sign(at.gear) < 0.0) ++result.against_gear;
    state = step_vehicle(vehicle, state, out.command, dt);
    const double distance =
        path.project(state.pose.position(), std::max(0.0, out.s - 1.0), out.s + 1.0).distance;
    result.all.add(distance);
    (at.leg % 2 == 0 ? result.rows : result.turns).add(distance);
    if (at.leg % 2 == 1 && out.status == TrackStatus::kTracking) {
      turn_distance += std::abs(state.speed) * dt;
      ++turn_ticks;
    }
    result.states.push_back(state);
    result.outputs.push_back(out);
    result.last = out.status;
    result.s = out.s;
    if (out.status == TrackStatus::kDone || failed(out.status)) break;
  }
  result.turn_speed = turn_ticks > 0 ? turn_distance / (turn_ticks * dt) : 0.0;
  result.end_distance = (state.pose.position() - path.end_pose().position()).norm();
  return result;
}

inline Drive drive(const Vehicle& vehicle, const PurePursuitConfig& config,
                   const Reference& reference) {
  VehicleState start;
  start.pose = reference.path.start_pose();
  return drive(vehicle, config, reference, start, [](const VehicleState& s) { return s; });
}

}  // namespace headland::pure_pursuit_test
