// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>
#include <utility>

#include "core/config/visit.hpp"
#include "core/model/vehicle.hpp"
#include "local_planner/local_planner.hpp"
#include "local_planner/prediction/predictor.hpp"

namespace headland {

/// What a node of the tree costs.
enum class MctsCost {
  kSeed,      ///< (003) Eq. 1 as it stands: squared distance to the local goal, and alpha U
  kKinematic  ///< seconds: time passed, risk, and the time that the vehicle still needs
};

/// Settings of the tree search; defaults in brackets of seed 003 where it gives them.
struct MctsConfig {
  MctsCost cost = MctsCost::kKinematic;
  double step_s = 0.4;
  int depth_count = 12;
  double exploration_ratio = 0.1;
  double widening_ratio = 2.0;
  double widening_exponent_ratio = 0.45;
  double lookahead_m = 9.0;
  int agents_count = 16;
  double view_m = 12.0;
  double clearance_m = 0.42;
  double risk_ratio = 10.0;
  double patience_s = 3.0;
  double contact_s = 60.0;
  double trust_s = 4.0;
  double reverse_ratio = 2.0;
  double steering_ratio = 1.5;
  double pace_ratio = 0.75;
  double progress_ratio = 0.05;
  double detour_s = 2.0;
  double influence_m = 3.0;
  double match_m = 0.25;
  double stale_s = 0.5;

  template <class V>
  void visit(V& v) {
    v("cost", cost, "Of a node: seed (Eq. 1 of 003) or kinematic");
    v("step_s", step_s, config::Range{0.05, 2.0}, "Between the tree's levels [s]");
    v("depth_count", depth_count, config::Range{1, 40}, "Levels of the tree and its rollouts");
    v("exploration_ratio", exploration_ratio, config::kNonNegative,
      "Weight of exploration, with costs scaled to [0, 1]");
    v("widening_ratio", widening_ratio, config::Range{1.0, 100.0},
      "A node visited n times has at most this times n^widening_exponent_ratio children");
    v("widening_exponent_ratio", widening_exponent_ratio, config::kFraction, "See widening_ratio");
    v("lookahead_m", lookahead_m, config::kPositive,
      "The local goal lies this far ahead on the global path [m]");
    v("agents_count", agents_count, config::Range{1, 200}, "The nearest so many are looked at");
    v("view_m", view_m, config::kPositive, "As far as this [m]");
    v("clearance_m", clearance_m, config::kPositive,
      "Nearer to an agent than this, outline to outline, is a risk [m]");
    v("risk_ratio", risk_ratio, config::kNonNegative,
      "A second at the brink of contact costs this many seconds");
    v("patience_s", patience_s, config::kPositive,
      "After standing so long, risk counts half, after twice as long a third: agents give way [s]");
    v("contact_s", contact_s, config::kNonNegative, "What a contact costs [s]");
    v("trust_s", trust_s, config::kPositive,
      "Risk counts less the farther ahead: agents react; it falls to 1/e in this time [s]");
    v("reverse_ratio", reverse_ratio, config::Range{1.0, 100.0}, "Cost of time in reverse gear");
    v("steering_ratio", steering_ratio, config::kNonNegative,
      "Seconds for turning the steering from lock to lock");
    v("pace_ratio", pace_ratio, config::kNonNegative,
      "Seconds for speeding up or braking by the wanted speed");
    v("progress_ratio", progress_ratio, config::kNonNegative,
      "Each second counts this part of the time that is still needed: what can be done is done "
      "now");
    v("detour_s", detour_s, config::kNonNegative,
      "What it costs to go around somebody who stands beyond the last step [s]");
    v("influence_m", influence_m, config::kPositive, "d of (003) Eq. 2 [m]");
    v("match_m", match_m, config::kPositive,
      "epsilon of (003) Eq. 3: the tree is kept if all agents are this near to where it had them "
      "[m]");
    v("stale_s", stale_s, config::kPositive, "A tree older than this is not kept [s]");
  }
};

/// Monte Carlo tree search over the vehicle's own manoeuvres (003, III-C.2): every level holds a
/// steering and an acceleration for step_s, within the vehicle's limits, reverse gear included
/// where it has one. New nodes are finished by a rollout that heads for the local goal, or else
/// brakes. Steps are checked against the map and, in continuous time, against the predicted agents.
/// A braking manoeuvre is always among the root's children; at any moment the best plan so far can
/// be taken.
class MctsPlanner : public LocalPlanner {
 public:
  /// `predictor` may be any; null: constant velocities as observed.
  MctsPlanner(const Vehicle& vehicle, const MctsConfig& config,
              std::unique_ptr<Predictor> predictor = nullptr);
  ~MctsPlanner() override;

  /// Nodes that the last plan took over from the tree before (003, Eq. 3).
  int kept_nodes() const;

 protected:
  void do_observe(const LocalScene& scene) override;
  void do_plan(const LocalScene& scene, const LocalGoal& goal, const PlanBudget& budget,
               LocalPlan& plan) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::MctsCost> {
  static constexpr std::pair<headland::MctsCost, std::string_view> values[] = {
      {headland::MctsCost::kSeed, "seed"}, {headland::MctsCost::kKinematic, "kinematic"}};
};
