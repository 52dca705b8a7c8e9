// SPDX-License-Identifier: Apache-2.0
#include "sim/ground_slip.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace headland {
namespace {

double bounded(double value, const config::Range& range) {
  return std::clamp(value, range.min, range.max);
}

double bounded_angle(double angle) {
  return std::clamp(angle, deg_to_rad(kSlipAngleRange.min), deg_to_rad(kSlipAngleRange.max));
}

}  // namespace

std::optional<Error> SlipConfig::check() const {
  for (std::size_t i = 1; i < changes.size(); ++i) {
    if (changes[i].at_m > changes[i - 1].at_m) continue;
    return Error{ErrorCode::kOutOfRange,
                 fmt::format("{} m is not beyond the change before it, at {} m", changes[i].at_m,
                             changes[i - 1].at_m),
                 "list changes in the order of at_m, each once",
                 {{}, 0, fmt::format("changes.{}.at_m", i)}};
  }
  return std::nullopt;
}

GroundSlip::Walk::Walk(double deviation, double memory, std::uint64_t seed, std::string_view name)
    : deviation_(deviation),
      memory_m_(memory),
      random_(seed, name),
      value_(deviation > 0.0 ? deviation * random_.normal() : 0.0) {}

void GroundSlip::Walk::advance(double distance) {
  if (deviation_ <= 0.0 || distance <= 0.0) return;
  // Exact for any distance: what is remembered, and fresh noise that keeps the variance.
  const double kept = std::exp(-distance / memory_m_);
  value_ = kept * value_ + deviation_ * std::sqrt(1.0 - kept * kept) * random_.normal();
}

GroundSlip::GroundSlip(const SlipConfig& config, const EnergyModel& energy, const Ground& ground,
                       std::uint64_t seed)
    : config_(config),
      energy_(energy),
      ground_(ground),
      offsets_{0.0, config.loss_ratio, config.side_deg, config.steering_offset_deg},
      loss_(config.walk.loss_ratio, config.walk.loss_memory_m, seed, "sim/slip/loss"),
      side_(deg_to_rad(config.walk.side_deg), config.walk.side_memory_m, seed, "sim/slip/side"),
      steering_offset_(deg_to_rad(config.walk.steering_offset_deg),
                       config.walk.steering_offset_memory_m, seed, "sim/slip/steering_offset") {}

GroundSlip::Terrain GroundSlip::by_terrain(const WheelStep& wheels) const {
  const double mean = 0.5 * (wheels.speed_before + wheels.speed);
  if (config_.terrain_factor_ratio <= 0.0 || mean == 0.0) return {};
  const double way = mean > 0.0 ? 1.0 : -1.0;
  const Point2 place = wheels.pose.position();
  const Point2 gradient = ground_.sample(place).value_or(TerrainSample{}).gradient;
  const double keep = 1.0 - loss_ratio_;  // of the step before, as the coming one's is sought
  DriveStep driven;
  driven.distance_m = keep * std::abs(mean) * wheels.duration;
  driven.rise_m = way * gradient.dot(wheels.pose.heading()) * driven.distance_m;
  driven.duration_s = wheels.duration;
  driven.curvature_1pm = wheels.yaw_rate / (keep * mean);
  driven.speed_mps = keep * std::abs(wheels.speed);
  driven.speed_before_mps = keep * std::abs(wheels.speed_before);
  driven.soil = soil_resistance(ground_.soil(place));
  driven.working = wheels.working;
  const double slip = config_.terrain_factor_ratio * driven.soil.slip_per_traction;
  const double left = gradient.dot(wheels.pose.left()) + keep * mean * wheels.yaw_rate / kGravity;
  return {slip * traction_ratio(energy_, driven), -way * slip * left};
}

Slip GroundSlip::step(const WheelStep& wheels) {
  while (next_change_ < config_.changes.size() &&
         distance_m_ >= config_.changes[next_change_].at_m) {
    offsets_ = config_.changes[next_change_++];
  }
  const Terrain terrain = by_terrain(wheels);
  Slip slip;
  slip.loss_ratio = bounded(offsets_.loss_ratio + terrain.loss_ratio + loss_.value(), kLossRange);
  slip.side_rad = bounded_angle(deg_to_rad(offsets_.side_deg) + terrain.side_rad + side_.value());
  slip.steering_offset_rad =
      bounded_angle(deg_to_rad(offsets_.steering_offset_deg) + steering_offset_.value());
  loss_ratio_ = slip.loss_ratio;
  excess_loss_ = std::max(0.0, slip.loss_ratio - terrain.loss_ratio);

  const double driven = 0.5 * std::abs(wheels.speed_before + wheels.speed) * wheels.duration *
                        (1.0 - slip.loss_ratio);
  distance_m_ += driven;
  loss_.advance(driven);
  side_.advance(driven);
  steering_offset_.advance(driven);
  return slip;
}

}  // namespace headland
