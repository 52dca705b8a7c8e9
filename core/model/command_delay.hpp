// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/model/kinematics.hpp"

namespace headland {

/// The dead times between commands and actuators, in a fixed cycle: what was commanded acts a whole
/// number of cycles later, speed and steering each after its own dead time. Pushing does not
/// allocate.
class CommandDelay {
 public:
  /// `cycle` [s] > 0. Dead times are rounded to whole cycles.
  CommandDelay(const Vehicle& vehicle, double cycle);

  /// Forgets all; before the first commands arrive, `standing` acts.
  void reset(const Command& standing = {});
  /// A new command; returns what acts in the coming cycle.
  Command push(const Command& command);
  /// What will act in the cycle after `ahead` more have passed, if the last command is held; 0 is
  /// what the last push returned.
  Command acting(int ahead) const;
  /// Cycles until the last command acts in full.
  int longest() const { return static_cast<int>(commands_.size()) - 1; }

 private:
  const Command& past(int cycles) const;  // commanded that many cycles ago

  int speed_cycles_;
  int steering_cycles_;
  std::vector<Command> commands_;  // a ring
  int newest_ = 0;
};

}  // namespace headland
