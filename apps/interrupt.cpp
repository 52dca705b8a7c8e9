// SPDX-License-Identifier: Apache-2.0
#include "apps/interrupt.hpp"

#include <csignal>

namespace headland::apps {
namespace {

// What a signal may set.
volatile std::sig_atomic_t pressed = 0;
void press(int) { pressed = 1; }

}  // namespace

InterruptGuard::InterruptGuard() : before_(std::signal(SIGINT, press)) { pressed = 0; }
InterruptGuard::~InterruptGuard() { std::signal(SIGINT, before_); }
bool InterruptGuard::interrupted() { return pressed != 0; }

}  // namespace headland::apps
