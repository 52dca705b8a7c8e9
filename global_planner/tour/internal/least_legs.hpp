// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "global_planner/tour/tour_problem.hpp"

namespace headland::tour {

/// What each way and each work takes at least of something additive, by any vehicle: the least over
/// all their profiles, straight or by way of stations. Never more than what a solution takes.
class LeastLegs {
 public:
  /// `value` of a leg that exists; may be negative.
  LeastLegs(const TourProblem& problem, const std::function<double(const TourLeg&)>& value);

  double way(int from, int to) const {
    return ways_[static_cast<std::size_t>(from) * sites_ + static_cast<std::size_t>(to)];
  }
  double work(int task, int mode) const {
    return work_[static_cast<std::size_t>(task)][static_cast<std::size_t>(mode)];
  }
  /// False where going round between stations gains without end: then there is no least.
  bool bounded() const { return bounded_; }

 private:
  void add_profile(const TourProblem& problem, int profile,
                   const std::function<double(const TourLeg&)>& value);

  std::size_t sites_;
  std::vector<double> ways_;
  std::vector<std::vector<double>> work_;
  bool bounded_ = true;
};

}  // namespace headland::tour
