// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace headland {
namespace {

constexpr double kSameTime = 1e-9;  // [s]; ticks are not exact multiples

double weighted(double deviation) { return std::max(deviation, Sensors::kLeastDeviation); }

}  // namespace

Sensors::Channel::Channel(const ReadingConfig& config, std::uint64_t seed, std::string_view name)
    : config_(config),
      noise_(seed, name),
      dropout_(seed, std::string(name) + "/dropout"),
      outage_(seed, std::string(name) + "/outage") {}

double Sensors::Channel::good_time() {
  if (config_.outage_rate_hz <= 0.0 || config_.outage_s <= 0.0) {
    return std::numeric_limits<double>::infinity();
  }
  return -std::log(1.0 - outage_.uniform()) / config_.outage_rate_hz;
}

bool Sensors::Channel::due(double now) {
  if (!config_.enabled) return false;
  if (!started_) {
    started_ = true;
    first_ = now;
    outage_begin_ = now + good_time();
  }
  if (config_.rate_hz <= 0.0) return true;
  const double passed = (now - first_ + kSameTime) * config_.rate_hz;
  if (passed < periods_) return false;
  periods_ = std::floor(passed) + 1.0;
  return true;
}

bool Sensors::Channel::lost(double now) {
  while (now >= outage_begin_ + config_.outage_s) {
    outage_begin_ += config_.outage_s + good_time();
  }
  const bool dropped = dropout_.uniform() < config_.dropout_probability;
  return dropped || now >= outage_begin_;
}

void Sensors::Channel::deliver(double now, std::vector<Measurement>& arrived) {
  const auto end =
      std::find_if(under_way_.begin(), under_way_.end(), [&](const Measurement& reading) {
        return reading.time + config_.latency_s > now + kSameTime;
      });
  arrived.insert(arrived.end(), under_way_.begin(), end);
  under_way_.erase(under_way_.begin(), end);
}

Sensors::WorseFix::WorseFix(const WorseFixConfig& config, std::uint64_t seed, std::string_view name)
    : config_(config), random_(seed, name) {}

void Sensors::WorseFix::plan(double from) {
  begin_ = from - std::log(1.0 - random_.uniform()) / config_.rate_hz;
  error_.x() = config_.error_m * random_.normal();
  error_.y() = config_.error_m * random_.normal();
}

std::optional<Point2> Sensors::WorseFix::error(double now) {
  if (config_.rate_hz <= 0.0 || config_.duration_s <= 0.0) return std::nullopt;
  if (!started_) {
    started_ = true;
    plan(now);
  }
  while (now >= begin_ + config_.duration_s) plan(begin_ + config_.duration_s);
  return now >= begin_ ? std::optional<Point2>(error_) : std::nullopt;
}

Sensors::Sensors(const Vehicle& vehicle, const SensorConfig& config, std::uint64_t seed)
    : ackermann_(vehicle.steering == Steering::kAckermann),
      track_width_m_(vehicle.track_width_m),
      config_(config),
      fix_noise_(seed, "sim/sensors"),
      gnss_(config.gnss, seed, "sim/sensors/gnss"),
      float_fix_(config.gnss.float_fix, seed, "sim/sensors/gnss/float"),
      single_fix_(config.gnss.single_fix, seed, "sim/sensors/gnss/single"),
      multipath_(seed, "sim/sensors/gnss/multipath"),
      heading_(config.heading, seed, "sim/sensors/heading"),
      wheel_(config.wheel, seed, "sim/sensors/wheel"),
      steering_(config.steering, seed, "sim/sensors/steering"),
      imu_(config.imu, seed, "sim/sensors/imu") {}

std::span<const Measurement> Sensors::sense(const VehicleState& truth, double yaw_rate,
                                            double now) {
  if (gnss_.due(now)) read_position(truth, now);
  if (heading_.due(now)) read_heading(truth, now);
  if (wheel_.due(now)) read_wheels(truth, now);
  if (ackermann_ && steering_.due(now)) read_steering(truth, now);
  if (imu_.due(now)) read_yaw_rate(yaw_rate, now);
  arrived_.clear();
  for (Channel* channel : {&gnss_, &heading_, &wheel_, &steering_, &imu_}) {
    channel->deliver(now, arrived_);
  }
  return arrived_;
}

// All noise of a reading is drawn before it may be lost, so that losses leave the others' as it is.

void Sensors::read_position(const VehicleState& truth, double now) {
  const double accuracy = config_.position_accuracy_m;
  const auto error = [&] {
    const double within = gnss_.noise().uniform(-accuracy, accuracy);
    return within + config_.gnss.noise_m * gnss_.noise().normal();
  };
  double x = truth.pose.x + error();
  double y = truth.pose.y + error();
  double deviation = std::hypot(accuracy / std::sqrt(3.0), config_.gnss.noise_m);
  for (WorseFix* fix : {&float_fix_, &single_fix_}) {
    const std::optional<Point2> worse = fix->error(now);
    if (!worse) continue;
    x += worse->x();
    y += worse->y();
    deviation = std::hypot(deviation, fix->deviation());
  }
  const bool astray = multipath_.uniform() < config_.gnss.multipath_probability;
  const double far =
      multipath_.uniform(config_.gnss.multipath_low_m, config_.gnss.multipath_high_m);
  const double bearing = multipath_.uniform(-kPi, kPi);
  if (astray) {
    x += far * std::cos(bearing);
    y += far * std::sin(bearing);
  }
  if (gnss_.lost(now)) return;
  gnss_.send({now, MeasurementKind::kPosition, {x, y}, weighted(deviation)});
}

void Sensors::read_heading(const VehicleState& truth, double now) {
  const double deviation =
      deg_to_rad(std::hypot(config_.heading_noise_deg, config_.heading.noise_deg));
  const double yaw = wrap_angle(truth.pose.yaw + deviation * heading_.noise().normal());
  if (heading_.lost(now)) return;
  heading_.send({now, MeasurementKind::kHeading, {yaw, 0.0}, weighted(deviation)});
}

void Sensors::read_wheels(const VehicleState& truth, double now) {
  const double scale = 1.0 + config_.wheel.scale_error_ratio;
  const double deviation = config_.wheel.noise_mps;
  // With equal noise on either side, the noises of mean and difference are independent.
  const double turn_deviation = 2.0 * deviation / track_width_m_;
  const double speed = scale * truth.speed + deviation * wheel_.noise().normal();
  const double turn = scale * truth.yaw_rate + turn_deviation * wheel_.noise().normal();
  if (wheel_.lost(now)) return;
  wheel_.send({now, MeasurementKind::kSpeed, {speed, 0.0}, weighted(deviation)});
  if (ackermann_) return;
  wheel_.send({now, MeasurementKind::kTurn, {turn, 0.0}, weighted(turn_deviation)});
}

void Sensors::read_steering(const VehicleState& truth, double now) {
  const double deviation = deg_to_rad(config_.steering.noise_deg);
  const double angle = truth.steering + deviation * steering_.noise().normal();
  if (steering_.lost(now)) return;
  steering_.send({now, MeasurementKind::kTurn, {angle, 0.0}, weighted(deviation)});
}

void Sensors::read_yaw_rate(double yaw_rate, double now) {
  const double deviation = config_.imu.noise_radps;
  const double value = yaw_rate + config_.imu.bias_radps + deviation * imu_.noise().normal();
  if (imu_.lost(now)) return;
  imu_.send({now, MeasurementKind::kYawRate, {value, 0.0}, weighted(deviation)});
}

VehicleState Sensors::fix(const VehicleState& truth) {
  VehicleState measured = truth;
  const double accuracy = config_.position_accuracy_m;
  if (accuracy > 0.0) {
    measured.pose.x += fix_noise_.uniform(-accuracy, accuracy);
    measured.pose.y += fix_noise_.uniform(-accuracy, accuracy);
  }
  if (config_.heading_noise_deg > 0.0) {
    measured.pose.yaw =
        wrap_angle(measured.pose.yaw + deg_to_rad(config_.heading_noise_deg) * fix_noise_.normal());
  }
  return measured;
}

}  // namespace headland
