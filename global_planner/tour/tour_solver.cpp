// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/tour_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "global_planner/tour/internal/bounds.hpp"
#include "global_planner/tour/internal/completion_bound.hpp"
#include "global_planner/tour/internal/exact_search.hpp"
#include "global_planner/tour/internal/impossible.hpp"
#include "global_planner/tour/internal/itinerary.hpp"
#include "global_planner/tour/internal/order.hpp"
#include "global_planner/tour/internal/ruin_recreate.hpp"

namespace headland {
namespace {

using tour::FleetPlan;
using tour::Itinerary;
using tour::Model;
using tour::PlannedRoute;
using tour::RuinRecreate;
using tour::Visit;

constexpr int kNearTasks = 100;
constexpr int kMostExactTasks = 18;        // 2^n sets are kept
constexpr long kExactEffort = 60'000'000;  // labels
constexpr long kRoundsForExact = 2'000;    // of ruin and recreate, for the upper bound
constexpr long kFirstAnneal = 20'000;

struct Candidate {
  std::vector<TourRoute> routes;
  double cost = kNever;
};

// Routes with their charges and times; nothing if queues at stations break a window.
std::optional<Candidate> schedule(const Model& model, const std::vector<PlannedRoute>& routes) {
  std::vector<tour::Crossing> crossings;
  for (int k = 0; k < static_cast<int>(model.kinds().size()); ++k) {
    crossings.emplace_back(model, k, true);
  }
  std::vector<std::size_t> used(model.kinds().size(), 0);
  std::vector<int> vehicles;
  std::vector<Itinerary> itineraries;
  for (const PlannedRoute& route : routes) {
    const auto kind = static_cast<std::size_t>(route.kind);
    auto itinerary = tour::best_itinerary(model, crossings[kind], route.kind, route.visits);
    if (!itinerary) return {};
    vehicles.push_back(model.kind(route.kind).members[used[kind]++]);
    itineraries.push_back(std::move(*itinerary));
  }
  auto driven = tour::drive_fleet(model, vehicles, itineraries);
  if (!driven) return {};
  const double cost = tour::objective(model.problem(), *driven);
  return Candidate{std::move(*driven), cost};
}

std::vector<PlannedRoute> routes_of(const FleetPlan& plan) {
  std::vector<PlannedRoute> routes;
  for (int v = 0; v < plan.vehicles(); ++v) {
    const auto& route = plan.route(v);
    if (!route.visits.empty()) routes.push_back({route.kind, route.visits});
  }
  return routes;
}

}  // namespace
}  // namespace headland
