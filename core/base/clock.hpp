// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace headland {

/// A clock to be passed in: layers read none of their own.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual double now() const = 0;  ///< [s] since some fixed moment; never decreases
};

/// The processor's steady clock.
class SteadyClock : public Clock {
 public:
  double now() const override;
};

/// The processor time of the calling thread: what runs beside it does not count.
class ThreadClock : public Clock {
 public:
  double now() const override;
};

/// A moment on a clock. Without a clock it never comes: the work is bounded by iterations alone and
/// can be repeated to the bit.
struct Deadline {
  const Clock* clock = nullptr;
  double at = 0.0;  ///< [s] on the clock

  static Deadline in(const Clock* clock, double seconds) {
    return {clock, clock == nullptr ? 0.0 : clock->now() + seconds};
  }
  bool passed() const { return clock != nullptr && clock->now() >= at; }
};

}  // namespace headland
