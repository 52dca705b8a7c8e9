// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace headland {

/// Numbered by layer, the same in messages, files and on the wire; docs/errors.md gives cause and
/// remedy of each.
enum class ErrorCode : int {
  // 1xx: the input (core, config). Exit code 2.
  kFileNotFound = 101,
  kSyntax = 102,
  kUnknownKey = 103,
  kMissingKey = 104,
  kWrongType = 105,
  kOutOfRange = 106,
  kBadGeometry = 107,
  kUnknownName = 108,
  kFileNotWritable = 109,
  kUnsupported = 110,
  kOffTerrain = 111,
  // 2xx: no feasible answer (global planner). Exit code 3.
  kTurnDoesNotFit = 201,
  kNoPath = 202,
  kEnergyInfeasible = 203,
  kNoRows = 204,
  kTooSteep = 205,
  kTaskDoesNotFit = 206,
  kStopped = 207,
  // 4xx: control.
  kPathLost = 401,
  kPathTooTight = 402,
  // 9xx: a broken invariant. Exit code 4.
  kInternal = 901,
};

/// Where in the input an error lies; empty parts are unknown.
struct Location {
  std::string file;
  int line = 0;     ///< 1-based; 0: unknown
  std::string key;  ///< dotted path of keys, such as vehicles.0.battery.capacity_wh
};

/// An expected failure: what went wrong, where, and what to do about it.
struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string what;    ///< what is wrong, with the offending value
  std::string remedy;  ///< what is allowed, or what to do; may be empty
  Location where{};
};

/// One line: `file:line: key: what; remedy [E106]`.
std::string to_string(const Error& error);

/// Exit code of the command for an error: 2 wrong input, 3 no feasible answer, 4 internal.
int exit_code(ErrorCode code);

/// Logs `what` with its place and terminates; called by HEADLAND_CHECK.
[[noreturn]] void fail_check(std::string_view condition, std::string_view what, const char* file,
                             int line);

}  // namespace headland

/// Terminates when an invariant of our own code is broken; never for the user's input.
#define HEADLAND_CHECK(condition, what) \
  ((condition) ? static_cast<void>(0)   \
               : ::headland::fail_check(#condition, what, __FILE__, __LINE__))
