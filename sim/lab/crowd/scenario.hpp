// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/pose2.hpp"

namespace headland {

/// The "mixed" test of Eiffert et al. 2020 ("Path planning in dynamic environments using generative
/// RNNs and Monte Carlo tree search"; stuarteiffert/MCTS-GRNN, MIT), which is CrowdNav's simulation
/// (Chen et al. 2019): 2 to 11 people cross a robot's way.
namespace crowd_protocol {
constexpr double kStep = 0.25;         ///< of people and of decisions [s]
constexpr double kTimeout = 24.0;      ///< [s]
constexpr double kCircleRadius = 7.5;  ///< the robot starts on it and goes to the other side [m]
constexpr double kSquareWidth = 16.0;  ///< [m]
constexpr double kCircleShare = 0.3;   ///< of the people who cross the circle; others the square
constexpr int kLeastPeople = 2;        ///< as many as to kMostPeople, equally often
constexpr int kMostPeople = 11;
constexpr double kRadius = 0.3;             ///< of people and robot [m]
constexpr double kSpeed = 1.0;              ///< of people and robot [m/s]
constexpr double kGoal = 0.6;               ///< the goal is reached nearer than this [m]
constexpr double kNear = 0.2;               ///< between outlines; nearer is a near miss [m]
constexpr double kOrcaMargin = 0.11;        ///< added to radii by people [m]
constexpr double kOrcaHorizon = 5.0;        ///< of people [s]
constexpr double kNeighborDistance = 10.0;  ///< people see others up to here [m]
constexpr int kMostNeighbors = 10;
constexpr double kDisturbanceReach = 5.0;  ///< people this near may be disturbed [m]
constexpr double kDisturbance = 1.0;       ///< they are if they change velocity by more [m/s2]
}  // namespace crowd_protocol

/// Someone at the beginning of an episode.
struct CrowdWalk {
  Point2 start{0.0, 0.0};  ///< [m]
  Point2 goal{0.0, 0.0};   ///< [m]
};

struct CrowdScenario {
  CrowdWalk robot;
  std::vector<CrowdWalk> people;
};

/// Scenario `run` of a seed, by the protocol's rules. People start free of each other and of the
/// robot.
CrowdScenario crowd_scenario(std::uint64_t seed, int run);

}  // namespace headland
