// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "control/estimation/estimator.hpp"
#include "core/base/random.hpp"
#include "core/geometry/angle.hpp"
#include "core/model/command_delay.hpp"

namespace headland::testing {

inline constexpr double kEstimationCycle = 0.02;  // [s]

/// Deviations of the sensors; all measure every cycle, but for position and heading.
struct SensorSet {
  double position = 0.01;    ///< [m]
  double heading = 0.005;    ///< [rad]
  double speed = 0.01;       ///< [m/s]
  double turn = 0.004;       ///< [rad, rad/s]
  double yaw_rate = 0.005;   ///< [rad/s]
  int position_every = 5;    ///< cycles
  double noise_ratio = 1.0;  ///< of the deviations; 0: exact
};

/// A slipping vehicle with sensors, cycle by cycle.
class SensedVehicle {
 public:
  SensedVehicle(const Vehicle& vehicle, std::uint64_t seed, const SensorSet& sensors = {})
      : vehicle_(vehicle),
        sensors_(sensors),
        delay_(vehicle, kEstimationCycle),
        random_(seed, "sensors") {}

  VehicleState state;
  double time() const { return kEstimationCycle * cycle_; }  // [s]

  /// Drives a cycle; what is measured at its end.
  std::vector<Measurement> step(const Command& command, const Slip& slip) {
    const bool ackermann = vehicle_.steering == Steering::kAckermann;
    const Pose2 before = state.pose;
    state = step_vehicle(vehicle_, state, delay_.push(command), kEstimationCycle, slip);
    ++cycle_;
    std::vector<Measurement> all;
    if (cycle_ % sensors_.position_every == 0) {
      all.push_back(
          noisy(MeasurementKind::kPosition, state.pose.x, state.pose.y, sensors_.position));
      all.push_back(noisy(MeasurementKind::kHeading, state.pose.yaw, 0.0, sensors_.heading));
      all.back().value[0] = wrap_angle(all.back().value[0]);
    }
    all.push_back(noisy(MeasurementKind::kSpeed, state.speed, 0.0, sensors_.speed));
    all.push_back(noisy(MeasurementKind::kTurn, ackermann ? state.steering : state.yaw_rate, 0.0,
                        sensors_.turn));
    const double turned = wrap_angle(state.pose.yaw - before.yaw);
    all.push_back(
        noisy(MeasurementKind::kYawRate, turned / kEstimationCycle, 0.0, sensors_.yaw_rate));
    return all;
  }

 private:
  Measurement noisy(MeasurementKind kind, double first, double second, double deviation) {
    const double a = sensors_.noise_ratio * deviation * random_.normal();
    const double b = sensors_.noise_ratio * deviation * random_.normal();
    return {time(), kind, {first + a, second + b}, deviation};
  }

  Vehicle vehicle_;
  SensorSet sensors_;
  CommandDelay delay_;
  RandomStream random_;
  int cycle_ = 0;
};

/// A vehicle that follows its commands with lags and, of the steering, a dead time.
inline Vehicle lagging_vehicle(Steering steering) {
  Vehicle vehicle;
  vehicle.steering = steering;
  vehicle.wheelbase_m = 1.5;
  vehicle.steering_lag_s = 0.1;
  vehicle.speed_lag_s = 0.2;
  vehicle.steering_dead_time_s = 0.06;
  if (steering == Steering::kDifferential) vehicle.yaw_acceleration_radps2 = 5.0;
  return vehicle;
}

/// Weaves left and right at `speed` [m/s, signed].
inline Command weave(double speed, double time) {
  const double wave = std::sin(0.7 * time);
  return {speed, 0.3 * wave, 0.25 * wave};
}

/// What of a drive is told to an estimator, cycle by cycle; the default is all of it, at once.
using Delivery = std::function<std::vector<Measurement>(const std::vector<Measurement>&, double)>;

struct Estimated {
  Estimate estimate;
  VehicleState truth;
};

/// A weaving drive, seen by an estimator. `look` is called every cycle.
struct SensedDrive {
  Vehicle vehicle = lagging_vehicle(Steering::kAckermann);
  double speed = 1.2;  ///< [m/s, signed]
  double seconds = 20.0;
  std::uint64_t seed = 1;
  SensorSet sensors = {};
  VehicleState start = {};
  std::function<Slip(double time)> slip = [](double) { return Slip{}; };
  std::function<Command(double time)> command = {};  ///< instead of the weave
  Delivery deliver = [](const std::vector<Measurement>& measured, double) { return measured; };

  Estimated run(Estimator& estimator,
                const std::function<void(const Estimated&, double)>& look = {}) const {
    SensedVehicle truth(vehicle, seed, sensors);
    truth.state = start;
    estimator.reset(start, 0.0);
    Estimated result;
    while (truth.time() < seconds - 1e-9) {
      const double time = truth.time();
      const Command given = command ? command(time) : weave(speed, time);
      const std::vector<Measurement> all = truth.step(given, slip(time));
      const std::vector<Measurement> measured = deliver(all, truth.time());
      result = {estimator.update(measured, given, truth.time()), truth.state};
      if (look) look(result, truth.time());
    }
    return result;
  }
};

/// Holds measurements of positions and headings back for `delay` [s], until `flush_at` [s].
inline Delivery delayed(double delay, double flush_at) {
  return [delay, flush_at, held = std::vector<Measurement>()](
             const std::vector<Measurement>& measured, double now) mutable {
    std::vector<Measurement> out;
    held.insert(held.end(), measured.begin(), measured.end());
    std::vector<Measurement> kept;
    for (const Measurement& m : held) {
      const bool waits =
          m.kind == MeasurementKind::kPosition || m.kind == MeasurementKind::kHeading;
      const bool arrives = !waits || m.time + delay <= now + 1e-9 || now >= flush_at - 1e-9;
      (arrives ? out : kept).push_back(m);
    }
    held = std::move(kept);
    return out;
  };
}

/// Delivers every `cycles` cycles only, the newest first or in order.
inline Delivery bursts(int cycles, bool reversed) {
  return [cycles, reversed, held = std::vector<Measurement>(), count = 0](
             const std::vector<Measurement>& measured, double) mutable {
    held.insert(held.end(), measured.begin(), measured.end());
    if (++count % cycles != 0) return std::vector<Measurement>();
    std::vector<Measurement> out = std::exchange(held, {});
    // Of one time, the order stays: they are independent, but for rounding.
    if (reversed) {
      std::stable_sort(out.begin(), out.end(),
                       [](const Measurement& a, const Measurement& b) { return a.time > b.time; });
    }
    return out;
  };
}

}  // namespace headland::testing
