// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "control/estimation/kalman_filter.hpp"
#include "core/model/command_delay.hpp"

namespace headland {

/// What an estimator has been told and not yet forgotten: measurements by their time, and the
/// command that acted in every cycle. Times count in cycles since the start; a base, which only
/// advances, separates what is forgotten. Does not allocate after construction.
class EstimationLog {
 public:
  /// Keeps at least the last `span` [s].
  EstimationLog(const Vehicle& vehicle, double cycle, double span);

  void reset(double now);
  /// Moves on to `now` [s], the last command acting meanwhile after its dead time, and sorts the
  /// measurements in. One from the future or that is no number is refused, one older than the base
  /// is late. A command that is no number counts as a stop, a time that is none as no progress.
  void take(std::span<const Measurement> measured, const Command& last, double now);
  /// Forgets what is older than cycle `base`.
  void forget_before(long base);

  double cycle() const { return cycle_; }  ///< [s]
  long now() const { return now_; }        ///< [cycles]
  long base() const { return base_; }      ///< [cycles]
  double time(long cycles) const { return start_ + static_cast<double>(cycles) * cycle_; }  ///< [s]
  const Command& acting(long cycle) const;  ///< in the cycle that begins there
  /// By time, oldest first; of one time, by kind: the order of arrival does not matter.
  std::span<const Measurement> measurements() const {
    return {measurements_.data() + first_, measurements_.size() - first_};
  }
  double last_position() const { return last_position_; }  ///< when the newest was true [s]
  int late_count() const { return late_; }
  int refused_count() const { return refused_; }

  /// Takes a filter that stands at the base to cycle `to`, through all measurements until then.
  void replay(KalmanFilter& filter, long to,
              const Eigen::Vector3d& inflation = Eigen::Vector3d::Ones()) const;

 private:
  void sort_in(const Measurement& measurement);

  double cycle_;
  CommandDelay delay_;
  std::vector<Command> acting_;  // a ring by cycle
  std::vector<Measurement> measurements_;
  std::size_t first_ = 0;
  double start_ = 0.0;  // [s]
  long now_ = 0;
  long base_ = 0;
  double last_position_ = 0.0;
  int late_ = 0;
  int refused_ = 0;
};

}  // namespace headland
