// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/tracking/drive.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/clock.hpp"

namespace headland {
namespace {

constexpr double kWindow = 1.0;      // around the progress, of the nearest point [m]
constexpr double kOnCusp = 1e-6;     // nearer than this, the vehicle is on it [m]
constexpr double kNearCusp = 0.5;    // [m]
constexpr double kRecovered = 0.05;  // [m]
constexpr double kStill = 1e-3;      // [m/s]
constexpr double kPatience = 10.0;   // times the planned duration, and a minute
constexpr double kLost = 3.0;        // [m]

// A root mean square in the making.
struct MeanSquare {
  double sum = 0.0;
  int count = 0;
  void add(double value) {
    sum += value * value;
    ++count;
  }
  double root() const { return count > 0 ? std::sqrt(sum / count) : 0.0; }
};

class CourseDriver {
 public:
  CourseDriver(const TrackingCourse& course, const SimulatedVehicle& vehicle)
      : course_(course), path_(course.reference.path), vehicle_(vehicle) {}

  // What is known before a tick at progress s.
  void compare(const VehicleEstimate& known) {
    const VehicleState& truth = vehicle_.truth();
    const Slip& slip = vehicle_.slip();
    loss_.add(known.slip.loss_ratio - slip.loss_ratio);
    side_.add(rad_to_deg(known.slip.side_rad - slip.side_rad));
    offset_.add(rad_to_deg(known.slip.steering_offset_rad - slip.steering_offset_rad));
    position_.add((known.state.pose.position() - truth.pose.position()).norm());
    speed_.add(known.state.speed * (1.0 - known.slip.loss_ratio) -
               truth.speed * (1.0 - slip.loss_ratio));
  }

  // After a tick: the true place against the path, never across a cusp. False: far off.
  bool measure(double s, double time, double settle_m) {
    const VehicleState& truth = vehicle_.truth();
    const double on = std::max(0.0, s - kOnCusp);
    const PathSegment& segment = path_.segments()[static_cast<std::size_t>(path_.at(on).segment)];
    const Projection near =
        path_.project(truth.pose.position(), std::max(segment.begin_s, s - kWindow),
                      std::min(segment.end_s, s + kWindow));
    const int leg = path_.at(std::min(near.s, segment.end_s - 1e-9)).leg;
    if (truth.speed * sign(segment.gear) < -kStill) ++drive_.wrong_gear_count;
    const double error = std::abs(near.lateral_error);
    if (s > course_.mid_turn_s) {
      if (mid_turn_ < 0.0) mid_turn_ = time;
      if (leg <= 2 && error > kRecovered) drive_.recovery_s = time - mid_turn_;
    }
    if (s < settle_m) return true;
    drive_.errors.push_back({near.s, near.lateral_error, error, leg});
    if (leg == course_.fishtail_leg) fishtail_.add(error);
    for (const double cusp : course_.cusps_s) {
      if (std::abs(near.s - cusp) < kNearCusp)
        drive_.cusp_max_m = std::max(drive_.cusp_max_m, error);
    }
    return near.distance < kLost;
  }

  TrackingDrive finish() {
    drive_.tracking = tracking_metrics(drive_.errors, course_.kinds);
    drive_.fishtail_rms_m = fishtail_.root();
    drive_.loss_rmse_ratio = loss_.root();
    drive_.side_rmse_deg = side_.root();
    drive_.offset_rmse_deg = offset_.root();
    drive_.position_rmse_m = position_.root();
    drive_.speed_rmse_mps = speed_.root();
    return std::move(drive_);
  }

  TrackingDrive& drive() { return drive_; }

 private:
  const TrackingCourse& course_;
  const Path& path_;
  const SimulatedVehicle& vehicle_;
  TrackingDrive drive_;
  double mid_turn_ = -1.0;  // when it was there [s]
  MeanSquare fishtail_, loss_, side_, offset_, position_, speed_;
};

double patience(const TrackingCourse& course) {
  double planned = 0.0;
  for (const PathPiece& piece : course.reference.path.pieces()) {
    planned += piece.length / course.reference.leg_speed[static_cast<std::size_t>(piece.leg)];
  }
  return 60.0 + kPatience * planned;
}

}  // namespace

TrackingDrive drive_course(const Vehicle& vehicle, const TrackingCourse& course, Tracker& tracker,
                           Estimator* estimator, const SimulatedVehicleConfig& world,
                           const Ground& ground, std::uint64_t seed, double cycle,
                           double settle_m) {
  const Reference& reference = course.reference;
  SimulatedVehicle simulated(vehicle, reference.path.start_pose(), 1.0, world, seed, cycle, ground);
  CourseDriver driver(course, simulated);
  TrackingDrive& drive = driver.drive();
  if (!tracker.start(reference)) return driver.finish();
  if (estimator != nullptr) estimator->reset(simulated.truth(), 0.0);
  const ThreadClock clock;
  Command told;
  double s = 0.0;
  const double most = patience(course);
  for (long tick = 0; static_cast<double>(tick) * cycle < most; ++tick) {
    const double now = static_cast<double>(tick) * cycle;
    VehicleEstimate known(simulated.truth());
    const std::span<const Measurement> sensed = simulated.sense(now);
    const double begin = clock.now();
    if (estimator != nullptr) known = estimator->update(sensed, told, now).vehicle;
    const double middle = clock.now();
    const TrackOutput output = tracker.step(known, cycle);
    drive.solve_ms.push_back(1e3 * (clock.now() - middle));
    drive.estimate_ms.push_back(1e3 * (middle - begin));
    drive.duration_s = now;
    if (failed(output.status)) break;
    if (output.status == TrackStatus::kDone && std::abs(simulated.truth().speed) < kStill) {
      drive.completed = true;
      break;
    }
    if (s >= settle_m) driver.compare(known);
    told = output.command;
    s = output.s;
    simulated.step(told, LegKind::kTransit);
    if (!driver.measure(s, now, settle_m)) break;
  }
  return driver.finish();
}

}  // namespace headland
