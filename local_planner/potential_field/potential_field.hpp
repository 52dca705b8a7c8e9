// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "core/config/visit.hpp"
#include "local_planner/course.hpp"
#include "local_planner/local_planner.hpp"
#include "local_planner/potential_field/repulsion.hpp"
#include "local_planner/rollout.hpp"

namespace headland {

/// Which field the agents make.
enum class PotentialForm {
  kSeed,     ///< of seed 003's authors: by distance only, agents stand
  kVelocity  ///< Ge and Cui (2002): by distance and relative velocity
};

struct PotentialFieldConfig {
  PotentialForm form = PotentialForm::kVelocity;
  SeedRepulsion seed;
  VelocityRepulsion velocity;
  double swirl_ratio = 0.5;        ///< of each push, turned aside: around instead of back
  double least_speed_ratio = 0.3;  ///< of the wanted one, against pushes
  double lookahead_m = 4.0;
  double length_s = 3.0;
  double view_m = 10.0;

  template <class V>
  void visit(V& v) {
    v("form", form, "Which field agents make");
    v("seed", seed, "Field of seed 003's authors");
    v("velocity", velocity, "Field of Ge and Cui");
    v("swirl_ratio", swirl_ratio, config::Range{0.0, 10.0},
      "Of each push, turned aside so that it leads around");
    v("least_speed_ratio", least_speed_ratio, config::kFraction,
      "Of the wanted speed: pushes slow down no further");
    v("lookahead_m", lookahead_m, config::Range{0.1, 20.0},
      "What attracts lies so far along the path [m]");
    v("length_s", length_s, config::Range{0.5, 30.0}, "Length of a plan [s]");
    v("view_m", view_m, config::kPositive, "Agents are seen up to here [m]");
  }
};

/// Potential fields: an aim on the path attracts with a force of 1, agents and static obstacles
/// repel, and the vehicle drives where the sum points, as far as it can turn, slower against a
/// push; rolled out step by step. Local minima are what such fields have: the swirl (vortex fields,
/// De Medio and Oriolo 1991) leads out of some. Before static obstacles it brakes. Fixed cost,
/// whatever the budget: about 0.05 ms for 40 agents. Deterministic; does not allocate once it has
/// seen as many agents.
class PotentialField : public LocalPlanner {
 public:
  PotentialField(const Vehicle& vehicle, const PotentialFieldConfig& config = {});

 protected:
  void do_plan(const LocalScene& scene, const LocalGoal& goal, const PlanBudget& budget,
               LocalPlan& plan) override;

 private:
  Motion turn_to(const VehicleState& state, const Aim& aim, double speed) const;
  void roll_out(const LocalScene& scene, const LocalGoal& goal, double speed, LocalPlan& plan);
  void find_sources(const LocalScene& scene, const VehicleState& state, double ahead_s);
  void add_obstacle(const ClearanceMap& map, const VehicleState& state);
  Point2 repulsion(const VehicleState& state, const Point2& to_aim) const;

  PotentialFieldConfig config_;
  OutlineDiscs discs_;
  OutlineDisc disc_;
  std::vector<PotentialSource> sources_;
  LocalPlan scratch_;
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::PotentialForm> {
  static constexpr std::pair<headland::PotentialForm, std::string_view> values[] = {
      {headland::PotentialForm::kSeed, "seed"}, {headland::PotentialForm::kVelocity, "velocity"}};
};
