// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/base/random.hpp"
#include "global_planner/tour/internal/itinerary.hpp"
#include "global_planner/tour/internal/route_state.hpp"

namespace headland::tour {

/// The tasks near each task, nearest first, by what ways between them cost.
using NearTasks = std::vector<std::vector<int>>;
NearTasks near_tasks(const Model& model, int count);

/// Routes of all vehicles, with changes that can be taken back, and the cheapest place for a task.
class FleetPlan {
 public:
  struct Place {
    int vehicle = -1;  ///< -1: the task is absent
    int position = 0;
  };
  /// Visits of a route that take the place of others: the task, and visits whose modes change for
  /// it.
  struct Insertion {
    int vehicle = -1;  ///< -1: the task can be put nowhere
    int first = 0;
    int last = 0;
    std::vector<Visit> visits;
    double change = kNever;  ///< of the cost
  };

  FleetPlan(const Model& model, const NearTasks& near);

  const Model& model() const { return model_; }
  int vehicles() const { return static_cast<int>(routes_.size()); }
  const RouteState& route(int vehicle) const { return routes_[static_cast<std::size_t>(vehicle)]; }
  Place place(int task) const { return places_[static_cast<std::size_t>(task)]; }
  bool absent(int task) const { return place(task).vehicle < 0; }
  int used_vehicles() const { return used_; }
  /// No more vehicles than this are put to use.
  void limit_vehicles(int count) { most_vehicles_ = count; }

  /// How much was evaluated: the same on every machine.
  long labels_made() const { return evaluator_.labels_made(); }

  /// What the search minimises: the objective, tasks that must be done and are absent not counted,
  /// and a small share of all finishing times where the span counts. Infinity if the queues at
  /// stations break a window.
  double cost();

  /// The cheapest insertion of an absent task, by exact evaluation of those that look best without
  /// charging; each position is overlooked with probability `blink`.
  Insertion best_insertion(int task, double blink, RandomStream& random);
  bool insert(const Insertion& insertion);
  /// Takes out tasks (all of one vehicle, positions ascending). False, and unchanged, if the rest
  /// cannot be driven.
  bool remove(int vehicle, const std::vector<int>& positions);
  /// Replaces a route as a whole. False, and unchanged, if it cannot be driven.
  bool set_route(int vehicle, const std::vector<Visit>& visits);

  void keep();  ///< all changes since the last keep() or undo()
  void undo();  ///< takes them back

  std::vector<std::vector<Visit>> visits() const;
  void restore(const std::vector<std::vector<Visit>>& visits);

 private:
  struct Candidate {
    double change = 0.0;  // without charging
    int vehicle = 0;
    int position = 0;
    int mode = 0;
  };
  struct Backup {
    int vehicle = 0;
    RouteState route;
    std::optional<Itinerary> itinerary;
  };

  void collect(int task, double blink, RandomStream& random);
  void collect_at(const RouteState& route, int vehicle, int position, int task);
  void try_candidates(int task, Insertion& best);
  bool try_edit(int vehicle, const RouteEdit& edit, Insertion& best);
  void try_new_routes(int task, Insertion& best);
  double change_of(const RouteState& route, const RouteOutcome& outcome) const;
  double search_value(double value, double finish_s) const {
    return value + finish_price_ * finish_s;
  }
  double latest_finish() const;
  std::optional<double> queued_cost();
  bool edit(int vehicle, const RouteEdit& change);
  void touch(int vehicle);
  void index(int vehicle);

  const Model& model_;
  const NearTasks& near_;
  RouteEvaluator evaluator_;
  std::vector<int> kind_of_;  // of each vehicle
  std::vector<RouteState> routes_;
  std::vector<std::optional<Itinerary>> itineraries_;  // where vehicles queue; empty: to be made
  std::vector<Place> places_;
  int used_ = 0;
  int most_vehicles_;
  double finish_price_ = 0.0;  // of each vehicle's finishing time, where the span counts
  double span_ = 0.0;          // latest finish when the insertion search began
  std::vector<Backup> backups_;
  std::size_t backup_count_ = 0;
  std::vector<Candidate> candidates_;
  std::vector<Visit> edit_visits_;
};

}  // namespace headland::tour
