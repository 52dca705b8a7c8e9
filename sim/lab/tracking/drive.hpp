// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "control/estimation/estimator.hpp"
#include "core/world/ground.hpp"
#include "sim/lab/metrics.hpp"
#include "sim/lab/tracking/course.hpp"
#include "sim/simulated_vehicle.hpp"

namespace headland {

/// One drive of the tracking study, in figures of the truth.
struct TrackingDrive {
  bool completed = false;
  double duration_s = 0.0;
  TrackingMetrics tracking;
  double fishtail_rms_m = 0.0;
  double cusp_max_m = 0.0;  ///< largest error within half a metre of a cusp
  double recovery_s = 0.0;  ///< after mid-turn, until the error stays within 5 cm
  double loss_rmse_ratio = 0.0;
  double side_rmse_deg = 0.0;
  double offset_rmse_deg = 0.0;
  double position_rmse_m = 0.0;
  double speed_rmse_mps = 0.0;      ///< over ground
  int wrong_gear_count = 0;         ///< ticks
  std::vector<double> solve_ms;     ///< processor time of every tracker step
  std::vector<double> estimate_ms;  ///< and of every estimator update
  std::vector<PathError> errors;    ///< of every tick behind `settle_m`
};

/// Drives a course in lock-step, ticks of `cycle` [s]. Without an estimator the tracker is told the
/// true pose, speed and steering, and no slip. Figures begin `settle_m` [m] behind the start.
TrackingDrive drive_course(const Vehicle& vehicle, const TrackingCourse& course, Tracker& tracker,
                           Estimator* estimator, const SimulatedVehicleConfig& world,
                           const Ground& ground, std::uint64_t seed, double cycle, double settle_m);

}  // namespace headland
