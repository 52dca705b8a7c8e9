// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "control/estimation/estimation_log.hpp"
#include "control/estimation/estimator.hpp"

namespace headland {
namespace control::internal {
class EstimationWindow;
}

/// How the noise over the window is blocked: held constant over blocks of intervals (Wallace et al.
/// 2018, 2019; seed 003's [2]-[4]).
enum class NoiseBlocking {
  kNone,       ///< every interval has its own
  kUniform,    ///< blocks of equal length
  kStructured  ///< short blocks near the present, growing into the past
};

struct HorizonEstimatorConfig {
  double window_s = 2.0;
  double period_s = 0.05;
  NoiseBlocking blocking = NoiseBlocking::kStructured;
  int blocks_count = 8;
  int iterations_count = 5;
  double tail_freedom_count = 1.0;
  double fresh_s = 0.35;
  double fresh_weight = 2e-3;

  template <class V>
  void visit(V& v) {
    v("window_s", window_s, config::Range{0.1, 20.0}, "Length of the window [s]");
    v("period_s", period_s, config::Range{0.005, 1.0},
      "Between solves, and the window's interval; rounded to whole control cycles [s]");
    v("blocking", blocking, "How the noise over the window is blocked");
    v("blocks_count", blocks_count, config::Range{1, 1000}, "Uniform blocks in a full window");
    v("iterations_count", iterations_count, config::Range{1, 50}, "Gauss-Newton steps a solve");
    v("tail_freedom_count", tail_freedom_count, config::kNonNegative,
      "Degrees of freedom of the slip's heavy-tailed (Student's t) changes; 0: Gaussian");
    v("fresh_s", fresh_s, config::kNonNegative,
      "How far back each solve first takes the slip's changes as free, to find steps [s]");
    v("fresh_weight", fresh_weight, config::Range{1e-9, 1.0}, "The weight that frees them");
  }
};

/// The receding-horizon estimator of seed 003 (III-D): over a window of the last seconds it finds
/// the trajectory of pose, drive and slip that fits measurements, motion model and prior best:
///   min |x_0 - x_prior|^2 + sum |y_j - h(x(t_j))|^2_R + sum |x_{b+1} - F_b(x_b, w)|^2_Q
/// over states x_b at the borders of noise blocks, between which speed, turn and slip run as the
/// commands say plus a constant noise w, and the pose by the motion model. Block-tridiagonal
/// Gauss-Newton: linear in the window's length and in the number of blocks. Changes of the slip are
/// heavy-tailed (iteratively reweighted), so that a step is taken for a step. The arrival cost is
/// that of a Kalman filter at the window's begin, which learns of steps from the window. Bounds of
/// the slip by an exterior penalty. Does not allocate in update().
class HorizonEstimator : public Estimator {
 public:
  /// `cycle` [s]: of the updates.
  HorizonEstimator(const Vehicle& vehicle, const EstimationConfig& model,
                   const HorizonEstimatorConfig& config, double cycle);
  ~HorizonEstimator() override;

  void reset(const VehicleState& start, double now) override;
  Estimate update(std::span<const Measurement> measured, const Command& last, double now) override;

  /// Intervals per noise block of a full window, oldest first.
  const std::vector<int>& blocks() const { return block_lengths_; }

 private:
  void restart();
  void advance_base();
  bool solve();
  EstimateVector coasted(EstimateVector state, long from, long to) const;

  EstimationModel model_;
  HorizonEstimatorConfig config_;
  EstimationLog log_;
  int stride_;  // cycles an interval
  int most_;    // intervals in a full window
  std::vector<int> block_lengths_;
  KalmanFilter prior_;  // at the window's begin
  Eigen::Vector3d prior_inflation_ = Eigen::Vector3d::Ones();
  std::unique_ptr<control::internal::EstimationWindow> window_;
  long solved_at_ = 0;  // [cycles]
  EstimateVector newest_ = EstimateVector::Zero();
  EstimateVector variance_ = EstimateVector::Zero();
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::NoiseBlocking> {
  static constexpr std::pair<headland::NoiseBlocking, std::string_view> values[] = {
      {headland::NoiseBlocking::kNone, "none"},
      {headland::NoiseBlocking::kUniform, "uniform"},
      {headland::NoiseBlocking::kStructured, "structured"}};
};
