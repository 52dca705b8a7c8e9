// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/trackers.hpp"

#include "control/estimation/ekf_estimator.hpp"
#include "control/kinematics_adapter.hpp"
#include "control/slip_compensation.hpp"

namespace headland {
namespace {

// For a vehicle of the kinematics that the tracker is made for; a dead time that is not set is the
// vehicle's.
std::unique_ptr<Tracker> make_own(const Vehicle& vehicle, TrackerKind kind,
                                  const ControlConfig& control) {
  if (kind == TrackerKind::kPurePursuit) {
    PurePursuitConfig config = control.pure_pursuit;
    if (config.dead_time_s == 0.0) config.dead_time_s = vehicle.steering_dead_time_s;
    return std::make_unique<PurePursuit>(vehicle, config, control.limits);
  }
  return std::make_unique<RoverTracker>(vehicle, control.rover, control.limits);
}

}  // namespace

std::unique_ptr<Tracker> make_tracker(const Vehicle& vehicle, ControlConfig control,
                                      const SensorConfig& sensors, double cycle,
                                      const Clock* clock) {
  if (control.tracker == TrackerKind::kRhmc) {
    return std::make_unique<HorizonTracker>(vehicle, control.rhmc, cycle, clock, control.limits);
  }
  const bool tells_slip =
      control.estimator == EstimatorKind::kEkf || control.estimator == EstimatorKind::kRhe;
  const bool estimated = tells_slip || control.estimator == EstimatorKind::kLocalizer;
  for (PositionFilterConfig* filter : {&control.pure_pursuit.filter, &control.rover.filter}) {
    if (estimated) {
      filter->fix_accuracy_m = 0.0;
    } else if (filter->fix_accuracy_m == 0.0) {
      filter->fix_accuracy_m = sensors.position_accuracy_m;
    }
  }
  const bool ackermann = vehicle.steering == Steering::kAckermann;
  const TrackerKind natural = ackermann ? TrackerKind::kPurePursuit : TrackerKind::kRover;
  std::unique_ptr<Tracker> tracker;
  if (control.tracker == TrackerKind::kAuto || control.tracker == natural) {
    tracker = make_own(vehicle, natural, control);
  } else {
    if (ackermann) control.rover.pivot_from_deg = 180.0;
    const Vehicle twin = KinematicsAdapter::twin(vehicle);
    tracker =
        std::make_unique<KinematicsAdapter>(vehicle, make_own(twin, control.tracker, control));
  }
  if (!tells_slip) return tracker;
  return std::make_unique<SlipCompensation>(vehicle, std::move(tracker));
}

std::unique_ptr<Estimator> make_estimator(const Vehicle& vehicle, const ControlConfig& control,
                                          double cycle) {
  switch (control.estimator) {
    case EstimatorKind::kAuto:
    case EstimatorKind::kSensors:
    case EstimatorKind::kLocalizer:
      break;
    case EstimatorKind::kEkf:
      return std::make_unique<EkfEstimator>(vehicle, control.estimation, cycle);
    case EstimatorKind::kRhe:
      return std::make_unique<HorizonEstimator>(vehicle, control.estimation, control.rhe, cycle);
  }
  return nullptr;
}

}  // namespace headland
