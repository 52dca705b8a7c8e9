// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <torch/torch.h>

#include "core/base/random.hpp"
#include "local_planner/prediction/recurrent_network.hpp"
#include "sim/lab/prediction/crowd_windows.hpp"

namespace headland::training {

/// Windows as tensors of floats: B windows of A agents (fewer are padded), T moments of which the
/// first P + 1 are the past and now. Positions are relative to the robot's place now.
struct Batch {
  torch::Tensor position;      ///< [B, A, T, 2], true
  torch::Tensor seen;          ///< [B, A, P + 1, 2], as the robot saw it
  torch::Tensor velocity;      ///< [B, A, P + 1, 2], likewise
  torch::Tensor heading;       ///< [B, A, 2]
  torch::Tensor radius;        ///< [B, A]
  torch::Tensor noise;         ///< [B, A]
  torch::Tensor present;       ///< [B, A, P + 1], 1 where an agent was seen
  torch::Tensor robot;         ///< [B, T, 2]
  torch::Tensor robot_radius;  ///< [B]
  torch::Tensor counts;        ///< [B, A], 1 for agents, 0 for padding
};

/// How sights differ from the truth in training, so that the network learns to live with it.
struct Disturbance {
  bool mirrored = false;
  double turned_rad = 0.0;
  double noisy_probability = 0.0;  ///< of an agent: noise of positions and velocities
  double most_noise_m = 0.15;
  double noise_per_s = 1.5;              ///< of velocities, per noise of positions [1/s]
  double no_velocity_probability = 0.0;  ///< of a window: velocities from positions
  double short_probability = 0.0;        ///< of an agent: first seen within the past
};

Batch make_batch(std::span<const CrowdWindow* const> windows, const WindowShape& shape,
                 const Disturbance& disturbance, RandomStream& random);

/// What the network says: errors are in each agent's frame.
struct Forecast {
  torch::Tensor error;       ///< [B, A, F, 2]: truth less mean [m]
  torch::Tensor covariance;  ///< [B, A, F, 3]: xx, xy, yy [m2]
};

/// The response network of local_planner/prediction as a function of tensors that can be trained.
/// The features are the same formulas; the tests hold the two together.
class ResponseModel {
 public:
  ResponseModel(int embedded, int hidden, std::uint64_t seed);

  Forecast forward(const Batch& batch, const WindowShape& shape) const;
  std::vector<torch::Tensor> parameters() const;

  ResponseNetwork to_network(const WindowShape& shape) const;
  void set(const ResponseNetwork& network);

 private:
  struct Layer {
    torch::Tensor weight;
    torch::Tensor bias;
  };
  struct State {
    torch::Tensor hidden;
    torch::Tensor cell;
  };
  static State step(const Layer& gates, const torch::Tensor& inputs, const State& state);
  torch::Tensor inputs(const Batch& batch, const torch::Tensor& position,
                       const torch::Tensor& velocity, const torch::Tensor& present,
                       const torch::Tensor& robot, const torch::Tensor& robot_velocity) const;

  Layer robot_;
  Layer neighbor_;
  Layer encoder_;
  Layer decoder_;
  Layer head_;
};

/// Mean over agents and steps of the negative logarithm of the Gaussian's density.
torch::Tensor negative_log_likelihood(const Forecast& forecast, const torch::Tensor& counts);

}  // namespace headland::training
