// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "global_planner/tour/internal/model.hpp"

namespace headland::tour {

/// What the rest of a plan costs at least, if one route is at hand and some tasks are done: each
/// other task is left out, or reached by its cheapest way and worked; each route reaches its
/// finish.
class CompletionBound {
 public:
  explicit CompletionBound(const Model& model);

  /// `kind` of the route at hand, `mask` of the tasks done.
  double rest(int kind, unsigned mask) const {
    double sum = finish_[static_cast<std::size_t>(kind)] + others_;
    for (std::size_t t = 0; t < task_.size(); ++t) {
      if (!(mask >> t & 1U)) sum += task_[t];
    }
    return sum;
  }
  /// With no route at hand: a bound on the whole problem.
  double whole() const;

 private:
  std::vector<double> finish_;  // of each kind: the cheapest way to its finish
  std::vector<double> task_;
  double others_ = 0.0;  // what all other vehicles may gain, by ways of negative cost (<= 0)
};

}  // namespace headland::tour
