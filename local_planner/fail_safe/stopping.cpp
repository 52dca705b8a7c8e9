// SPDX-License-Identifier: Apache-2.0
#include "local_planner/fail_safe/stopping.hpp"

#include <algorithm>
#include <cmath>

namespace headland {

Stopping::Stopping(double reaction, double acceleration, double lag, double speed)
    : reaction_(reaction),
      speed_(speed),
      acceleration_(acceleration),
      lag_(lag),
      knee_(std::min(speed, acceleration_ * lag_)),
      even_(reaction + (speed - knee_) / acceleration_),
      tail_(lag_ > 0.0 ? lag_ * std::log(std::max(1.0, knee_ / kStill)) : 0.0) {}

double Stopping::way(double time) const {
  const double t = std::min(time, duration());
  if (t <= reaction_) return speed_ * t;
  const double braking = std::min(t, even_) - reaction_;
  const double way = speed_ * reaction_ + (speed_ - 0.5 * acceleration_ * braking) * braking;
  return t <= even_ || lag_ <= 0.0 ? way
                                   : way + knee_ * lag_ * (1.0 - std::exp((even_ - t) / lag_));
}

double Stopping::speed(double time) const {
  if (time >= duration()) return 0.0;
  if (time <= reaction_) return speed_;
  return time <= even_ ? speed_ - acceleration_ * (time - reaction_)
                       : knee_ * std::exp((even_ - time) / lag_);
}

}  // namespace headland
