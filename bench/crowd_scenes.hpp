// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "core/geometry/angle.hpp"
#include "sim/crowd/crowd.hpp"

// Crowds to be timed: the two that ORCA's authors show, and seed 003's densities.
namespace headland::bench {

struct Scene {
  CrowdConfig config;
  double step = 0.25;  // [s]
  int steps = 0;       // timed
  std::vector<CrowdAgent> agents;
  std::vector<Polyline> walls;
};

inline CrowdConfig scene_config(double distance, double horizon) {
  CrowdConfig config;
  config.neighbor_distance_m = distance;
  config.horizon_s = config.obstacle_horizon_s = horizon;
  config.arrival_m = 0.0;
  config.nudge_mps = 0.0;
  return config;
}

// Places in single precision, so that a peer in floats has the very same ones.
inline CrowdAgent scene_agent(const Point2& position, const Point2& goal, double radius,
                              double max_speed) {
  const auto rounded = [](const Point2& p) { return Point2(p.cast<float>().cast<double>()); };
  CrowdAgent agent;
  agent.position = rounded(position);
  agent.goal = rounded(goal);
  agent.radius_m = radius;
  agent.max_speed_mps = max_speed;
  return agent;
}

inline Scene circle() {
  Scene scene{scene_config(15.0, 10.0), 0.25, 2000, {}, {}};
  for (int i = 0; i < 250; ++i) {
    const double angle = 2.0 * kPi * i / 250.0;
    const Point2 p(200.0 * std::cos(angle), 200.0 * std::sin(angle));
    scene.agents.push_back(scene_agent(p, -p, 1.5, 2.0));
  }
  return scene;
}

inline Scene blocks() {
  Scene scene{scene_config(15.0, 5.0), 0.25, 800, {}, {}};
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (int i = 0; i < 25; ++i) {
        const Point2 p(x * (55.0 + 10.0 * (i / 5)), y * (55.0 + 10.0 * (i % 5)));
        scene.agents.push_back(scene_agent(p, {-75.0 * x, -75.0 * y}, 2.0, 2.0));
      }
      const Point2 low(x < 0.0 ? -40.0 : 10.0, y < 0.0 ? -40.0 : 10.0);
      scene.walls.push_back(
          {low, low + Point2(30.0, 0.0), low + Point2(30.0, 30.0), low + Point2(0.0, 30.0)});
    }
  }
  return scene;
}

// So many agents on a hectare.
inline Scene field(int count) {
  Scene scene{scene_config(10.0, 3.0), 0.1, 300, {}, {}};
  RandomStream random(1, "field");
  for (int i = 0; i < count; ++i) {
    const Point2 p(random.uniform(0.0, 100.0), random.uniform(0.0, 100.0));
    const Point2 goal(random.uniform(0.0, 100.0), random.uniform(0.0, 100.0));
    scene.agents.push_back(scene_agent(p, goal, 0.5, 1.5));
  }
  return scene;
}

}  // namespace headland::bench
