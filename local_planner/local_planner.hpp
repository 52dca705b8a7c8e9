// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/clock.hpp"
#include "core/config/visit.hpp"
#include "core/geometry/path.hpp"
#include "core/model/kinematics.hpp"
#include "core/world/agent.hpp"
#include "core/world/clearance_map.hpp"

namespace headland {

/// What the local layer sees at one tick.
struct LocalScene {
  double time_s = 0.0;                ///< of the tick
  VehicleEstimate robot;              ///< the robot itself
  std::span<const Agent> agents;      ///< whoever is near, with velocities
  const ClearanceMap* map = nullptr;  ///< static obstacles; null: none
  double age_s = 0.0;                 ///< how old agents and map are at `time_s`
};

/// Where the robot is going: the global path and the next place on it.
struct LocalGoal {
  const Path* path = nullptr;  ///< the global path; null: none, straight to `place`
  double s = 0.0;              ///< progress along it [m]
  Point2 place{0.0, 0.0};      ///< the next waypoint
  double place_s = 0.0;        ///< where on the path it lies [m]
  double accuracy_m = 1.0;     ///< it is reached within this distance
  double speed_mps = 1.0;      ///< wanted on the way, > 0
};

/// How much a decision may cost. With neither, the least that is legal: the fallback.
struct PlanBudget {
  int iterations = 0;   ///< repeatable; 0: none
  Deadline deadline{};  ///< live
};

enum class LocalStatus {
  kPlanned,   ///< a manoeuvre towards the goal
  kBraking,   ///< nothing better than to brake along the present curve was found
  kBlocked,   ///< standing, as every way on is blocked
  kBadInput,  ///< a state, place or speed is no number: brake
  kStale      ///< the scene is too old: brake
};

/// The next seconds, as states at equal time steps: what the wheels do (VehicleState::speed,
/// steering, yaw_rate reached at the end of each step) and where that leads without slip.
struct LocalPlan {
  LocalStatus status = LocalStatus::kBraking;
  double begin_s = 0.0;              ///< time of states[0]
  double step_s = 0.1;               ///< > 0
  std::vector<VehicleState> states;  ///< at least two; states[0] is the robot when planned
  int expansions = 0;                ///< nodes, samples or cells that were looked at
  double cost = 0.0;                 ///< of the planner's own; comparable within a planner only

  double end_s() const { return begin_s + step_s * static_cast<double>(states.size() - 1); }
  /// The planned state at a time, clamped to the plan; speeds and steering are linear between the
  /// steps.
  VehicleState at(double time_s) const;
};

/// Plans the next seconds among moving agents. Deterministic under a budget of iterations. Always
/// answers with a plan that the vehicle can drive, whatever the input; never throws.
class LocalPlanner {
 public:
  /// A scene older than this is not planned by [s].
  static constexpr double kOldestScene = 0.5;

  virtual ~LocalPlanner() = default;
  /// Sees the scene; planners keep track of agents from call to call. To be called with each new
  /// sight of the agents, whether a plan is wanted or not.
  void observe(const LocalScene& scene) { do_observe(scene); }
  /// The next seconds from `scene` on; `plan` is overwritten (its buffers are reused). What is no
  /// number (agents included), no wanted speed and a scene that is too old are braked for here.
  void plan(const LocalScene& scene, const LocalGoal& goal, const PlanBudget& budget,
            LocalPlan& plan);

 protected:
  explicit LocalPlanner(const Vehicle& vehicle) : vehicle_(vehicle) {}
  const Vehicle& vehicle() const { return vehicle_; }

  virtual void do_observe(const LocalScene&) {}
  virtual void do_plan(const LocalScene& scene, const LocalGoal& goal, const PlanBudget& budget,
                       LocalPlan& plan) = 0;

 private:
  Vehicle vehicle_;
};

/// Braking to a stand from `state`, along the curve that it is on: the fallback of all planners.
/// `plan` gets `status`; its states reach one second beyond the stand.
void brake(const Vehicle& vehicle, const VehicleState& state, double time_s, LocalStatus status,
           LocalPlan& plan);

bool is_finite(const Agent& agent);
/// Whether all that a planner goes by are numbers.
bool is_finite(const LocalScene& scene, const LocalGoal& goal);

}  // namespace headland
