// SPDX-License-Identifier: Apache-2.0
#include "core/model/command_delay.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

int cycles_of(double time, double cycle) { return static_cast<int>(std::lround(time / cycle)); }

}  // namespace

CommandDelay::CommandDelay(const Vehicle& vehicle, double cycle)
    : speed_cycles_(cycles_of(vehicle.speed_dead_time_s, cycle)),
      steering_cycles_(cycles_of(vehicle.steering_dead_time_s, cycle)),
      commands_(static_cast<std::size_t>(std::max(speed_cycles_, steering_cycles_) + 1)) {}

void CommandDelay::reset(const Command& standing) {
  std::fill(commands_.begin(), commands_.end(), standing);
}

Command CommandDelay::push(const Command& command) {
  newest_ = (newest_ + 1) % static_cast<int>(commands_.size());
  commands_[static_cast<std::size_t>(newest_)] = command;
  return acting(0);
}

const Command& CommandDelay::past(int cycles) const {
  const int size = static_cast<int>(commands_.size());
  return commands_[static_cast<std::size_t>((newest_ - std::max(0, cycles) + size) % size)];
}

Command CommandDelay::acting(int ahead) const {
  const Command& turning = past(steering_cycles_ - ahead);
  return {past(speed_cycles_ - ahead).speed, turning.steering, turning.yaw_rate};
}

}  // namespace headland
