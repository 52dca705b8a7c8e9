// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace headland::internal {

/// What one reading of M numbers says about a state of N: residual z - h(x), H = dh/dx, R.
template <int N, int M>
struct Innovation {
  Eigen::Matrix<double, M, 1> residual;
  Eigen::Matrix<double, M, N> by_state;
  Eigen::Matrix<double, M, M> noise;

  Eigen::Matrix<double, M, M> spread(const Eigen::Matrix<double, N, N>& covariance) const {
    return by_state * covariance * by_state.transpose() + noise;
  }
  /// Normalised innovation squared: chi-squared with M degrees of freedom if the model holds.
  double squared_distance(const Eigen::Matrix<double, N, N>& covariance) const {
    return residual.dot(spread(covariance).inverse() * residual);
  }
};

/// Kalman's update, the covariance in Joseph's form: it stays symmetric and positive.
template <int N, int M>
void update(Eigen::Matrix<double, N, 1>& state, Eigen::Matrix<double, N, N>& covariance,
            const Innovation<N, M>& seen) {
  using Square = Eigen::Matrix<double, N, N>;
  const Eigen::Matrix<double, N, M> cross = covariance * seen.by_state.transpose();
  const Eigen::Matrix<double, N, M> gain = cross * seen.spread(covariance).inverse();
  state += gain * seen.residual;
  const Square keep = Square::Identity() - gain * seen.by_state;
  covariance = (keep * covariance * keep.transpose() + gain * seen.noise * gain.transpose()).eval();
  covariance = (0.5 * (covariance + covariance.transpose())).eval();
}

/// Chi-squared below which 99 % of good readings of 1, 2 and 3 numbers lie.
constexpr double gate_99(int numbers) {
  return numbers == 1 ? 6.635 : numbers == 2 ? 9.210 : 11.345;
}
/// Likewise 95 %: beyond it a reading is doubted.
constexpr double gate_95(int numbers) {
  return numbers == 1 ? 3.841 : numbers == 2 ? 5.991 : 7.815;
}

}  // namespace headland::internal
