// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "control/pure_pursuit/seed_pure_pursuit.hpp"
#include "control/tracker.hpp"
#include "sim/lab/ebs221/field.hpp"
#include "sim/lab/metrics.hpp"

namespace headland {

/// A drive, control period by control period.
struct FieldDrive {
  std::vector<Point2> positions;  ///< when each command was computed [m]
  std::vector<double> steering;   ///< the angle driven with until the next one [rad]
  std::vector<Gear> gears;        ///< driven in until the next one
  std::vector<PathError> errors;  ///< to the exact path; empty of the seed's fishtail run
  double duration = 0.0;          ///< [s]
  double distance = 0.0;          ///< driven, in both gears [m]
  int wrong_gear_count = 0;       ///< periods in which the vehicle moved against the path's gear
  int guided_count = 0;           ///< periods under the guided point (the seed's only)
  bool completed = false;
};

/// Seed 002's plant and loop: a bicycle at 1 m/s without any lag, Euler steps of 1 ms, control
/// periods of 10 ms; done within 0.5 m of the last waypoint, but not in the first 10 s.
struct SeedPlant {
  double speed_mps = 1.0;
  double period_s = 0.01;
  int euler_steps = 10;  ///< per period
  double max_time_s = 1000.0;
};

/// Drives seed 002's controller from `start`. `path`: what its drive is measured against, beside
/// seed_errors().
FieldDrive drive_seed_field(const SeedPlant& plant, const SeedPurePursuitConfig& config,
                            const SeedRoute& route, const Path& path, const Pose2& start);

/// The same for its fishtail run, whose path leads nowhere that an exact one could follow.
FieldDrive drive_seed_fishtail(const SeedPlant& plant, const SeedPurePursuitConfig& config,
                               const SeedRoute& route, const std::vector<bool>& fishtails,
                               const Pose2& start);

/// Drives a tracker of ours on the vehicle of core/model, which has a steering rate, from
/// standstill at the path's start to standstill at its end. Periods at a standstill (gear changes)
/// count in the duration, not in the errors.
FieldDrive drive_our_field(Tracker& tracker, const Vehicle& vehicle, const Reference& reference,
                           double period);

/// Errors by seed 002's rule: the distance to the polyline of that link which has the nearest of
/// all waypoints; `leg` is this link.
std::vector<PathError> seed_errors(std::span<const Point2> positions, const SeedRoute& route);

}  // namespace headland
