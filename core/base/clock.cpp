// SPDX-License-Identifier: Apache-2.0
#include "core/base/clock.hpp"

#include <chrono>

namespace headland {

double SteadyClock::now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace headland
