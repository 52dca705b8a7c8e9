// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>
#include <utility>

#include "core/config/visit.hpp"
#include "core/model/vehicle.hpp"
#include "local_planner/local_planner.hpp"
#include "local_planner/mcts/mcts_planner.hpp"

namespace headland {

enum class LocalPlannerKind { kMcts };

/// Settings of all local planners.
struct LocalPlannersConfig {
  MctsConfig mcts;

  template <class V>
  void visit(V& v) {
    v("mcts", mcts, "Monte Carlo tree search");
  }
};

std::unique_ptr<LocalPlanner> make_local_planner(LocalPlannerKind kind,
                                                 const LocalPlannersConfig& config,
                                                 const Vehicle& vehicle);

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::LocalPlannerKind> {
  static constexpr std::pair<headland::LocalPlannerKind, std::string_view> values[] = {
      {headland::LocalPlannerKind::kMcts, "mcts"}};
};
