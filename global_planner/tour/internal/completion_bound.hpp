// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "global_planner/tour/internal/model.hpp"

namespace headland::tour {

/// What the rest of a plan costs at least. Each task is left out, reached from another one, or is
/// the first of a route; with a price on leaving each task these choices are independent, and the
/// prices that make their sum greatest are sought by subgradient steps (as in Held and Karp 1970,
/// on arcs). Chargers may be passed between any two tasks; batteries are not looked at.
class CompletionBound {
 public:
  explicit CompletionBound(const Model& model);

  /// With nothing done yet: a bound on the whole problem, but for what the span costs.
  double whole() const { return whole_; }

  /// A route of this kind has ended the work of `last` at `time_s`; the tasks in `mask` are done.
  /// At least this is to be paid beyond the route's cost so far.
  double rest(int kind, Visit last, double time_s, unsigned mask) const;

 private:
  using Matrix = std::vector<std::vector<double>>;

  void add_kind(int kind);
  void find_prices();
  double relax(std::vector<int>& leavings);
  bool reachable(int kind, Visit last, double time_s, int task) const;

  const Model& model_;
  int tasks_;
  Matrix arc_;                    // task, task: cheapest way and work
  Matrix first_;                  // kind, task: fixed cost, way and work of a route's first task
  Matrix finish_;                 // kind, task: cheapest way to the finish
  std::vector<Matrix> way_time_;  // kind: exit (visit), entry (visit): shortest, by any sites
  std::vector<int> first_visit_;  // of each task, among all visits
  std::vector<double> price_;     // for leaving a task
  std::vector<double> arrival_;   // least of a task's arrival and its own price, or its reward
  std::vector<double> first_arrival_;    // as the first of a route
  std::vector<double> cheapest_finish_;  // of each kind, less the price of the task left
  double whole_ = 0.0;
};

}  // namespace headland::tour
