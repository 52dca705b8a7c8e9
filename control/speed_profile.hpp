// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "control/tracker.hpp"

namespace headland {

/// The fastest speed along a reference that keeps to its legs' speeds and can always brake in time
/// for the next slower leg and for a standstill at each cusp and at the end. Built once per
/// reference; asking it does not allocate. The speeds allowed at each place are met forwards at the
/// acceleration and backwards at the deceleration, as in the time-optimal motion along a given path
/// (Bobrow, Dubowsky, Gibson 1985), here with bounds that change from stretch to stretch only.
class SpeedProfile {
 public:
  /// A place on the path and the speed there.
  struct State {
    double s = 0.0;      ///< driven distance [m]
    double speed = 0.0;  ///< [m/s, >= 0]
  };

  /// `acceleration` [m/s^2] > 0; the profile brakes with the share `brake_ratio` of it, in (0, 1].
  /// `zones` in the order of their begins; they may overlap.
  void build(const Reference& reference, double acceleration, std::span<const SpeedZone> zones = {},
             double brake_ratio = 1.0);

  /// Speed [m/s, >= 0] to command for the next `dt` [s] at driven distance `s` [m] on the segment
  /// numbered `segment`; zero at the segment's end. O(log pieces).
  double limit(double s, int segment, double dt) const;

  /// The profile's own motion: where it is `dt` [s] after it was at `s` [m] with `speed` [m/s] on
  /// the segment numbered `segment`, and how fast. It speeds up at the acceleration, is never above
  /// limit(s, segment, 0) (a `speed` above counts as that limit), and stops on the segment's end
  /// and stays there. Exact for any dt: many small steps lead to where one large step does. A
  /// standing start inside a segment drives off. O(log pieces + pieces passed).
  State advance(double s, double speed, int segment, double dt) const;

  /// How long the whole reference takes [s], each segment from a standstill to a standstill,
  /// standing times not counted; infinite where a leg has no speed.
  double duration() const { return duration_; }

 private:
  struct Knot {
    double s = 0.0;      // [m]
    double speed = 0.0;  // [m/s] allowed when passing s, braking for what follows included
    double after = 0.0;  // [m/s] the leg's own speed from here on
    int segment = 0;
  };
  void add_piece(double begin_s, double end_s, double speed, int segment,
                 std::span<const SpeedZone> zones);
  void brake_in_time();
  void time_segments();
  std::size_t knot_at(double s, int segment) const;
  // A motion at one constant acceleration.
  struct Phase {
    double distance = 0.0;  // [m]
    double speed = 0.0;     // at its end [m/s]
  };
  Phase next_phase(const State& state, double cap, const Knot& next) const;
  double drive(State& state, int segment, double dt) const;

  double acceleration_ = 1.0;  // [m/s^2]
  double deceleration_ = 1.0;  // [m/s^2]
  double duration_ = 0.0;      // [s]
  std::vector<Knot> knots_;
};

}  // namespace headland
