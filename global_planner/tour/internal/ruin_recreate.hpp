// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "core/base/random.hpp"
#include "global_planner/tour/internal/fleet_plan.hpp"

namespace headland::tour {

/// Slack induction by string removals (Christiaens and Vanden Berghe 2020): strings of neighbouring
/// visits are taken out of some routes and put back greedily, with blinks, under simulated
/// annealing; vehicles are saved by the sum of absences. Charging is evaluated exactly.
class RuinRecreate {
 public:
  struct Control {
    std::function<bool()> stop;
    std::function<void(double fraction, double best_cost)> progress;
  };

  RuinRecreate(const Model& model, const NearTasks& near, FleetPlan& plan, std::uint64_t seed,
               const Control& control);

  /// Inserts all absent tasks that can be.
  void construct();
  /// No task that must be done is absent.
  bool complete() const { return missing().empty(); }
  /// Tries to place every task that must be done, in this many rounds. True if that is so.
  bool place_all(long rounds);
  /// Tries to do without one vehicle after the other, in this many rounds each.
  void save_vehicles(long rounds);
  /// Anneals from the present plan, for so many rounds or labels, whichever ends first; ends with
  /// the best found. Returns the rounds made.
  long anneal(long rounds, long labels);

  bool stopped() const { return stopped_; }
  /// Rounds that will be made in all, for the progress.
  void expect(long rounds) { expected_ = rounds; }

 private:
  enum class Order { kRandom, kDemand, kFar, kClose, kReward, kEarly, kNarrow };

  void ruin();
  void remove_string(int task, int length);
  void recreate(double blink);
  void sort_absent();
  double distance(int task) const { return distance_[static_cast<std::size_t>(task)]; }
  std::vector<int> missing() const;
  double absences(const std::vector<int>& tasks) const;
  bool poll();
  int cheapest_to_save() const;

  const Model& model_;
  const NearTasks& near_;
  FleetPlan& plan_;
  RandomStream random_;
  const Control& control_;
  std::vector<double> distance_;    // from the start
  std::vector<long> absent_count_;  // how often each task stayed out
  std::vector<int> absent_;
  bool stopped_ = false;
  long rounds_ = 0;
  long expected_ = 1;
  double best_cost_ = kNever;
};

}  // namespace headland::tour
