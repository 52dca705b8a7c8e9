// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"

namespace headland {

/// Crowds to learn from, and to be tried on.
enum class CrowdScene : std::int8_t {
  kDense,     ///< seed 003: 10 m2 per agent, 0.1 to 1.5 m/s, radius 0.5 m, robots seen as 1.5 m
  kSparse,    ///< seed 003: the same at 50 m2 per agent
  kCrossing,  ///< MCTS-GRNN: 2 to 11 people of 0.3 m at 1 m/s cross a circle or a square
  kMixed      ///< densities, radii of agents and of robots drawn per episode
};

/// How a window is cut: `past_steps` before now, now, `future_steps` after it.
struct WindowShape {
  double step_s = 0.4;
  int past_steps = 7;
  int future_steps = 12;
  int most_agents = 12;    ///< the nearest to the robot
  double within_m = 10.0;  ///< of the robot
  int moments() const { return past_steps + 1 + future_steps; }
};

/// What a robot saw of a crowd, what it then did, and what the crowd then did.
struct CrowdWindow {
  CrowdScene scene = CrowdScene::kDense;
  double robot_radius_m = 1.5;   ///< that agents take the robot to have
  std::vector<Point2> robot;     ///< [m], one per moment
  std::vector<double> radius_m;  ///< one per agent
  std::vector<Point2> position;  ///< [m], position[agent * moments + moment]
  std::vector<Point2> velocity;  ///< [m/s], of the simulator's step that ended then

  int agents() const { return static_cast<int>(radius_m.size()); }
};

/// Windows from `episodes` simulated episodes with a robot that wanders among the agents.
/// Deterministic for a seed; episodes of different seeds share nothing.
std::vector<CrowdWindow> record_windows(CrowdScene scene, const WindowShape& shape, int episodes,
                                        std::uint64_t seed);

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::CrowdScene> {
  static constexpr std::pair<headland::CrowdScene, std::string_view> values[] = {
      {headland::CrowdScene::kDense, "dense"},
      {headland::CrowdScene::kSparse, "sparse"},
      {headland::CrowdScene::kCrossing, "crossing"},
      {headland::CrowdScene::kMixed, "mixed"}};
};
