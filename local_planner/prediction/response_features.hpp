// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "local_planner/prediction/recurrent_network.hpp"

namespace headland {

// What the response network sees of an agent at one moment: itself, the robot, its neighbours.
// All vectors are in the agent's own frame: x along its velocity at the moment of the prediction.
// Lengths in m, velocities in m/s, scaled to be about 1.

inline constexpr int kOwnFeatures = 4;    ///< velocity (2), radius, deviation of the sights
inline constexpr int kPairFeatures = 10;  ///< see pair_features
inline constexpr int kHeadOutputs = 5;
inline constexpr float kRobotView = 10.0F;    ///< the robot is seen up to here [m]
inline constexpr float kNeighborView = 6.0F;  ///< neighbours are seen up to here [m]

using PairFeatures = Eigen::Matrix<float, kPairFeatures, 1>;

/// What another disc at `offset` [m] with relative velocity `velocity` [m/s] means to an agent if
/// their centres want to be `reach` [m] apart: offset, velocity, nearness, and where the two would
/// be when they pass: how deep inside `reach`, when, and the least change of velocity that would
/// keep them out of it. Smooth but where a reach is entered.
PairFeatures pair_features(const Eigen::Vector2f& offset, const Eigen::Vector2f& velocity,
                           float reach);

/// How much of another at a distance is seen: 1 up to 2 m before `view`, falling to 0 there.
float visibility(float distance, float view);

/// All agents and the robot at one moment, relative to any origin that they share [m, m/s].
struct CrowdMoment {
  std::vector<Eigen::Vector2f> position;
  std::vector<Eigen::Vector2f> velocity;
  std::vector<char> present;  ///< whether an agent has been seen by then
  Eigen::Vector2f robot{0.0F, 0.0F};
  Eigen::Vector2f robot_velocity{0.0F, 0.0F};  ///< over the step that begins now
};

/// What of an agent does not change.
struct CrowdMember {
  Eigen::Vector2f heading{1.0F, 0.0F};  ///< of its frame, a unit vector
  float radius = 0.5F;                  ///< [m]
  float noise = 0.0F;                   ///< standard deviation of its sights [m]
};

/// Computes the inputs of a network's LSTM cells. Keeps its buffers.
class ResponseInputs {
 public:
  /// One column per agent into the upper rows of `stacked`; those of absent agents are zero.
  /// O(n2) for n agents within each other's view.
  void compute(const ResponseNetwork& network, std::span<const CrowdMember> members,
               const CrowdMoment& moment, float robot_radius, Eigen::MatrixXf& stacked);

 private:
  void gather_pairs(std::span<const CrowdMember> members, const CrowdMoment& moment,
                    float robot_radius);

  struct Pair {
    int agent = 0;
    float visibility = 0.0F;
  };
  std::vector<Pair> robot_pairs_;
  std::vector<Pair> neighbor_pairs_;
  Eigen::MatrixXf robot_features_;  // one column per pair
  Eigen::MatrixXf neighbor_features_;
  Eigen::MatrixXf embedded_;
};

}  // namespace headland
