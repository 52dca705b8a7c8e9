// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/training/internal/response_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "local_planner/prediction/response_features.hpp"

namespace headland::training {
namespace {

using torch::Tensor;
using torch::indexing::Slice;

// Vectors [..., 2] into frames whose x axes are `heading` [..., 2].
Tensor into_frame(const Tensor& heading, const Tensor& v) {
  const Tensor hx = heading.select(-1, 0);
  const Tensor hy = heading.select(-1, 1);
  const Tensor x = v.select(-1, 0);
  const Tensor y = v.select(-1, 1);
  return torch::stack({hx * x + hy * y, hx * y - hy * x}, -1);
}

Tensor out_of_frame(const Tensor& heading, const Tensor& v) {
  const Tensor hx = heading.select(-1, 0);
  const Tensor hy = heading.select(-1, 1);
  const Tensor x = v.select(-1, 0);
  const Tensor y = v.select(-1, 1);
  return torch::stack({hx * x - hy * y, hy * x + hx * y}, -1);
}

// pair_features() of response_features.hpp, for tensors [..., 2] and [...].
Tensor pair_features_of(const Tensor& offset, const Tensor& velocity, const Tensor& reach) {
  const Tensor distance = offset.norm(2, -1);
  const Tensor gap = (distance - reach).clamp_min(-0.5);
  const Tensor toward = -(offset * velocity).sum(-1);
  const Tensor passing = (toward / (velocity.square().sum(-1) + 0.01)).clamp(0.0, 4.0);
  const Tensor miss = offset + passing.unsqueeze(-1) * velocity;
  const Tensor miss_distance = miss.norm(2, -1);
  const Tensor depth = (reach - miss_distance).clamp_min(0.0);
  const Tensor near = offset * ((-gap).exp() / (distance + 0.05)).unsqueeze(-1);
  const Tensor urgency = (depth / (passing + 0.4)).clamp_max(2.0);
  const Tensor evasion = miss * (-urgency / (miss_distance + 0.05)).unsqueeze(-1);
  return torch::cat({offset / 5.0, velocity / 1.5, near, evasion, (passing / 4.0).unsqueeze(-1),
                     depth.clamp_max(2.0).unsqueeze(-1)},
                    -1);
}

Tensor visibility_of(const Tensor& offset, double view) {
  return (0.5 * (view - offset.norm(2, -1))).clamp(0.0, 1.0);
}

Tensor linear(const Tensor& weight, const Tensor& bias, const Tensor& x) {
  return torch::linear(x, weight, bias);
}

}  // namespace

ResponseModel::ResponseModel(int embedded, int hidden, std::uint64_t seed) {
  torch::manual_seed(seed);
  const int inputs = kOwnFeatures + 2 * embedded;
  const auto make = [](int rows, int columns, double scale) {
    const double bound = scale * std::sqrt(3.0 / columns);
    Layer layer{torch::empty({rows, columns}).uniform_(-bound, bound), torch::zeros({rows})};
    return layer;
  };
  robot_ = make(embedded, kPairFeatures, 1.4);
  neighbor_ = make(embedded, kPairFeatures, 1.4);
  encoder_ = make(4 * hidden, inputs + hidden, 1.0);
  decoder_ = make(4 * hidden, inputs + hidden, 1.0);
  head_ = make(kHeadOutputs, hidden, 0.2);
  for (Layer* lstm : {&encoder_, &decoder_}) {
    lstm->bias.index_put_({Slice(hidden, 2 * hidden)}, 1.0);  // the forget gate begins open
  }
  head_.bias.index_put_({Slice(2, 4)}, -2.0);
  for (Tensor& parameter : parameters()) parameter.set_requires_grad(true);
}

std::vector<Tensor> ResponseModel::parameters() const {
  std::vector<Tensor> all;
  for (const Layer* layer : {&robot_, &neighbor_, &encoder_, &decoder_, &head_}) {
    all.push_back(layer->weight);
    all.push_back(layer->bias);
  }
  return all;
}

ResponseModel::State ResponseModel::step(const Layer& gates, const Tensor& inputs,
                                         const State& state) {
  const Tensor all = linear(gates.weight, gates.bias, torch::cat({inputs, state.hidden}, -1));
  const auto parts = all.chunk(4, -1);
  const Tensor cell = parts[1].sigmoid() * state.cell + parts[0].sigmoid() * parts[2].tanh();
  return {parts[3].sigmoid() * cell.tanh(), cell};
}

// All tensors may have more dimensions before [A, 2] and, for the robot's, [2].
Tensor ResponseModel::inputs(const Batch& batch, const Tensor& position, const Tensor& velocity,
                             const Tensor& present, const Tensor& robot,
                             const Tensor& robot_velocity) const {
  Tensor own;
  Tensor robot_pairs;
  Tensor robot_seen;
  Tensor pairs;
  Tensor pairs_seen;
  const auto agents = position.size(-2);
  Tensor heading = batch.heading;
  Tensor radius = batch.radius;
  Tensor noise = batch.noise;
  Tensor robot_radius = batch.robot_radius;
  if (position.dim() == 4) {  // the moments of the past at once
    heading = heading.unsqueeze(1).expand(position.sizes());
    radius = radius.unsqueeze(1).expand(present.sizes());
    noise = noise.unsqueeze(1).expand(present.sizes());
    robot_radius = robot_radius.unsqueeze(-1);
  }
  {
    // No gradient flows back through what agents see of each other: what they remember carries it.
    const torch::NoGradGuard no_gradient;
    const Tensor to_robot = robot.unsqueeze(-2) - position;
    robot_seen = visibility_of(to_robot, kRobotView) * present;
    robot_pairs = pair_features_of(into_frame(heading, to_robot),
                                   into_frame(heading, robot_velocity.unsqueeze(-2) - velocity),
                                   radius + robot_radius.unsqueeze(-1));
    const Tensor offset = position.unsqueeze(-3) - position.unsqueeze(-2);
    const Tensor relative = velocity.unsqueeze(-3) - velocity.unsqueeze(-2);
    const Tensor frames = heading.unsqueeze(-2).expand(offset.sizes());
    pairs_seen = visibility_of(offset, kNeighborView) * present.unsqueeze(-1) *
                 present.unsqueeze(-2) * (1.0 - torch::eye(agents));
    pairs = pair_features_of(into_frame(frames, offset), into_frame(frames, relative),
                             radius.unsqueeze(-1) + radius.unsqueeze(-2));
    own = torch::cat({into_frame(heading, velocity) / 1.5, radius.unsqueeze(-1),
                      noise.unsqueeze(-1) / 0.1},
                     -1) *
          present.unsqueeze(-1);
  }
  const Tensor robot_embedded =
      linear(robot_.weight, robot_.bias, robot_pairs).relu() * robot_seen.unsqueeze(-1);
  const Tensor neighbors_embedded =
      linear(neighbor_.weight, neighbor_.bias, pairs).relu() * pairs_seen.unsqueeze(-1);
  return torch::cat({own, robot_embedded, neighbors_embedded.amax(-2)}, -1);
}

Forecast ResponseModel::forward(const Batch& batch, const WindowShape& shape) const {
  const int past = shape.past_steps;
  const auto windows = batch.seen.size(0);
  const auto agents = batch.seen.size(1);
  const auto hidden = head_.weight.size(1);
  const double dt = shape.step_s;
  const Tensor robot_velocity =
      (batch.robot.index({Slice(), Slice(1)}) - batch.robot.index({Slice(), Slice(0, -1)})) / dt;
  const auto moments_first = [](const Tensor& x) { return x.transpose(1, 2); };  // [B, T, A, ...]
  const Tensor seen = moments_first(batch.seen);
  const Tensor velocities = moments_first(batch.velocity);
  const Tensor present = moments_first(batch.present);

  State state{torch::zeros({windows, agents, hidden}), torch::zeros({windows, agents, hidden})};
  const auto before = Slice(0, past);
  const Tensor encoder_inputs =
      inputs(batch, seen.index({Slice(), before}), velocities.index({Slice(), before}),
             present.index({Slice(), before}), batch.robot.index({Slice(), before}),
             robot_velocity.index({Slice(), before}));
  for (int k = 0; k < past; ++k) {
    state = step(encoder_, encoder_inputs.select(1, k), state);
    const Tensor there = present.select(1, k).unsqueeze(-1);
    state = {state.hidden * there, state.cell * there};
  }

  Tensor position = seen.select(1, past);
  Tensor velocity = velocities.select(1, past);
  Tensor xx = batch.noise.square();
  Tensor xy = torch::zeros_like(xx);
  Tensor yy = batch.noise.square();
  std::vector<Tensor> errors;
  std::vector<Tensor> covariances;
  for (int k = past; k < past + shape.future_steps; ++k) {
    const Tensor x = inputs(batch, position.detach(), velocity.detach(), batch.counts,
                            batch.robot.select(1, k), robot_velocity.select(1, k));
    state = step(decoder_, x, state);
    const Tensor out = linear(head_.weight, head_.bias, state.hidden);
    velocity = velocity + out_of_frame(batch.heading, out.index({"...", Slice(0, 2)}));
    position = position + dt * velocity;
    const Tensor deviation = out.index({"...", Slice(2, 4)}).clamp(-6.0, 1.5).exp();
    const Tensor a = deviation.select(-1, 0);
    const Tensor b = deviation.select(-1, 1);
    xx = xx + a.square();
    yy = yy + b.square();
    xy = xy + 0.95 * a * b * out.select(-1, 4).tanh();
    errors.push_back(into_frame(batch.heading, batch.position.select(2, k + 1) - position));
    covariances.push_back(torch::stack({xx, xy, yy}, -1));
  }
  return {torch::stack(errors, 2), torch::stack(covariances, 2)};
}

Tensor negative_log_likelihood(const Forecast& forecast, const Tensor& counts) {
  const Tensor xx = forecast.covariance.select(-1, 0);
  const Tensor xy = forecast.covariance.select(-1, 1);
  const Tensor yy = forecast.covariance.select(-1, 2);
  const Tensor x = forecast.error.select(-1, 0);
  const Tensor y = forecast.error.select(-1, 1);
  const Tensor determinant = xx * yy - xy.square();
  const Tensor mahalanobis = (yy * x.square() - 2.0 * xy * x * y + xx * y.square()) / determinant;
  const Tensor loss = 0.5 * (mahalanobis + determinant.log()) + std::log(2.0 * 3.14159265358979);
  return (loss * counts.unsqueeze(-1)).sum() / (counts.sum() * loss.size(-1));
}

ResponseNetwork ResponseModel::to_network(const WindowShape& shape) const {
  const auto layer = [](const Layer& from) {
    const Tensor weight = from.weight.detach().contiguous();
    const Tensor bias = from.bias.detach().contiguous();
    using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    LinearLayer to;
    to.weight =
        Eigen::Map<const RowMajor>(weight.data_ptr<float>(), weight.size(0), weight.size(1));
    to.bias = Eigen::Map<const Eigen::VectorXf>(bias.data_ptr<float>(), bias.size(0));
    return to;
  };
  ResponseNetwork network;
  network.step_s = shape.step_s;
  network.past_steps = shape.past_steps;
  network.robot = layer(robot_);
  network.neighbor = layer(neighbor_);
  network.encoder.gates = layer(encoder_);
  network.decoder.gates = layer(decoder_);
  network.head = layer(head_);
  return network;
}

void ResponseModel::set(const ResponseNetwork& network) {
  const torch::NoGradGuard no_gradient;
  const auto copy = [](const LinearLayer& from, Layer& to) {
    for (Eigen::Index i = 0; i < from.weight.rows(); ++i) {
      for (Eigen::Index j = 0; j < from.weight.cols(); ++j) to.weight[i][j] = from.weight(i, j);
      to.bias[i] = from.bias(i);
    }
  };
  copy(network.robot, robot_);
  copy(network.neighbor, neighbor_);
  copy(network.encoder.gates, encoder_);
  copy(network.decoder.gates, decoder_);
  copy(network.head, head_);
}

}  // namespace headland::training
