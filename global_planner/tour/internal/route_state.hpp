// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "global_planner/tour/internal/labels.hpp"
#include "global_planner/tour/internal/model.hpp"

namespace headland::tour {

/// A route with the labels after each of its visits, so that a change is evaluated from where it
/// begins to where its effect ends.
struct RouteState {
  /// A label set, stored relative to its least cost (and, without windows, its least time), so that
  /// sets which differ only by these are seen to be the same.
  struct Cell {
    int first_label = 0;
    int labels = 0;
    int first_point = 0;
    int points = 0;
    double cost = 0.0;
    double time_s = 0.0;
    double earliest_s = 0.0;  ///< of all labels, not relative
  };

  int kind = 0;
  std::vector<Visit> visits;
  std::vector<Cell> cells;  ///< at the start, after each visit, at the finish
  std::vector<Label> labels;
  std::vector<CurvePoint> points;
  /// On arrival at each visit (and the finish): energy needed, and latest time allowed, to finish
  /// without any station.
  std::vector<double> need_j;
  std::vector<double> latest_s;
  /// The price of the ways and works before and from each visit on, by its mode, if all other
  /// visits take their best modes (Vidal 2017: choices of mode by dynamic programming over a given
  /// order). Empty where every task has one mode.
  std::vector<double> until_mode;
  std::vector<double> from_mode;
  double price = 0.0;  ///< of all ways and works, as they are
  double load = 0.0;
  double value = 0.0;     ///< its part of the objective, but for the span
  double finish_s = 0.0;  ///< [s]

  int size() const { return static_cast<int>(visits.size()); }
};

/// Visits from `first` up to (not with) `last` are replaced.
struct RouteEdit {
  int first = 0;
  int last = 0;
  std::span<const Visit> visits;
};

/// What becomes of a route.
struct RouteOutcome {
  double value = 0.0;
  double finish_s = 0.0;
};

class RouteEvaluator {
 public:
  explicit RouteEvaluator(const Model& model);

  /// A route without visits; it costs nothing.
  RouteState empty_route(int kind) const;
  /// What an edit would lead to; nothing if the route cannot be driven any more.
  std::optional<RouteOutcome> evaluate(const RouteState& route, const RouteEdit& edit);
  /// The insertion of a visit at a position, with the modes of all other visits that are best for
  /// it, batteries and windows not looked at: the change of price, and the edit (its visits are
  /// stored in `visits`).
  double price_of_insertion(const RouteState& route, int position, Visit visit) const;
  RouteEdit insertion(const RouteState& route, int position, Visit visit,
                      std::vector<Visit>& visits) const;
  /// Makes the edit. False, with the route unchanged, if it cannot be driven any more.
  bool apply(RouteState& route, const RouteEdit& edit);
  Crossing& crossing(int kind) { return crossings_[static_cast<std::size_t>(kind)]; }
  long labels_made() const;

 private:
  struct Base {
    double cost = 0.0;
    double time_s = 0.0;
    double earliest_s = 0.0;  ///< of all labels, not relative
  };

  std::optional<RouteOutcome> propagate(const RouteState& route, const RouteEdit& edit,
                                        RouteState* result);
  std::optional<RouteOutcome> outcome(int kind, const Base& base) const;
  std::optional<RouteOutcome> shifted(const RouteState& route, const Base& shift);
  Base normalise(LabelSet& set) const;
  bool same(const RouteState& route, const RouteState::Cell& cell) const;
  void load(const RouteState& route, const RouteState::Cell& cell);
  void store(RouteState& route, const Base& base) const;
  void look_ahead(RouteState& route);
  void price_modes(RouteState& route) const;
  int best_before(const RouteState& route, int position, int entry, double& price) const;
  int best_behind(const RouteState& route, int position, int exit, double& price) const;
  void look_ahead(const RouteState& route, const RouteEdit& edit);

  const Model& model_;
  std::vector<Crossing> crossings_;  // of each kind
  LabelSet set_;                     // at hand, normalised
  LabelSet arrived_;
  RouteState scratch_;
  std::vector<Crossing::Outlook> outlooks_;  // of the edit at hand
};

}  // namespace headland::tour
