// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "global_planner/mission/mission_config.hpp"
#include "sim/lab/closed_loop.hpp"

namespace headland::apps {

/// A mission file as `plan` and `run` read it: the mission's own keys, and how to simulate it.
struct RunConfig {
  MissionConfig mission;
  SimulationConfig simulation;

  template <class V>
  void visit(V& v) {
    mission.visit(v);
    v("simulation", simulation, "How `headland run` drives the plan");
  }
};

}  // namespace headland::apps
