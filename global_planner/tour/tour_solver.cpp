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
#include "global_planner/tour/internal/least_legs.hpp"
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
constexpr std::size_t kLongestExactRoute = 100;
// Where routes are long a round takes more labels; anneals get shorter for it.
constexpr long kLabelsPerRound = 4'000;
constexpr int kMostParts = 12;
constexpr int kMostPricedTasks = 200;
constexpr long kRoundsForExact = 2'000;  // of ruin and recreate, for the upper bound
constexpr long kFirstAnneal = 20'000;
constexpr long kFirstRowAnneal = 500;  // from a good order

struct Candidate {
  std::vector<TourRoute> routes;
  double cost = kNever;
};

// Routes with their charges and times; nothing if queues at stations break a window.
std::optional<Candidate> schedule(const Model& model, const std::vector<PlannedRoute>& routes,
                                  tour::Crossing::Effort effort) {
  std::vector<tour::Crossing> crossings;
  for (int k = 0; k < static_cast<int>(model.kinds().size()); ++k) {
    crossings.emplace_back(model, k, effort);
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

// The search as a whole: what is impossible, a first plan, its improvement, and the exact search
// for few tasks.
class Search {
 public:
  Search(const TourProblem& problem, const TourOptions& options)
      : problem_(problem), options_(options), model_(problem) {}

  Result<TourSolution> solve() {
    for (int t = 0; t < model_.tasks(); ++t) {
      if (model_.task(t).reward < kNever) continue;
      if (auto error = tour::why_impossible(model_, t)) return tl::unexpected(*error);
    }
    if (model_.tasks() <= kMostPricedTasks) bound_ = tour::CompletionBound(model_).whole();
    if (!exact()) raise_bound();
    if (model_.tasks() == 0) offer({});
    if (!best_ && !solve_as_order()) search();
    if (!best_) return nothing_found();
    if (exact() && !proven()) raise_bound();
    return answer();
  }

 private:
  void raise_bound() { bound_ = std::max(bound_, tour::lower_bound(problem_, options_.stop)); }
  bool proven() const {
    return best_ && bound_ >= best_->cost - 1e-9 * std::abs(best_->cost) - model_.cost_slack();
  }
  bool one_vehicle() const { return problem_.vehicles.size() == 1; }
  bool exact() const {
    return model_.tasks() <= std::min(options_.exact_up_to_tasks, kMostExactTasks);
  }

  // One vehicle: the order that would be best without limits; done if it is the problem's answer.
  bool solve_as_order() {
    const bool optional = std::any_of(problem_.tasks.begin(), problem_.tasks.end(),
                                      [](const TourTask& t) { return t.reward < kNever; });
    if (!one_vehicle()) return false;
    const TourVehicle& vehicle = problem_.vehicles.front();
    const bool limited = optional || std::isfinite(vehicle.battery_j) || model_.windows() ||
                         vehicle.latest_s < kNever || vehicle.load_capacity < kNever;
    if (limited && exact()) return false;
    const auto order = tour::solve_order(problem_, options_);
    if (!order) return false;
    for (const auto& [task, mode] : order->visits) order_.push_back({task, mode});
    if (limited) {
      // Limits only add to it, unless a station shortens a way.
      if (!optional && ways_are_least()) bound_ = std::max(bound_, order->lower_bound);
      return false;
    }
    offer({{0, order_}});
    bound_ = std::max(bound_, order->lower_bound);
    return best_.has_value();
  }

  // No way is cheaper by a station than straight.
  bool ways_are_least() const {
    const auto price = [this](const TourLeg& leg) { return model_.price(leg); };
    const tour::LeastLegs least(problem_, price);
    if (!least.bounded()) return false;
    const double slack = model_.cost_slack();
    for (int from = 0; from < problem_.sites; ++from) {
      for (int to = 0; to < problem_.sites; ++to) {
        const TourLeg& way = problem_.way(problem_.vehicles.front().profile, from, to);
        if (from != to && least.way(from, to) < price(way) - slack) return false;
      }
    }
    return true;
  }

  void search() {
    const tour::NearTasks near = tour::near_tasks(model_, kNearTasks);
    FleetPlan plan(model_, near);
    const RuinRecreate::Control control{options_.stop, options_.progress};
    RuinRecreate search(model_, near, plan, options_.seed, control);
    const long rounds = budget();
    search.expect(2 * rounds);
    start(plan, search);
    if (!search.place_all(rounds)) {
      find_exactly();
      return;
    }
    offer(routes_of(plan));
    if (exact()) {
      search.save_vehicles(kRoundsForExact / 4);
      search.anneal(kRoundsForExact, kLabelsPerRound * kRoundsForExact);
      offer(routes_of(plan));
      if (find_exactly()) return;
    }
    // Ever longer anneals, so that one may end at any time.
    const long first = rows() ? std::max(kFirstRowAnneal, usual_budget() / 16)
                              : std::max(kFirstAnneal, usual_budget() / 8);
    long length = std::min(rounds, first);
    for (long left = rounds; left > 0 && !search.stopped() && !proven(); length *= 2) {
      if (left / 2 < length) length = left;
      search.save_vehicles(length / 4);
      const long made = search.anneal(length, kLabelsPerRound * length);
      left -= options_.iterations > 0 ? made : length;
      offer(routes_of(plan));
    }
  }

  long budget() const {
    if (options_.iterations > 0) return options_.iterations;
    return usual_budget();
  }
  // A first plan: the order that is best for one vehicle, in equal parts for each number of
  // vehicles (route first, cluster second; Beasley 1983), or, where there is none, greedy
  // insertion.
  void start(FleetPlan& plan, RuinRecreate& search) {
    if (order_.empty() && model_.most_modes() > 1 && !model_.windows()) order_ = common_order();
    double least = kNever;
    std::vector<std::vector<Visit>> best;
    for (int parts = 1; !order_.empty() && parts <= std::min(plan.vehicles(), kMostParts);
         ++parts) {
      set_parts(plan, parts);
      search.construct();
      const double cost = search.complete() ? plan.cost() : kNever;
      if (cost >= least) continue;
      least = cost;
      best = plan.visits();
    }
    plan.restore(std::vector<std::vector<Visit>>(static_cast<std::size_t>(plan.vehicles())));
    if (least < kNever) {
      plan.restore(best);
    } else {
      search.construct();
    }
  }

  std::vector<Visit> common_order() const {
    TourProblem single = problem_;
    single.vehicles.resize(1);
    std::vector<Visit> visits;
    if (const auto order = tour::solve_order(single, options_)) {
      for (const auto& [task, mode] : order->visits) visits.push_back({task, mode});
    }
    return visits;
  }

  // Consecutive parts of equal price; what its vehicle cannot load is left to be inserted.
  void set_parts(FleetPlan& plan, int parts) const {
    std::vector<double> price{0.0};  // up to each visit of the order
    int site = model_.kind(0).vehicle.start;
    for (const Visit visit : order_) {
      price.push_back(price.back() + model_.price(model_.way(0, site, model_.mode(visit).entry)) +
                      model_.price(model_.work(0, visit)));
      site = model_.mode(visit).exit;
    }
    std::vector<std::vector<Visit>> visits(static_cast<std::size_t>(parts));
    std::vector<double> load(visits.size(), 0.0);
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const double share = price[i + 1] / std::max(price.back(), 1e-12);
      const auto part = static_cast<std::size_t>(
          std::clamp(static_cast<int>(share * parts - 1e-9), 0, parts - 1));
      const double demand = model_.task(order_[i].task).demand;
      if (load[part] + demand > problem_.vehicles[part].load_capacity) continue;
      load[part] += demand;
      visits[part].push_back(order_[i]);
    }
    visits.resize(static_cast<std::size_t>(plan.vehicles()));
    plan.restore(visits);
  }

  bool rows() const { return model_.most_modes() > 1 && !model_.windows(); }
  // Rows start from an order that is best but for charges and shares, and need little more.
  long usual_budget() const {
    if (!rows()) return 20'000 + 400L * model_.tasks();
    return one_vehicle() ? 2'000 + 20L * model_.tasks() : 5'000 + 100L * model_.tasks();
  }

  // True if the best is proven.
  bool find_exactly() {
    if (!exact()) return false;
    const double above = best_ ? best_->cost + model_.cost_slack() : kNever;
    const auto found = tour::exact_search(model_, {above, kExactEffort, options_.stop});
    if (!found.complete) return false;
    if (!found.routes.empty() || found.cost < above) offer(found.routes);
    bound_ = std::max(bound_, std::min(found.cost, best_ ? best_->cost : kNever));
    return best_.has_value();
  }

  void offer(const std::vector<PlannedRoute>& routes) {
    for (const auto effort : {tour::Crossing::Effort::kThrifty, tour::Crossing::Effort::kExact}) {
      if (effort == tour::Crossing::Effort::kExact && !short_enough(routes)) continue;
      auto candidate = schedule(model_, routes, effort);
      if (candidate && (!best_ || candidate->cost < best_->cost)) best_ = std::move(candidate);
    }
  }

  // Exact charging of a long route may take too long.
  static bool short_enough(const std::vector<PlannedRoute>& routes) {
    return std::all_of(routes.begin(), routes.end(), [](const PlannedRoute& route) {
      return route.visits.size() <= kLongestExactRoute;
    });
  }

  tl::unexpected<Error> nothing_found() const {
    return fail(ErrorCode::kTaskDoesNotFit, "no plan was found that does all tasks",
                "let tasks be left out, or give more vehicles or time");
  }

  TourSolution answer() const {
    TourSolution solution;
    solution.routes = best_->routes;
    solution.cost = best_->cost;
    std::vector<char> done(problem_.tasks.size(), 0);
    for (const TourRoute& route : solution.routes) {
      for (const TourStop& stop : route.stops) {
        if (stop.task >= 0) done[static_cast<std::size_t>(stop.task)] = 1;
      }
    }
    for (int t = 0; t < model_.tasks(); ++t) {
      if (done[static_cast<std::size_t>(t)]) continue;
      const auto impossible = tour::why_impossible(model_, t);
      solution.dropped.push_back(
          {t, impossible ? impossible->what : "costs more than it is worth beside the others"});
    }
    solution.lower_bound = std::min(bound_, solution.cost);
    solution.optimal = proven();
    return solution;
  }

  const TourProblem& problem_;
  const TourOptions& options_;
  Model model_;
  std::vector<Visit> order_;  // for a single vehicle: the order that is best without limits
  std::optional<Candidate> best_;
  double bound_ = -kNever;
};

}  // namespace

Result<TourSolution> solve_tour(const TourProblem& problem, const TourOptions& options) {
  return Search(problem, options).solve();
}

}  // namespace headland
