// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/random.hpp"
#include "local_planner/prediction/response_features.hpp"

namespace headland::testing {

/// A small response network whose weights are drawn: it has learnt nothing, but what must hold for
/// any weights must hold for these.
inline ResponseNetwork random_network(std::uint64_t seed, Eigen::Index hidden = 8,
                                      float scale = 0.5F) {
  constexpr Eigen::Index kEmbedded = 5;
  RandomStream random(seed, "random_network");
  const auto layer = [&](Eigen::Index rows, Eigen::Index columns) {
    LinearLayer drawn{Eigen::MatrixXf(rows, columns), Eigen::VectorXf(rows)};
    const auto weight = [&] { return scale * static_cast<float>(random.normal()); };
    for (Eigen::Index i = 0; i < rows; ++i) {
      for (Eigen::Index j = 0; j < columns; ++j) drawn.weight(i, j) = weight();
      drawn.bias(i) = weight();
    }
    return drawn;
  };
  const Eigen::Index inputs = kOwnFeatures + 2 * kEmbedded;
  ResponseNetwork network;
  network.robot = layer(kEmbedded, kPairFeatures);
  network.neighbor = layer(kEmbedded, kPairFeatures);
  network.encoder.gates = layer(4 * hidden, inputs + hidden);
  network.decoder.gates = layer(4 * hidden, inputs + hidden);
  network.head = layer(kHeadOutputs, hidden);
  return network;
}

}  // namespace headland::testing
