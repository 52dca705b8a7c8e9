// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace headland {

/// A cell of a path: constant curvature over a length, and how fast the vehicle can change its own.
struct RampCell {
  double length = 0.0;          ///< [m]
  double path_curvature = 0.0;  ///< [1/m] in the direction of travel
  double rate_bound = 0.0;      ///< change of curvature per metre driven [1/m^2]
  /// What the linear model below lacks over the cell.
  Eigen::Vector3d correction = Eigen::Vector3d::Zero();
};

/// Weights of a ramp's cost, per metre driven.
struct RampWeights {
  double heading = 0.02;  ///< of the squared heading error against the lateral one [m^2]
  double rate = 1e-6;     ///< of the squared change of curvature [m^6]
  double penalty = 3e-4;  ///< of breaking a bound, in the iteration [m^6]
  int iterations = 150;
};

/// Deviation from the path (lateral [m], heading [rad]) and the vehicle's curvature [1/m].
using RampState = Eigen::Vector3d;

/// The vehicle's curvature along the cells that stays nearest to the path in the mean square
/// although it can only change at the bounded rate: the quadratic programme
///   min sum e^2 + heading psi^2 + rate u^2,  e' = psi, psi' = kappa - kappa_path, kappa' = u,
///   |u| <= rate_bound, |kappa| <= curvature_bound
/// by the alternating direction method of multipliers, whose inner problem is one Riccati sweep.
class BoundedRamp {
 public:
  /// States at the cells' borders (one more than cells). With `free_start` the first curvature may
  /// be chosen (the wheels turn at a standstill), else start(2) counts.
  const std::vector<RampState>& solve(const std::vector<RampCell>& cells, const RampState& start,
                                      bool free_start, double curvature_bound,
                                      const RampWeights& weights);

 private:
  // What one cell contributes to the Riccati sweep; all but `k` fixed over the iterations.
  struct Stage {
    Eigen::Matrix3d transition;
    Eigen::Vector3d input;
    Eigen::Vector3d offset;
    Eigen::RowVector3d gain;
    Eigen::Vector3d weighted_offset;  // P of the next stage times the offset
    double scale = 0.0;               // B'PB + R
    double k = 0.0;
    double u = 0.0;  // the input, and its clamped copy with the multiplier
    double z = 0.0;
    double y = 0.0;
    double kappa_z = 0.0;  // the same of the curvature at the cell's end
    double kappa_y = 0.0;
  };

  void factorise(const std::vector<RampCell>& cells, const RampWeights& weights);
  Eigen::Vector3d sweep_back(const std::vector<RampCell>& cells, const RampWeights& weights);
  void roll_out(const RampState& start, bool free_start, const Eigen::Vector3d& linear,
                double curvature_bound);

  std::vector<Stage> stages_;
  std::vector<RampState> states_;
  Eigen::Matrix3d first_cost_;
};

}  // namespace headland
