// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "core/config/visit.hpp"
#include "core/model/orca.hpp"
#include "local_planner/course.hpp"
#include "local_planner/local_planner.hpp"
#include "local_planner/rollout.hpp"
#include "local_planner/standstill.hpp"

namespace headland {

struct VelocityObstacleConfig {
  double horizon_s = 1.5;    ///< tau: contact is avoided for so long
  double share_ratio = 0.5;  ///< of the avoidance that the robot takes on; 1: agents ignore it
  double margin_m = 0.3;     ///< outline to disc
  double view_m = 10.0;
  int agents_count = 20;
  double violation_weight = 3.0;  ///< of a border crossed by 1 m/s, against 1 m/s less progress
  double length_s = 3.0;
  double mean_s = 1.5;  ///< an arc counts as its mean velocity over this time
  double lookahead_m = 6.0;
  double patience_s = 3.0;

  template <class V>
  void visit(V& v) {
    v("horizon_s", horizon_s, config::kPositive, "Contact is avoided for so long [s]");
    v("share_ratio", share_ratio, config::Range{0.01, 1.0},
      "Share of the avoidance that the robot takes on; 1: agents ignore it");
    v("margin_m", margin_m, config::kNonNegative, "Kept free between outline and agents [m]");
    v("view_m", view_m, config::kPositive, "Agents are seen up to here [m]");
    v("agents_count", agents_count, config::Range{0, 500}, "... and of these the nearest");
    v("violation_weight", violation_weight, config::kNonNegative,
      "Of a crossed border [m/s] against lost progress [m/s]");
    v("length_s", length_s, config::Range{0.5, 30.0}, "Length of a plan [s]");
    v("mean_s", mean_s, config::Range{0.1, 30.0},
      "An arc counts as its mean velocity over this time [s]");
    v("lookahead_m", lookahead_m, config::kPositive, "The aim lies so far along the path [m]");
    v("patience_s", patience_s, config::kNonNegative,
      "After standing for so long, standing costs more and more [s]");
  }
};

/// Optimal reciprocal collision avoidance (van den Berg, Guy, Lin and Manocha 2011) as a planner
/// for vehicles that cannot take any velocity: a fan of the vehicle's own motions (arcs forwards
/// and backwards, turning on the spot, braking, the pursuit of the path at four speeds) is rolled
/// out within its limits, and the one is taken whose mean velocity crosses the agents' half-planes
/// least and that comes nearest to an aim on the path, along ways that the vehicle can drive.
/// Motions into static obstacles are refused; if all are, it brakes. Fixed cost, whatever the
/// budget: about 0.2 ms. Deterministic; does not allocate once it has seen as many agents.
class VelocityObstacle : public LocalPlanner {
 public:
  VelocityObstacle(const Vehicle& vehicle, const VelocityObstacleConfig& config = {});

 protected:
  void do_plan(const LocalScene& scene, const LocalGoal& goal, const PlanBudget& budget,
               LocalPlan& plan) override;

 private:
  void find_lines(const LocalScene& scene);
  double violation(const Point2& velocity) const;
  Point2 mean_velocity(const LocalPlan& plan) const;
  double distance_from(const VehicleState& state) const;
  double progress(const LocalPlan& plan) const;
  void pursue_path(const LocalScene& scene, const LocalGoal& goal, double speed);
  void hold(const LocalScene& scene, const Motion& motion);
  void consider(const LocalScene& scene, double extra, LocalPlan& best);
  void consider_arcs(const LocalScene& scene, LocalPlan& best);

  VelocityObstacleConfig config_;
  OutlineDiscs discs_;
  OutlineDisc disc_;
  Standstill standstill_;
  int steps_;
  double top_ = 0.0;                                  // fastest progress [m/s]
  Aim aim_;                                           // of all candidates
  double distance_ = 0.0;                             // to it, from the robot [m]
  std::vector<std::pair<double, std::size_t>> near_;  // distance, agent
  std::vector<VelocityLine> lines_;
  LocalPlan candidate_;
  LocalPlan scratch_;
};

}  // namespace headland
