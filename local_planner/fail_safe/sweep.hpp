// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/model/kinematics.hpp"
#include "local_planner/fail_safe/stopping.hpp"

namespace headland {

/// How the vehicle turns on its way: what a command asks of the steering.
struct Turn {
  bool on_the_spot = false;  ///< differential: `rate` is all there is
  double steering = 0.0;     ///< Ackermann: the wheels turn towards this [rad]
  double curvature = 0.0;    ///< differential, driving [1/m]
  double rate = 0.0;         ///< differential, on the spot [rad/s]; its sign alone matters here
};

/// The outline at one moment of stopping, and those parts of its edges that move outwards.
struct Station {
  /// A stretch of an edge; `u` counts outwards from the edge, `w` along it.
  struct Edge {
    bool across = true;    // the normal is along x: front or back
    double outward = 1.0;  // sign of the normal
    double offset = 0.0;   // of the edge along its normal [m]
    double low = 0.0;      // [m]
    double high = 0.0;
  };

  double time = 0.0;  ///< from now [s]
  Pose2 pose;         ///< T_map_base
  double cosine = 1.0;
  double sine = 0.0;
  int edges = 0;
  std::array<Edge, 4> edge{};

  /// How far [m] someone whose disc has `radius` must go from `p_map` until it touches the outline
  /// where that moves outwards; 0: it does already.
  double way_to_touch(const Point2& p_map, double radius) const;
  /// Whether a point lies within the outline.
  bool holds(const Point2& p_map, const Footprint& outline) const;
};

/// The vehicle's motion from now until it stands, if it is told to stop now: through the reaction
/// time at `speed` (on the spot: [rad/s]), then braking, turning as `turn` says all along.
class Sweep {
 public:
  static constexpr int kStations = 17;

  /// `direction`: 1 forwards, -1 backwards; `stopping` from `speed` [m/s or rad/s, >= 0].
  Sweep(const Vehicle& vehicle, const VehicleState& state, const Turn& turn, double direction,
        double speed, const Stopping& stopping);

  const std::array<Station, kStations>& stations() const { return stations_; }

 private:
  std::array<Station, kStations> stations_;
};

}  // namespace headland
