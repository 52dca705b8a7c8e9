// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

#include <Eigen/Core>

#include "core/config/visit.hpp"

namespace headland {

/// What became of a scan; all but kValid are reasons to abstain.
enum class RowStatus : std::int8_t {
  kValid,
  kNoPoints,       ///< too few finite points
  kNoGround,       ///< no plane below the vehicle
  kNoLane,         ///< no two lines of the right width with support
  kNotALane,       ///< lines, but what lies between them, or their gaps, deny a lane
  kNotAtRobot,     ///< a lane, but ahead of the robot or behind it
  kWidthOff,       ///< the lines' distance is not the rows'
  kJump,           ///< too far from what was known
  kUnconfirmed,    ///< seen too few times since it was lost
  kBehindRowEnd,   ///< the robot has left the row
  kLost,           ///< known once, but too long or too far ago
  kTimeBackwards,  ///< the scan is older than the last one, or has no time
};

/// Which of the two rows beside the robot the scan showed.
enum class RowSides : std::int8_t { kNone, kLeft, kRight, kBoth };

/// Where both rows end ahead of the robot.
struct RowEnd {
  bool seen = false;
  double distance_m = 0.0;   ///< along the row from base [m]; negative: passed
  double deviation_m = 0.0;  ///< standard deviation [m]
};

/// The lane between two rows, in `base` (x forward, y left): lines of the same heading on either
/// side, and the centre line half way. Distances are perpendicular to the lines, left positive.
struct RowEstimate {
  bool valid = false;  ///< the numbers below mean something
  RowStatus status = RowStatus::kLost;
  double offset_m = 0.0;     ///< of the centre line from the robot [m]
  double heading_rad = 0.0;  ///< of the row in base [rad]
  double left_m = 0.0;       ///< of the left row from the robot [m]
  double right_m = 0.0;      ///< of the right row from the robot [m]; negative in the lane
  double width_m = 0.0;      ///< between both rows [m]
  /// Of (offset [m], heading [rad], width [m]).
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  RowSides sides = RowSides::kNone;
  RowEnd row_end;
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::RowStatus> {
  using enum RowStatus;
  static constexpr std::pair<RowStatus, std::string_view> values[] = {
      {kValid, "valid"},
      {kNoPoints, "no points"},
      {kNoGround, "no ground"},
      {kNoLane, "no lane"},
      {kNotALane, "not a lane"},
      {kNotAtRobot, "not at the robot"},
      {kWidthOff, "width off"},
      {kJump, "jump"},
      {kUnconfirmed, "unconfirmed"},
      {kBehindRowEnd, "behind the row's end"},
      {kLost, "lost"},
      {kTimeBackwards, "time backwards"}};
};
