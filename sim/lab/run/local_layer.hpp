// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "core/base/clock.hpp"
#include "core/base/random.hpp"
#include "core/config/visit.hpp"
#include "local_planner/arbiter/arbiter.hpp"
#include "local_planner/fail_safe/fail_safe.hpp"
#include "sim/lab/local_planners.hpp"

namespace headland {

/// How a vehicle sees the agents around it.
struct SightConfig {
  double view_m = 20.0;
  double noise_ratio = 0.0125;
  double period_s = 0.1;
  double lost_from_s = 0.0;
  double lost_until_s = 0.0;

  template <class V>
  void visit(V& v) {
    v("view_m", view_m, config::kPositive, "Agents are seen up to here [m]");
    v("noise_ratio", noise_ratio, config::Range{0.0, 0.5},
      "Standard deviation of a seen position, per axis, over its distance");
    v("period_s", period_s, config::Range{0.01, 2.0}, "Between two sights [s]");
    v("lost_from_s", lost_from_s, config::kNonNegative, "A failure: nothing is seen from this ...");
    v("lost_until_s", lost_until_s, config::kNonNegative, "... to this time of the run [s]");
  }
};

/// The local layer of a vehicle in a simulated mission.
struct LocalLayerConfig {
  /// Defaults of a mission: nobody is counted on to give way, and agents' velocities are seen.
  LocalLayerConfig() {
    planners.predictor = PredictorKind::kConstantVelocity;
    planners.mcts.clearance_m = 1.0;
    fail_safe.agents = AgentMotion::kObserved;
    arbiter.take_m = 1.5;
    arbiter.give_m = 2.0;
  }

  LocalPlannerKind planner = LocalPlannerKind::kMcts;
  LocalPlannersConfig planners;
  ArbiterConfig arbiter;
  FailSafeConfig fail_safe;
  SightConfig sight;
  double plan_period_s = 0.4;
  int iterations_count = 1000;
  double near_m = 0.5;

  template <class V>
  void visit(V& v) {
    v("planner", planner, "Who drives around agents");
    v("planners", planners, "The local planners");
    v("arbiter", arbiter, "When the path is left, and taken up again");
    v("fail_safe", fail_safe, "Beneath whoever drives");
    v("sight", sight, "How agents are seen");
    v("plan_period_s", plan_period_s, config::Range{0.02, 2.0}, "Between two local plans [s]");
    v("iterations_count", iterations_count, config::Range{0, 100000000},
      "Budget of a local plan, for planners that search");
    v("near_m", near_m, config::kNonNegative,
      "Nearer to an agent than this, outline to disc, is a near-collision [m]");
  }
};

constexpr double kNobodyNear = 1e3;  ///< EncounterMetrics::least_gap_m

/// What a vehicle and the agents did to each other.
struct EncounterMetrics {
  int takeovers = 0;         ///< times that the local planner took over
  double local_s = 0.0;      ///< driven by it
  double held_s = 0.0;       ///< slowed down by the fail-safe
  int protective_stops = 0;  ///< by the fail-safe, to a stand
  int near_collisions = 0;   ///< meetings with an agent nearer than near_m, ...
  int robot_near = 0;        ///< ... in which the vehicle closed in the faster
  int collisions = 0;        ///< meetings in which outline and disc overlapped, ...
  int robot_collisions = 0;  ///< ... when the outline moved towards the agent by over 0.05 m/s
  double least_gap_m = kNobodyNear;  ///< outline to disc
};

/// What the local layer makes of a tick.
struct LocalOutput {
  Driving driving = Driving::kPath;
  bool gave_back = false;  ///< just now: the path is to be taken up again
  Command command;         ///< to the vehicle; while the path is followed, the tracker's is to be
                           ///< passed through `guard` instead
};

/// Sight, arbiter, local planner and fail-safe of one simulated vehicle, tick by tick.
/// Deterministic for a seed.
class LocalLayer {
 public:
  /// `map` must outlive it. `predictor`: see predictor_factory. `cycle` [s]: between two ticks.
  LocalLayer(const Vehicle& vehicle, const LocalLayerConfig& config,
             const PredictorFactory& predictor, const ClearanceMap& map, std::uint64_t seed,
             double cycle);

  /// Looks at the agents there are, and says who drives now.
  LocalOutput step(double time, const VehicleEstimate& known, const LocalGoal& goal,
                   const ArbiterView& view, std::span<const Agent> agents);
  /// The command that the fail-safe lets through.
  Command guard(const Command& wanted);
  /// Counts what comes of the tick. `truth` and `agents` at its end.
  void count(const VehicleState& truth, std::span<const Agent> agents);

  const EncounterMetrics& metrics() const { return metrics_; }

 private:
  struct Meeting {
    bool near = false;
    bool contact = false;
  };

  void look(double time, const VehicleEstimate& known, std::span<const Agent> agents);
  void plan(double time, const LocalGoal& goal);

  Vehicle vehicle_;
  LocalLayerConfig config_;
  const ClearanceMap& map_;
  double cycle_;
  std::unique_ptr<LocalPlanner> planner_;
  Arbiter arbiter_;
  FailSafe fail_safe_;
  RandomStream noise_;

  std::vector<Agent> seen_;
  LocalScene scene_;
  double seen_at_ = -1e9;     // [s]
  double planned_at_ = -1e9;  // [s]
  LocalPlan plan_;
  bool stopped_ = false;  // by the fail-safe
  std::map<int, Meeting> meetings_;
  EncounterMetrics metrics_;
};

}  // namespace headland
