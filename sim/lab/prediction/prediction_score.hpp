// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>

#include "local_planner/prediction/predictor.hpp"
#include "sim/lab/prediction/crowd_windows.hpp"

namespace headland {

/// What a predictor is told of the robot's next positions.
enum class RobotForetold : std::int8_t {
  kPlan,     ///< those that it will take
  kCoasting  ///< on at its present velocity: the prediction is not conditioned on the plan
};

/// Errors of predictions, over agents and windows.
struct PredictionScore {
  int agents_count = 0;
  double ade_m = 0.0;           ///< mean over agents of the mean over steps of the error
  double fde_m = 0.0;           ///< mean error at the last step
  double fde_p95_m = 0.0;       ///< 95th percentile of that
  double nll = 0.0;             ///< mean negative logarithm of the predicted density, per step
  double within_1_ratio = 0.0;  ///< truths within one deviation; a Gaussian has 0.393
  double within_2_ratio = 0.0;  ///< two: 0.865
};

/// Shows a window's past to a predictor and compares what it says with what came. Counts only
/// agents that come within `near` [m] of the robot between now and the last step.
class PredictionScorer {
 public:
  PredictionScorer(const WindowShape& shape, double near = std::numeric_limits<double>::infinity());

  void add(const CrowdWindow& window, Predictor& predictor, RobotForetold foretold);
  PredictionScore score() const;

 private:
  void compare(const CrowdWindow& window, int agent, const Prediction& prediction, int row);

  WindowShape shape_;
  double near_m_;
  Prediction prediction_;
  std::vector<double> errors_;  // mean of an agent
  std::vector<double> last_errors_;
  double nll_sum_ = 0.0;
  double time_s_ = 0.0;
  long steps_ = 0;
  long within_1_ = 0;
  long within_2_ = 0;
};

/// All agents go on as they were last seen, with a deviation that grows as an acceleration of
/// 0.3 m/s2 would have it: the yardstick of predictors.
class CoastingPredictor : public Predictor {
 public:
  void observe(std::span<const Agent> agents, const Point2& robot, const Point2& robot_velocity,
               double time_s) override;
  void predict(std::span<const Point2> robot_path, double step_s, int steps,
               Prediction& prediction) const override;

 private:
  std::vector<Agent> agents_;
};

}  // namespace headland
