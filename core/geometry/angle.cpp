// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/angle.hpp"

#include <cmath>

namespace headland {

double wrap_angle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

double wrap_positive(double angle, double snap) {
  double wrapped = std::fmod(angle, 2.0 * kPi);
  if (wrapped < 0.0) wrapped += 2.0 * kPi;
  return wrapped >= 2.0 * kPi - snap ? 0.0 : wrapped;
}

}  // namespace headland
