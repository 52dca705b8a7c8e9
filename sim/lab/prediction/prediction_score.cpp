// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/prediction/prediction_score.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "core/geometry/angle.hpp"
#include "sim/lab/statistics.hpp"

namespace headland {
namespace {

constexpr double kBetweenWindows = 10.0;  // long enough for predictors to forget [s]
constexpr double kAcceleration = 0.3;     // that agents surprise with [m/s2]

}  // namespace

PredictionScorer::PredictionScorer(const WindowShape& shape, double near)
    : shape_(shape), near_m_(near) {}

void PredictionScorer::add(const CrowdWindow& window, Predictor& predictor,
                           RobotForetold foretold) {
  const auto moments = static_cast<std::size_t>(shape_.moments());
  const auto now = static_cast<std::size_t>(shape_.past_steps);
  std::vector<Agent> agents(window.radius_m.size());
  Point2 robot_velocity(0.0, 0.0);
  time_s_ += kBetweenWindows;
  for (std::size_t k = 0; k <= now; ++k) {
    for (std::size_t i = 0; i < agents.size(); ++i) {
      agents[i].id = static_cast<int>(i);
      agents[i].position = window.position[i * moments + k];
      agents[i].velocity = window.velocity[i * moments + k];
      agents[i].radius_m = window.radius_m[i];
    }
    if (k > 0) robot_velocity = (window.robot[k] - window.robot[k - 1]) / shape_.step_s;
    time_s_ += shape_.step_s;
    predictor.observe(agents, window.robot[k], robot_velocity, time_s_);
  }
  std::vector<Point2> path(window.robot.begin() + shape_.past_steps + 1, window.robot.end());
  if (foretold == RobotForetold::kCoasting) {
    for (std::size_t k = 0; k < path.size(); ++k) {
      const double t = static_cast<double>(k + 1) * shape_.step_s;
      path[k] = window.robot[now] + t * robot_velocity;
    }
  }
  predictor.predict(path, shape_.step_s, shape_.future_steps, prediction_);
  for (int row = 0; row < prediction_.agents(); ++row) {
    compare(window, prediction_.ids[static_cast<std::size_t>(row)], prediction_, row);
  }
}

void PredictionScorer::compare(const CrowdWindow& window, int agent, const Prediction& prediction,
                               int row) {
  const auto now = static_cast<std::size_t>(shape_.past_steps);
  const auto first = static_cast<std::size_t>(agent * shape_.moments()) + now;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k <= static_cast<std::size_t>(shape_.future_steps); ++k) {
    nearest = std::min(nearest, (window.position[first + k] - window.robot[now + k]).norm());
  }
  if (!(nearest < near_m_)) return;
  double sum = 0.0;
  double last = 0.0;
  for (int step = 0; step < prediction.steps; ++step) {
    const std::size_t at = prediction.index(row, step);
    const Point2 error =
        window.position[first + 1 + static_cast<std::size_t>(step)] - prediction.mean[at];
    const Eigen::Matrix2d& covariance = prediction.covariance[at];
    const double determinant = covariance.determinant();
    const double square = error.dot(covariance.inverse() * error);
    nll_sum_ += 0.5 * (square + std::log(determinant)) + std::log(2.0 * kPi);
    within_1_ += square < 1.0 ? 1 : 0;
    within_2_ += square < 4.0 ? 1 : 0;
    ++steps_;
    last = error.norm();
    sum += last;
  }
  errors_.push_back(sum / prediction.steps);
  last_errors_.push_back(last);
}

PredictionScore PredictionScorer::score() const {
  PredictionScore score;
  if (errors_.empty()) return score;
  const auto steps = static_cast<double>(steps_);
  score.agents_count = static_cast<int>(errors_.size());
  score.ade_m = summarize(errors_).mean;
  const Statistic last = summarize(last_errors_);
  score.fde_m = last.mean;
  score.fde_p95_m = last.p95.value_or(last.mean);
  score.nll = nll_sum_ / steps;
  score.within_1_ratio = static_cast<double>(within_1_) / steps;
  score.within_2_ratio = static_cast<double>(within_2_) / steps;
  return score;
}

void CoastingPredictor::observe(std::span<const Agent> agents, const Point2&, const Point2&,
                                double) {
  agents_.assign(agents.begin(), agents.end());
}

void CoastingPredictor::predict(std::span<const Point2>, double step_s, int steps,
                                Prediction& prediction) const {
  prediction.step_s = step_s;
  prediction.steps = steps;
  prediction.ids.clear();
  prediction.radius_m.clear();
  prediction.mean.clear();
  prediction.covariance.clear();
  for (const Agent& agent : agents_) {
    prediction.ids.push_back(agent.id);
    prediction.radius_m.push_back(agent.radius_m);
    for (int step = 1; step <= steps; ++step) {
      const double t = step * step_s;
      const double deviation = 0.5 * kAcceleration * t * t;
      prediction.mean.push_back(agent.position + t * agent.velocity);
      prediction.covariance.push_back((deviation * deviation + 1e-4) * Eigen::Matrix2d::Identity());
    }
  }
}

}  // namespace headland
