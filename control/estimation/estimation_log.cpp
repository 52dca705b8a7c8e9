// SPDX-License-Identifier: Apache-2.0
#include "control/estimation/estimation_log.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace headland {
namespace {

constexpr double kSameTime = 1e-9;                // [s]
constexpr std::size_t kMostMeasurements = 16384;  // kept

bool is_usable(const Measurement& m) {
  return std::isfinite(m.time) && std::isfinite(m.value[0]) && std::isfinite(m.value[1]) &&
         std::isfinite(m.deviation) && m.deviation > 0.0;
}

bool is_usable(const Command& c) {
  return std::isfinite(c.speed) && std::isfinite(c.steering) && std::isfinite(c.yaw_rate);
}

}  // namespace

EstimationLog::EstimationLog(const Vehicle& vehicle, double cycle, double span)
    : cycle_(cycle),
      delay_(vehicle, cycle),
      acting_(static_cast<std::size_t>(std::ceil(span / cycle)) + 4) {
  measurements_.reserve(kMostMeasurements);
}

void EstimationLog::reset(double now) {
  delay_.reset();
  std::fill(acting_.begin(), acting_.end(), Command{});
  measurements_.clear();
  first_ = 0;
  start_ = now;
  now_ = base_ = 0;
  last_position_ = now;
  late_ = refused_ = 0;
}

const Command& EstimationLog::acting(long cycle) const {
  return acting_[static_cast<std::size_t>(cycle % static_cast<long>(acting_.size()))];
}

void EstimationLog::take(std::span<const Measurement> measured, const Command& last, double now) {
  now = std::isfinite(now) ? std::max(now, time(now_)) : time(now_);
  const long cycles = std::max(now_, std::lround((now - start_) / cycle_));
  const Command given = is_usable(last) ? last : Command{};
  for (; now_ < cycles; ++now_) {
    acting_[static_cast<std::size_t>(now_ % static_cast<long>(acting_.size()))] =
        delay_.push(given);
  }
  for (const Measurement& measurement : measured) {
    if (!is_usable(measurement) || measurement.time > now + kSameTime) {
      ++refused_;
    } else if (measurement.time < time(base_) - kSameTime) {
      ++late_;
    } else {
      sort_in(measurement);
    }
  }
}

void EstimationLog::sort_in(const Measurement& measurement) {
  if (measurement.kind == MeasurementKind::kPosition) {
    last_position_ = std::max(last_position_, measurement.time);
  }
  if (measurements_.size() == kMostMeasurements) {
    measurements_.erase(measurements_.begin(),
                        measurements_.begin() + static_cast<std::ptrdiff_t>(first_ + 1));
    late_ += first_ == 0 ? 1 : 0;
    first_ = 0;
  }
  const auto later = std::upper_bound(measurements_.begin() + static_cast<std::ptrdiff_t>(first_),
                                      measurements_.end(), measurement,
                                      [](const Measurement& a, const Measurement& b) {
                                        return std::tie(a.time, a.kind) < std::tie(b.time, b.kind);
                                      });
  measurements_.insert(later, measurement);
}

void EstimationLog::forget_before(long base) {
  base_ = std::max(base_, base);
  while (first_ < measurements_.size() && measurements_[first_].time <= time(base_) + kSameTime) {
    ++first_;
  }
}

void EstimationLog::replay(KalmanFilter& filter, long to, const Eigen::Vector3d& inflation) const {
  auto next = measurements().begin();
  const auto end = measurements().end();
  for (long cycle = base_; cycle < to; ++cycle) {
    double at = time(cycle);
    const double until = time(cycle + 1);
    for (; next != end && next->time <= until + kSameTime; ++next) {
      const double ahead = next->time - at;
      if (ahead > kSameTime) {
        filter.predict(acting(cycle), ahead, inflation);
        at = next->time;
      }
      filter.update(*next);
    }
    if (until - at > kSameTime) filter.predict(acting(cycle), until - at, inflation);
  }
}

}  // namespace headland
