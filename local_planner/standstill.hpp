// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace headland {

/// How long a vehicle has been standing, from plan to plan; a planner that stands for too long tries
/// another way.
class Standstill {
 public:
  /// To be told at each plan; a pause of more than a second begins anew.
  void update(double time_s, double speed) {
    const bool moves = std::abs(speed) > kStill;
    if (moves || !(time_s >= last_) || time_s - last_ > 1.0) since_ = time_s;
    last_ = time_s;
  }
  void restart() { since_ = last_; }
  double duration() const { return last_ - since_; }  ///< [s]

 private:
  static constexpr double kStill = 0.05;  // [m/s]
  double since_ = 0.0;
  double last_ = -1e9;
};

}  // namespace headland
