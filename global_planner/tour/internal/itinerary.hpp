// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "global_planner/tour/internal/labels.hpp"
#include "global_planner/tour/internal/model.hpp"

namespace headland::tour {

/// A visit, or a charge up to some energy.
struct ItineraryItem {
  Visit visit{-1, 0};  ///< task -1: a charge
  int station = -1;
  double leave_j = 0.0;  ///< charged up to; less than on arrival: nothing is charged
};

/// What one vehicle does, in order. Times follow from it, and from who else charges where.
struct Itinerary {
  int kind = 0;
  std::vector<ItineraryItem> items;
};

/// The cheapest way to do these tasks in this order: which stations, how much to charge. Nothing
/// if it cannot be done.
std::optional<Itinerary> best_itinerary(const Model& model, Crossing& crossing, int kind,
                                        const std::vector<Visit>& visits);

/// Drives all itineraries, the i-th by `vehicles[i]`. Vehicles queue where all slots are taken: who
/// comes first charges first, of two at the same time the one with the lower index. Nothing if a
/// window or deadline breaks for the waiting.
std::optional<std::vector<TourRoute>> drive_fleet(const Model& model,
                                                  const std::vector<int>& vehicles,
                                                  const std::vector<Itinerary>& itineraries);

/// The problem's objective: of these routes, with all other tasks' rewards lost.
double objective(const TourProblem& problem, const std::vector<TourRoute>& routes);

}  // namespace headland::tour
