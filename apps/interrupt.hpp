// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace headland::apps {

/// While it lives, Ctrl-C does not end the program but a search, with the best found so far. One at
/// a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Whether Ctrl-C was pressed since the guard was made.
  static bool interrupted();

 private:
  void (*before_)(int);
};

}  // namespace headland::apps
