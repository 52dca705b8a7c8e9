// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace headland {

/// How a motion at `speed` [m/s] ends when it is told to: on at this speed for the reaction time,
/// then braking at the limit, then the tail of the drive's first-order lag (as step_speed has it).
/// Times from the telling [s]. Turning on the spot ends alike, in radians.
class Stopping {
 public:
  /// Slower than this counts as standing [m/s].
  static constexpr double kStill = 0.03;

  /// `reaction` [s]: until the brakes act; `acceleration` > 0 [m/s2]; `lag`, `speed` >= 0.
  Stopping(double reaction, double acceleration, double lag, double speed);

  double duration() const { return even_ + tail_; }    ///< until it stands: Tr + Ts [s]
  double distance() const { return way(duration()); }  ///< until then [m]
  /// Way until `time` [m], 0 <= time; constant from the stand on.
  double way(double time) const;
  /// Speed at `time` [m/s].
  double speed(double time) const;

 private:
  double reaction_;
  double speed_;
  double acceleration_;
  double lag_;
  double knee_;  // the speed from which on the lag, not the limit, brakes [m/s]
  double even_;  // when it is down to that [s]
  double tail_;  // from there to the stand [s]
};

/// Speed and separation monitoring (ISO/TS 15066:2016, 5.5.4.2): the distance that must lie between
/// the robot at `speed` and someone straight ahead,
///   Sp = vh (Tr + Ts) + vr Tr + Ss + C + Zd + Zr,
/// with Tr + Ts and vr Tr + Ss from `stopping`.
/// @param agent_speed vh: at which someone comes towards the robot [m/s].
/// @param allowances  C + Zd + Zr [m].
inline double protective_distance(const Stopping& stopping, double agent_speed, double allowances) {
  return agent_speed * stopping.duration() + stopping.distance() + allowances;
}

}  // namespace headland
