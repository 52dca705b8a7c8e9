// SPDX-License-Identifier: Apache-2.0
#include "control/pure_pursuit/bounded_ramp.hpp"

#include <algorithm>

namespace headland {
namespace {

// The ramp ends on the path: weights of lateral [], heading [m^2] and curvature [m^4] there.
const Eigen::Vector3d kEndWeights{10.0, 10.0, 1.0};

}  // namespace

// One cell of length h, exact for the piecewise linear model.
void BoundedRamp::factorise(const std::vector<RampCell>& cells, const RampWeights& weights) {
  stages_.assign(cells.size(), {});
  Eigen::Matrix3d cost = kEndWeights.asDiagonal();
  for (std::size_t i = cells.size(); i-- > 0;) {
    const double h = cells[i].length;
    const double bend = cells[i].path_curvature;
    Stage& stage = stages_[i];
    stage.transition << 1.0, h, 0.5 * h * h, 0.0, 1.0, h, 0.0, 0.0, 1.0;
    stage.input << h * h * h / 6.0, 0.5 * h * h, h;
    stage.offset << -0.5 * h * h * bend, -h * bend, 0.0;
    stage.offset += cells[i].correction;
    stage.kappa_z = bend;
    // The curvature at the cell's end keeps to its bound through the penalty.
    cost(2, 2) += h * weights.penalty;
    const Eigen::RowVector3d seen = stage.input.transpose() * cost;
    stage.scale = seen.dot(stage.input) + h * (weights.rate + weights.penalty);
    stage.gain = seen * stage.transition / stage.scale;
    stage.weighted_offset = cost * stage.offset;
    cost = (stage.transition.transpose() * cost * stage.transition -
            stage.gain.transpose() * stage.scale * stage.gain)
               .eval();
    cost += Eigen::Vector3d(h, h * weights.heading, 0.0).asDiagonal();
    cost = (0.5 * (cost + cost.transpose())).eval();
  }
  first_cost_ = cost;
}

// The linear part of the cost to go, from the last border to the first.
Eigen::Vector3d BoundedRamp::sweep_back(const std::vector<RampCell>& cells,
                                        const RampWeights& weights) {
  Eigen::Vector3d linear(0.0, 0.0, -kEndWeights(2) * cells.back().path_curvature);
  for (std::size_t i = cells.size(); i-- > 0;) {
    Stage& stage = stages_[i];
    const double pull = cells[i].length * weights.penalty;
    linear(2) -= pull * (stage.kappa_z - stage.kappa_y);
    linear += stage.weighted_offset;
    const double slope = stage.input.dot(linear) - pull * (stage.z - stage.y);
    stage.k = slope / stage.scale;
    linear = (stage.transition.transpose() * linear - stage.gain.transpose() * slope).eval();
  }
  return linear;
}

void BoundedRamp::roll_out(const RampState& start, bool free_start, const Eigen::Vector3d& linear,
                           double curvature_bound) {
  states_[0] = start;
  if (free_start && first_cost_(2, 2) > 0.0) {
    const double rest = first_cost_(2, 0) * start(0) + first_cost_(2, 1) * start(1) + linear(2);
    states_[0](2) = std::clamp(-rest / first_cost_(2, 2), -curvature_bound, curvature_bound);
  }
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    Stage& stage = stages_[i];
    stage.u = -stage.gain.dot(states_[i]) - stage.k;
    states_[i + 1] = stage.transition * states_[i] + stage.input * stage.u + stage.offset;
  }
}

const std::vector<RampState>& BoundedRamp::solve(const std::vector<RampCell>& cells,
                                                 const RampState& start, bool free_start,
                                                 double curvature_bound,
                                                 const RampWeights& weights) {
  constexpr double kRelaxation = 1.6;
  states_.assign(cells.size() + 1, start);
  factorise(cells, weights);
  for (int iteration = 0; iteration < weights.iterations; ++iteration) {
    roll_out(start, free_start, sweep_back(cells, weights), curvature_bound);
    for (std::size_t i = 0; i < stages_.size(); ++i) {
      Stage& stage = stages_[i];
      const double bound = cells[i].rate_bound;
      const double u = kRelaxation * stage.u + (1.0 - kRelaxation) * stage.z;
      stage.z = std::clamp(u + stage.y, -bound, bound);
      stage.y += u - stage.z;
      const double kappa = kRelaxation * states_[i + 1](2) + (1.0 - kRelaxation) * stage.kappa_z;
      stage.kappa_z = std::clamp(kappa + stage.kappa_y, -curvature_bound, curvature_bound);
      stage.kappa_y += kappa - stage.kappa_z;
    }
  }
  return states_;
}

}  // namespace headland
