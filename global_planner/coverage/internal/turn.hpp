// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/path.hpp"
#include "core/geometry/smooth_turn.hpp"
#include "core/model/drive_cost.hpp"
#include "global_planner/coverage/internal/free_space.hpp"
#include "global_planner/coverage/transitions.hpp"

namespace headland::coverage {

/// Cost of a way as a sum over its length and its changes of gear: DriveCost::value is that.
struct CostRate {
  double per_metre = 1.0;
  double per_cusp = 0.0;
  double per_second = 0.0;  ///< of time lost to slowing down
  double of(double length, int cusps, double lost_s = 0.0) const {
    return per_metre * length + per_cusp * cusps + per_second * lost_s;
  }
};
CostRate cost_rate(const Vehicle& vehicle, LegKind kind, const CostWeights& objective);

/// An end of a manoeuvre: a pose that looks outwards. The manoeuvre leaves one end along its pose
/// and enters the other against it.
struct TurnEnd {
  Pose2 out;
  int row = -1;           ///< whose body it may touch
  double free_run = 0.0;  ///< how far it may run straight out [m]
};

/// One manoeuvre: straight out, a steering curve, straight in.
struct Turn {
  double lead_out = 0.0;  ///< [m]
  double lead_in = 0.0;   ///< [m]
  Curve curve;
  double lost_s = 0.0;       ///< time lost where the steering makes the vehicle slow down
  double smoothing_m = 0.0;  ///< by which its clothoids make it longer

  double length() const { return lead_out + curve.length() + lead_in; }
  /// Changes of gear: those inside, and those on leaving and entering, which is done forwards.
  int cusps() const;
};

/// The curve less pieces that are mere rounding.
Curve without_slivers(const Curve& curve);

/// The same track, driven from its end to its start.
Curve mirrored(const Curve& curve);
Turn mirrored(const Turn& turn);
Path mirrored(const Path& path);

/// The turn as a path from `out`.
Path turn_path(const Pose2& out, const Turn& turn);

/// The manoeuvres that a search may use.
struct TurnKinds {
  bool dubins = true;
  bool fishtail = false;
  bool reeds_shepp = false;  ///< and three-point turns, which are among them
};

/// Curves of one sharpness.
struct TurnPace {
  SmoothTurn turn;
  double least_lost_s = 0.0;   ///< time that any such curve loses at least
  double turned_lost_s = 0.0;  ///< and one by a quarter turn or more
  double cusped_lost_s = 0.0;  ///< and one with cusps
  bool slows_down = true;
};

/// How a vehicle steers in turns.
struct TurnSteering {
  TurnPace plain;                ///< the curvature steps
  std::vector<TurnPace> smooth;  ///< with clothoids, the fastest first; none where none are needed
  std::optional<Vehicle> vehicle;
  double speed = 0.0;  ///< of the leg [m/s]
};

/// Finds manoeuvres that fit.
///
/// Candidates are all kinds of curve after straight leads. The leads begin equal, or such that both
/// ends come level (skewed row ends must first run out past their neighbours), or a little longer
/// at one end (a long nose must be straight before it enters a row), and grow in steps of
/// kLeadStep.
///
/// Where the steering asks for it, curves have clothoids that it follows at the speed of the leg,
/// or at a lower one: then the time that is lost counts. Curves whose curvature steps inside a gear
/// are only taken where none of these fits. Candidates are taken in the order of their cost, so
/// that the first that fits is the cheapest; a curve is only computed once its lower bound,
/// max(distance, radius * |change of heading|) between the leads, comes up.
class TurnSearch {
 public:
  static constexpr double kLeadStep = 0.5;  ///< [m]

  /// Of a vehicle whose steering turns immediately.
  TurnSearch(const FreeSpace& space, double radius)
      : space_(space), steering_{{SmoothTurn({1.0 / radius}), 0.0, 0.0, 0.0, true}, {}, {}, 0.0} {}
  /// @param speed Of the leg [m/s].
  TurnSearch(const FreeSpace& space, const Vehicle& vehicle, double speed);

  /// The cheapest turn that leaves `from` and enters `to`; none if none of them fits.
  std::optional<Turn> find(const TurnEnd& from, const TurnEnd& to, TurnKinds kinds,
                           CostRate rate) const;

 private:
  const FreeSpace& space_;
  TurnSteering steering_;
};

}  // namespace headland::coverage
