// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/response_features.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

using Eigen::Index;
using Vector = Eigen::Vector2f;

constexpr float kLength = 5.0F;  // scales [m], [m/s], [s]
constexpr float kSpeed = 1.5F;
constexpr float kHorizon = 4.0F;
constexpr float kReaction = 0.4F;    // no change of velocity works faster [s]
constexpr float kSoftness = 0.05F;   // which side to pass on is open below this [m]
constexpr float kLargest = 2.0F;     // features are cut here
constexpr float kNoiseScale = 0.1F;  // [m]

Vector into_frame(const Vector& heading, const Vector& v) {
  return {heading.x() * v.x() + heading.y() * v.y(), heading.x() * v.y() - heading.y() * v.x()};
}

}  // namespace

PairFeatures pair_features(const Vector& offset, const Vector& velocity, float reach) {
  const float distance = offset.norm();
  const float gap = std::max(distance - reach, -0.5F);
  const float toward = -offset.dot(velocity);
  const float passing = std::clamp(toward / (velocity.squaredNorm() + 0.01F), 0.0F, kHorizon);
  const Vector miss = offset + passing * velocity;
  const float miss_distance = miss.norm();
  const float depth = std::max(reach - miss_distance, 0.0F);
  const Vector near = offset * (std::exp(-gap) / (distance + kSoftness));
  const float urgency = std::min(depth / (passing + kReaction), kLargest);
  const Vector evasion = miss * (-urgency / (miss_distance + kSoftness));
  PairFeatures features;
  features << offset / kLength, velocity / kSpeed, near, evasion, passing / kHorizon,
      std::min(depth, kLargest);
  return features;
}

float visibility(float distance, float view) {
  return std::clamp(0.5F * (view - distance), 0.0F, 1.0F);
}

void ResponseInputs::gather_pairs(std::span<const CrowdMember> members, const CrowdMoment& moment,
                                  float robot_radius) {
  robot_pairs_.clear();
  neighbor_pairs_.clear();
  make_room(robot_features_, kPairFeatures, static_cast<Index>(members.size()));
  const auto add = [](std::size_t agent, const CrowdMember& member, const Vector& offset,
                      const Vector& velocity, float reach, float view, std::vector<Pair>& pairs,
                      Eigen::MatrixXf& features) {
    const float seen = visibility(offset.norm(), view);
    if (!(seen > 0.0F)) return;
    const auto column = static_cast<Index>(pairs.size());
    make_room(features, kPairFeatures, column + 1);
    features.col(column) = pair_features(into_frame(member.heading, offset),
                                         into_frame(member.heading, velocity), reach);
    pairs.push_back({static_cast<int>(agent), seen});
  };
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (!moment.present[i]) continue;
    add(i, members[i], moment.robot - moment.position[i],
        moment.robot_velocity - moment.velocity[i], members[i].radius + robot_radius, kRobotView,
        robot_pairs_, robot_features_);
    for (std::size_t j = 0; j < members.size(); ++j) {
      if (j == i || !moment.present[j]) continue;
      add(i, members[i], moment.position[j] - moment.position[i],
          moment.velocity[j] - moment.velocity[i], members[i].radius + members[j].radius,
          kNeighborView, neighbor_pairs_, neighbor_features_);
    }
  }
}

void ResponseInputs::compute(const ResponseNetwork& network, std::span<const CrowdMember> members,
                             const CrowdMoment& moment, float robot_radius,
                             Eigen::MatrixXf& stacked) {
  gather_pairs(members, moment, robot_radius);
  const Index robot_rows = network.robot.weight.rows();
  const Index neighbor_rows = network.neighbor.weight.rows();
  const auto agents = static_cast<Index>(members.size());
  stacked.topLeftCorner(kOwnFeatures + robot_rows + neighbor_rows, agents).setZero();
  for (Index i = 0; i < agents; ++i) {
    const auto agent = static_cast<std::size_t>(i);
    if (!moment.present[agent]) continue;
    const CrowdMember& member = members[agent];
    const Vector velocity = into_frame(member.heading, moment.velocity[agent]) / kSpeed;
    stacked.col(i).head<kOwnFeatures>() << velocity, member.radius, member.noise / kNoiseScale;
  }
  const auto embed = [&](const LinearLayer& layer, const std::vector<Pair>& pairs,
                         const Eigen::MatrixXf& features, Index first_row) {
    const auto count = static_cast<Index>(pairs.size());
    const Index rows = layer.weight.rows();
    if (count == 0) return;
    make_room(embedded_, rows, count);
    embedded_.leftCols(count).noalias() = layer.weight * features.leftCols(count);
    for (Index k = 0; k < count; ++k) {
      const Pair& pair = pairs[static_cast<std::size_t>(k)];
      auto most = stacked.col(pair.agent).segment(first_row, rows).array();
      most = most.max(pair.visibility * (embedded_.col(k) + layer.bias).array());
    }
  };
  embed(network.robot, robot_pairs_, robot_features_, kOwnFeatures);
  embed(network.neighbor, neighbor_pairs_, neighbor_features_, kOwnFeatures + robot_rows);
}

}  // namespace headland
