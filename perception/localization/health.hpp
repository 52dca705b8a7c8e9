// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace headland {

/// What became of a reading.
enum class ReadingOutcome : std::int8_t {
  kUsed,           ///< at its full weight
  kDoubted,        ///< at a lower weight: less likely than 5 %
  kRejected,       ///< not used: less likely than 1 %
  kReanchored,     ///< used, as one of several that agree with each other and not with the filter
  kRepeated,       ///< not used: the very value of the reading before
  kFrozen,         ///< likewise, and the vehicle has moved since
  kWaiting,        ///< kept until the filter can start
  kTooOld,         ///< not used: older than what can be done again; a clock that went back
  kWrongBaseline,  ///< not used: the antennas seem nearer or farther from each other than they are
  kInvalid         ///< not used: not a number, or no noise
};

/// Whether a pose can be driven on.
enum class PoseState : std::int8_t {
  kStarting,  ///< none yet
  kGood,
  kCoasting,  ///< by odometry alone since a while
  kLost       ///< less certain than allowed
};

enum class PoseReason : std::int8_t {
  kNone,
  kNoFix,          ///< no position has come yet, or none since a while
  kNoHeading,      ///< the heading in the map is not known yet
  kFixesRejected,  ///< positions come and do not fit
  kFixesFrozen,    ///< positions come and do not change
  kReanchored,     ///< just moved to where positions agree that it is
  kNoOdometry,     ///< neither wheels nor scans since a while
  kUncertain       ///< the covariance has grown too large
};

struct PoseHealth {
  PoseState state = PoseState::kStarting;
  PoseReason reason = PoseReason::kNoFix;
};

}  // namespace headland
