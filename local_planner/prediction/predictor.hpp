// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/world/agent.hpp"

namespace headland {

/// Where agents will be: a Gaussian in the plane per agent and step.
struct Prediction {
  double step_s = 0.4;                        ///< between the steps
  int steps = 0;                              ///< per agent; step 0 is one step ahead of now
  std::vector<int> ids{};                     ///< of the agents, as observed last
  std::vector<double> radius_m{};             ///< of the agents
  std::vector<Point2> mean{};                 ///< [m, map]: mean[agent * steps + step]
  std::vector<Eigen::Matrix2d> covariance{};  ///< [m2], likewise

  /// Empties it for steps of that length.
  void begin(double step, int count) {
    step_s = step;
    steps = count;
    ids.clear();
    radius_m.clear();
    mean.clear();
    covariance.clear();
  }
  int agents() const { return static_cast<int>(ids.size()); }
  std::size_t index(int agent, int step) const {
    return static_cast<std::size_t>(agent * steps + step);
  }
};

/// How agents move on, given how they moved and what the robot is about to do.
/// One object per robot; not thread-safe. Bad numbers of an agent (not finite) leave it out.
class Predictor {
 public:
  virtual ~Predictor() = default;
  /// A sight of all agents near, at `time_s`; sights come in order of time. Agents that are not
  /// seen for a second are forgotten. `robot` is where the robot is, `robot_velocity` [m/s].
  virtual void observe(std::span<const Agent> agents, const Point2& robot,
                       const Point2& robot_velocity, double time_s) = 0;
  /// All agents of the last sight, `steps` steps of `step_s` [s] on. `robot_path`: the robot's
  /// planned positions at those steps, in `map` (shorter: it stays at the last one; empty: it
  /// stands). `prediction` is overwritten, its buffers reused.
  virtual void predict(std::span<const Point2> robot_path, double step_s, int steps,
                       Prediction& prediction) const = 0;
  /// Whether `robot_path` matters at all: a planner asks once per decision if not.
  virtual bool reacts() const { return false; }
};

}  // namespace headland
