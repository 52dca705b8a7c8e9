// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/fleet_plan.hpp"

#include <algorithm>
#include <cmath>

namespace headland::tour {
namespace {

constexpr std::size_t kFirstTries = 4;  // insertions evaluated exactly
constexpr std::size_t kMostTries = 16;  // while none of them can be driven
constexpr int kAllPositionsUpTo = 150;  // tasks; above, only beside near tasks
constexpr double kFinishShare = 0.1;    // of the span's price, for all finishes together

}  // namespace

NearTasks near_tasks(const Model& model, int count) {
  const int n = model.tasks();
  const auto between = [&](int a, int b) {
    double least = kNever;
    for (int i = 0; i < model.modes(a); ++i) {
      for (int j = 0; j < model.modes(b); ++j) {
        const TourLeg& leg = model.way(0, model.mode({a, i}).exit, model.mode({b, j}).entry);
        least = std::min(least, leg.cost + (1e-9 + model.duration_price()) * leg.duration_s +
                                    1e-9 * leg.energy_j);
      }
    }
    return least;
  };
  NearTasks near(static_cast<std::size_t>(n));
  std::vector<std::pair<double, int>> others;
  for (int a = 0; a < n; ++a) {
    others.clear();
    for (int b = 0; b < n; ++b) {
      if (b != a) others.push_back({std::min(between(a, b), between(b, a)), b});
    }
    const auto keep = std::min<std::size_t>(others.size(), static_cast<std::size_t>(count));
    std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(keep),
                      others.end());
    for (std::size_t i = 0; i < keep; ++i) {
      near[static_cast<std::size_t>(a)].push_back(others[i].second);
    }
  }
  return near;
}

FleetPlan::FleetPlan(const Model& model, const NearTasks& near)
    : model_(model),
      near_(near),
      evaluator_(model),
      kind_of_(model.problem().vehicles.size()),
      places_(static_cast<std::size_t>(model.tasks())),
      most_vehicles_(static_cast<int>(model.problem().vehicles.size())) {
  for (int k = 0; k < static_cast<int>(model.kinds().size()); ++k) {
    for (const int v : model.kind(k).members) kind_of_[static_cast<std::size_t>(v)] = k;
  }
  for (const int kind : kind_of_) routes_.push_back(evaluator_.empty_route(kind));
  itineraries_.resize(routes_.size());
  const auto fleet = static_cast<double>(routes_.size());
  if (routes_.size() > 1) finish_price_ = kFinishShare * model.problem().span_weight / fleet;
}

double FleetPlan::latest_finish() const {
  double latest = 0.0;
  for (const RouteState& route : routes_) {
    if (!route.visits.empty()) latest = std::max(latest, route.finish_s);
  }
  return latest;
}

double FleetPlan::cost() {
  double sum = 0.0;
  for (const RouteState& route : routes_) {
    if (!route.visits.empty()) sum += search_value(route.value, route.finish_s);
  }
  for (int t = 0; t < model_.tasks(); ++t) {
    if (absent(t) && model_.task(t).reward < kNever) sum += model_.task(t).reward;
  }
  if (model_.problem().span_weight > 0.0) sum += model_.problem().span_weight * latest_finish();
  if (!model_.may_queue()) return sum;
  const std::optional<double> waits = queued_cost();
  return waits ? sum + *waits : kNever;
}

// What waiting at stations adds to durations and span; nothing if it breaks a window.
std::optional<double> FleetPlan::queued_cost() {
  std::vector<int> vehicles;
  std::vector<Itinerary> itineraries;
  for (int v = 0; v < this->vehicles(); ++v) {
    const RouteState& r = route(v);
    if (r.visits.empty()) continue;
    auto& itinerary = itineraries_[static_cast<std::size_t>(v)];
    if (!itinerary)
      itinerary = best_itinerary(model_, evaluator_.crossing(r.kind), r.kind, r.visits);
    if (!itinerary) return {};
    vehicles.push_back(v);
    itineraries.push_back(*itinerary);
  }
  const auto driven = drive_fleet(model_, vehicles, itineraries);
  if (!driven) return {};
  double waits = 0.0;
  double latest = 0.0;
  for (const TourRoute& r : *driven) {
    waits += (model_.problem().duration_weight + finish_price_) *
             (r.finish_s - route(r.vehicle).finish_s);
    latest = std::max(latest, r.finish_s);
  }
  return waits + model_.problem().span_weight * (latest - latest_finish());
}

double FleetPlan::change_of(const RouteState& route, const RouteOutcome& outcome) const {
  const double before = route.visits.empty() ? 0.0 : search_value(route.value, route.finish_s);
  return search_value(outcome.value, outcome.finish_s) - before +
         model_.problem().span_weight * std::max(0.0, outcome.finish_s - span_);
}

FleetPlan::Insertion FleetPlan::best_insertion(int task, double blink, RandomStream& random) {
  span_ = model_.problem().span_weight > 0.0 ? latest_finish() : 0.0;
  candidates_.clear();
  collect(task, blink, random);
  Insertion best;
  try_candidates(task, best);
  if (used_ < most_vehicles_) try_new_routes(task, best);
  return best;
}

void FleetPlan::collect(int task, double blink, RandomStream& random) {
  const auto seen = [&] { return blink <= 0.0 || random.uniform() >= blink; };
  if (model_.tasks() > kAllPositionsUpTo) {
    for (const int other : near_[static_cast<std::size_t>(task)]) {
      const Place at = place(other);
      if (at.vehicle < 0) continue;
      const RouteState& r = route(at.vehicle);
      if (seen()) collect_at(r, at.vehicle, at.position, task);
      if (seen()) collect_at(r, at.vehicle, at.position + 1, task);
    }
    if (!candidates_.empty()) return;
  }
  for (int v = 0; v < vehicles(); ++v) {
    const RouteState& r = route(v);
    if (r.visits.empty()) continue;
    if (r.load + model_.task(task).demand > model_.kind(r.kind).vehicle.load_capacity) continue;
    for (int position = 0; position <= r.size(); ++position) {
      if (seen()) collect_at(r, v, position, task);
    }
  }
}

// A candidate for each mode, unless load or times forbid it without looking at the battery.
void FleetPlan::collect_at(const RouteState& route, int vehicle, int position, int task) {
  const VehicleKind& kind = model_.kind(route.kind);
  const TourTask& t = model_.task(task);
  if (route.load + t.demand > kind.vehicle.load_capacity) return;
  const auto p = static_cast<std::size_t>(position);
  const int from = position == 0 ? kind.vehicle.start : model_.mode(route.visits[p - 1]).exit;
  const int to =
      position == route.size() ? kind.vehicle.finish : model_.mode(route.visits[p]).entry;
  for (int mode = 0; mode < model_.modes(task); ++mode) {
    const TourMode& m = model_.mode({task, mode});
    const TourLeg& there = model_.way(route.kind, from, m.entry);
    const TourLeg& work = model_.work(route.kind, {task, mode});
    const TourLeg& onward = model_.way(route.kind, m.exit, to);
    if (model_.windows() && kind.detours_never_pay) {
      const double arrival = route.cells[p].earliest_s + there.duration_s;
      if (arrival > t.latest_s + model_.time_slack()) continue;
      const double done = std::max(arrival, t.earliest_s) + work.duration_s + onward.duration_s;
      if (done > route.latest_s[p]) continue;
    }
    const Visit visit{task, mode};
    const double change = model_.most_modes() > 1
                              ? evaluator_.price_of_insertion(route, position, visit)
                              : model_.price(there) + model_.price(work) + model_.price(onward) -
                                    model_.price(model_.way(route.kind, from, to));
    if (std::isfinite(change) || !kind.detours_never_pay) {
      candidates_.push_back({change, vehicle, position, mode});
    }
  }
}

void FleetPlan::try_candidates(int task, Insertion& best) {
  const auto cheaper = [](const Candidate& a, const Candidate& b) { return a.change < b.change; };
  const std::size_t sorted = std::min(kMostTries, candidates_.size());
  std::partial_sort(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(sorted),
                    candidates_.end(), cheaper);
  for (std::size_t i = 0; i < sorted; ++i) {
    const Candidate& c = candidates_[i];
    const RouteState& r = route(c.vehicle);
    // By a station a way may be cheaper: then its price alone says less.
    const bool sure = model_.kind(r.kind).detours_never_pay;
    if (best.vehicle >= 0 && sure && (i >= kFirstTries || c.change >= best.change)) return;
    const Visit visit{task, c.mode};
    if (model_.most_modes() > 1 &&
        try_edit(c.vehicle, evaluator_.insertion(r, c.position, visit, edit_visits_), best)) {
      continue;
    }
    try_edit(c.vehicle, {c.position, c.position, {&visit, 1}}, best);
  }
}

// Takes the edit if it is the best so far. False if it cannot be driven.
bool FleetPlan::try_edit(int vehicle, const RouteEdit& edit, Insertion& best) {
  const RouteState& r = route(vehicle);
  const std::optional<RouteOutcome> outcome = evaluator_.evaluate(r, edit);
  if (!outcome) return false;
  const double change = change_of(r, *outcome);
  if (change >= best.change) return true;
  best.vehicle = vehicle;
  best.first = edit.first;
  best.last = edit.last;
  best.visits.assign(edit.visits.begin(), edit.visits.end());
  best.change = change;
  return true;
}

void FleetPlan::try_new_routes(int task, Insertion& best) {
  for (int k = 0; k < static_cast<int>(model_.kinds().size()); ++k) {
    const VehicleKind& kind = model_.kind(k);
    if (model_.task(task).demand > kind.vehicle.load_capacity) continue;
    const auto idle = std::find_if(kind.members.begin(), kind.members.end(),
                                   [&](int v) { return route(v).visits.empty(); });
    if (idle == kind.members.end()) continue;
    for (int mode = 0; mode < model_.modes(task); ++mode) {
      const Visit visit{task, mode};
      const double least =
          kind.vehicle.fixed_cost +
          model_.price(model_.way(k, kind.vehicle.start, model_.mode(visit).entry)) +
          model_.price(model_.work(k, visit)) +
          model_.price(model_.way(k, model_.mode(visit).exit, kind.vehicle.finish));
      if (least >= best.change && best.vehicle >= 0) continue;
      try_edit(*idle, {0, 0, {&visit, 1}}, best);
    }
  }
}

bool FleetPlan::insert(const Insertion& insertion) {
  return edit(insertion.vehicle, {insertion.first, insertion.last, insertion.visits});
}

bool FleetPlan::remove(int vehicle, const std::vector<int>& positions) {
  const RouteState& r = route(vehicle);
  edit_visits_.clear();
  std::size_t next = 0;
  for (int p = positions.front(); p <= positions.back(); ++p) {
    if (next < positions.size() && positions[next] == p) {
      ++next;
    } else {
      edit_visits_.push_back(r.visits[static_cast<std::size_t>(p)]);
    }
  }
  return edit(vehicle, {positions.front(), positions.back() + 1, edit_visits_});
}

bool FleetPlan::set_route(int vehicle, const std::vector<Visit>& visits) {
  return edit(vehicle, {0, route(vehicle).size(), visits});
}

bool FleetPlan::edit(int vehicle, const RouteEdit& change) {
  touch(vehicle);
  RouteState& r = routes_[static_cast<std::size_t>(vehicle)];
  const bool was_used = !r.visits.empty();
  for (int p = change.first; p < change.last; ++p) {
    places_[static_cast<std::size_t>(r.visits[static_cast<std::size_t>(p)].task)] = {-1, 0};
  }
  const bool done = evaluator_.apply(r, change);
  index(vehicle);
  if (done) itineraries_[static_cast<std::size_t>(vehicle)].reset();
  used_ += static_cast<int>(!r.visits.empty()) - static_cast<int>(was_used);
  return done;
}

void FleetPlan::touch(int vehicle) {
  for (std::size_t i = 0; i < backup_count_; ++i) {
    if (backups_[i].vehicle == vehicle) return;
  }
  if (backup_count_ == backups_.size()) backups_.emplace_back();
  Backup& backup = backups_[backup_count_++];
  backup.vehicle = vehicle;
  backup.route = route(vehicle);
  if (model_.may_queue()) backup.itinerary = itineraries_[static_cast<std::size_t>(vehicle)];
}

void FleetPlan::index(int vehicle) {
  const RouteState& r = route(vehicle);
  for (int p = 0; p < r.size(); ++p) {
    places_[static_cast<std::size_t>(r.visits[static_cast<std::size_t>(p)].task)] = {vehicle, p};
  }
}

void FleetPlan::keep() { backup_count_ = 0; }

void FleetPlan::undo() {
  for (std::size_t i = 0; i < backup_count_; ++i) {
    for (const Visit visit : route(backups_[i].vehicle).visits) {
      places_[static_cast<std::size_t>(visit.task)] = {-1, 0};
    }
  }
  for (std::size_t i = 0; i < backup_count_; ++i) {
    Backup& backup = backups_[i];
    RouteState& r = routes_[static_cast<std::size_t>(backup.vehicle)];
    used_ += static_cast<int>(!backup.route.visits.empty()) - static_cast<int>(!r.visits.empty());
    std::swap(r, backup.route);
    if (model_.may_queue()) {
      std::swap(itineraries_[static_cast<std::size_t>(backup.vehicle)], backup.itinerary);
    }
    index(backup.vehicle);
  }
  backup_count_ = 0;
}

std::vector<std::vector<Visit>> FleetPlan::visits() const {
  std::vector<std::vector<Visit>> all;
  for (const RouteState& route : routes_) all.push_back(route.visits);
  return all;
}

void FleetPlan::restore(const std::vector<std::vector<Visit>>& visits) {
  for (int v = 0; v < vehicles(); ++v) set_route(v, {});
  for (int v = 0; v < vehicles(); ++v) {
    if (!visits[static_cast<std::size_t>(v)].empty()) {
      set_route(v, visits[static_cast<std::size_t>(v)]);
    }
  }
  keep();
}

}  // namespace headland::tour
