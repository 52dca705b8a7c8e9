// SPDX-License-Identifier: Apache-2.0
#include "core/model/steering_rate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace headland {
namespace {

constexpr double kSameCurvature = 1e-6;   // [1/m]
constexpr double kImmediateYaw = 1000.0;  // [rad/s2] of Vehicle::yaw_acceleration_radps2

std::optional<SlowStretch> slower(double speed, double wanted, const SteeringPace& pace) {
  const double slow = std::max(speed, pace.least_speed_ratio * wanted);
  if (!(slow < wanted)) return std::nullopt;
  return SlowStretch{0.0, slow};
}

// Adds up the time that stretches cost.
class SlowTime {
 public:
  SlowTime(double wanted, double acceleration) : wanted_(wanted), acceleration_(acceleration) {}

  void add(double begin_s, const SlowStretch& stretch) {
    const double reach = speeding_up(std::min(stretch.speed, open_ ? speed_ : wanted_));
    if (open_ && begin_s - end_s_ < 2.0 * reach) {
      speed_ = std::min(speed_, stretch.speed);
      end_s_ = std::max(end_s_, begin_s + stretch.length);
      return;
    }
    close();
    open_ = true;
    begin_s_ = begin_s;
    end_s_ = begin_s + stretch.length;
    speed_ = stretch.speed;
  }

  // Braking to v and speeding up again costs (wanted - v)^2 / (wanted acceleration).
  double close() {
    if (open_) {
      const double less = wanted_ - speed_;
      time_ += (end_s_ - begin_s_) * (1.0 / speed_ - 1.0 / wanted_) +
               less * less / (wanted_ * acceleration_);
    }
    open_ = false;
    return time_;
  }

 private:
  double speeding_up(double from) const {
    return 0.5 * (wanted_ * wanted_ - from * from) / acceleration_;
  }

  double wanted_;
  double acceleration_;
  double time_ = 0.0;
  bool open_ = false;
  double begin_s_ = 0.0;
  double end_s_ = 0.0;
  double speed_ = 0.0;
};

}  // namespace

double steering_per_metre(double wheelbase, double from, double to, double length) {
  const double least = from * to < 0.0 ? 0.0 : std::min(std::abs(from), std::abs(to));
  const double bend = wheelbase * least;
  return wheelbase * (std::abs(to - from) / length) / (1.0 + bend * bend);
}

bool yaws_immediately(const Vehicle& vehicle) {
  return vehicle.steering != Steering::kAckermann &&
         vehicle.yaw_acceleration_radps2 >= kImmediateYaw;
}

double sharpness_limit(const Vehicle& vehicle, double speed, const SteeringPace& pace) {
  if (yaws_immediately(vehicle)) return std::numeric_limits<double>::infinity();
  return vehicle.steering == Steering::kAckermann
             ? pace.rate_use_ratio * vehicle.steering_rate_radps / (vehicle.wheelbase_m * speed)
             : pace.rate_use_ratio * vehicle.yaw_acceleration_radps2 / (speed * speed);
}

std::optional<SlowStretch> slow_at_step(const Vehicle& vehicle, double from, double to,
                                        double wanted, const SteeringPace& pace) {
  const double change = std::abs(to - from);
  if (!(change > kSameCurvature && wanted > 0.0) || yaws_immediately(vehicle)) return std::nullopt;
  const double within = std::sqrt(24.0 * pace.step_error_m / change);  // the length l
  if (vehicle.steering == Steering::kAckermann) {
    const double turn =
        std::abs(std::atan(vehicle.wheelbase_m * to) - std::atan(vehicle.wheelbase_m * from));
    const double seconds = turn / (pace.rate_use_ratio * vehicle.steering_rate_radps);
    auto slow = slower(within / seconds, wanted, pace);
    if (slow) slow->length = slow->speed * seconds;
    return slow;
  }
  const double per_speed = change / (pace.rate_use_ratio * vehicle.yaw_acceleration_radps2);
  auto slow = slower(std::sqrt(within / per_speed), wanted, pace);
  if (slow) slow->length = slow->speed * slow->speed * per_speed;
  return slow;
}

std::optional<SlowStretch> slow_on_ramp(const Vehicle& vehicle, double from, double to,
                                        double length, double wanted, const SteeringPace& pace) {
  if (from == to || !(wanted > 0.0) || yaws_immediately(vehicle)) return std::nullopt;
  const double speed = vehicle.steering == Steering::kAckermann
                           ? pace.rate_use_ratio * vehicle.steering_rate_radps /
                                 steering_per_metre(vehicle.wheelbase_m, from, to, length)
                           : std::sqrt(pace.rate_use_ratio * vehicle.yaw_acceleration_radps2 *
                                       length / std::abs(to - from));
  auto slow = slower(speed, wanted, pace);
  if (slow) slow->length = length;
  return slow;
}

double slow_down_time(const Vehicle& vehicle, const Curve& curve, double wanted,
                      const SteeringPace& pace) {
  if (yaws_immediately(vehicle)) return 0.0;
  SlowTime time(wanted, vehicle.acceleration_mps2);
  double s = 0.0;
  double before = 0.0;
  bool forward = true;
  const auto step_to = [&](double curvature, bool gear) {
    const auto slow = gear == forward ? slow_at_step(vehicle, before, curvature, wanted, pace)
                                      : std::optional<SlowStretch>{};
    if (slow) time.add(s - 0.5 * slow->length, *slow);
  };
  for (const CurvePiece& piece : curve) {
    step_to(piece.curvature, piece.length > 0.0);
    const double length = std::abs(piece.length);
    const double end = piece.end_curvature();
    const auto slow = slow_on_ramp(vehicle, piece.curvature, end, length, wanted, pace);
    if (slow) time.add(s, *slow);
    s += length;
    before = end;
    forward = piece.length > 0.0;
  }
  step_to(0.0, true);
  return time.close();
}

}  // namespace headland
