// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/route_state.hpp"

#include <algorithm>
#include <cmath>

namespace headland::tour {
namespace {

bool near(double a, double b, double slack) { return a == b || std::abs(a - b) <= slack; }

// The cell's labels and points at the end of another route's, shifted.
void copy_cell(const RouteState& from, RouteState::Cell cell, double cost, double time,
               RouteState& to) {
  cell.cost += cost;
  cell.time_s += time;
  cell.earliest_s += time;
  const auto labels = from.labels.begin() + cell.first_label;
  const auto points = from.points.begin() + cell.first_point;
  cell.first_label = static_cast<int>(to.labels.size());
  cell.first_point = static_cast<int>(to.points.size());
  to.labels.insert(to.labels.end(), labels, labels + cell.labels);
  to.points.insert(to.points.end(), points, points + cell.points);
  to.cells.push_back(cell);
}

}  // namespace

RouteEvaluator::RouteEvaluator(const Model& model) : model_(model) {
  for (int k = 0; k < static_cast<int>(model.kinds().size()); ++k) {
    crossings_.emplace_back(model, k, Crossing::Effort::kThrifty);
  }
}

long RouteEvaluator::labels_made() const {
  long sum = 0;
  for (const Crossing& crossing : crossings_) sum += crossing.labels_made();
  return sum;
}

RouteState RouteEvaluator::empty_route(int kind) const {
  RouteState route;
  route.kind = kind;
  return route;
}

std::optional<RouteOutcome> RouteEvaluator::evaluate(const RouteState& route,
                                                     const RouteEdit& edit) {
  return propagate(route, edit, nullptr);
}

bool RouteEvaluator::apply(RouteState& route, const RouteEdit& edit) {
  RouteState& next = scratch_;
  next.kind = route.kind;
  next.visits.assign(route.visits.begin(), route.visits.begin() + edit.first);
  next.visits.insert(next.visits.end(), edit.visits.begin(), edit.visits.end());
  next.visits.insert(next.visits.end(), route.visits.begin() + edit.last, route.visits.end());
  next.cells.clear();
  next.labels.clear();
  next.points.clear();
  next.value = next.finish_s = 0.0;
  if (!next.visits.empty()) {
    const std::optional<RouteOutcome> outcome = propagate(route, edit, &next);
    if (!outcome) return false;
    next.value = outcome->value;
    next.finish_s = outcome->finish_s;
  }
  look_ahead(next);
  price_modes(next);
  std::swap(route, next);
  return true;
}

// Labels from the edit's first visit on, until they are the route's own again but for a shift.
std::optional<RouteOutcome> RouteEvaluator::propagate(const RouteState& route,
                                                      const RouteEdit& edit, RouteState* result) {
  const VehicleKind& kind = model_.kind(route.kind);
  Crossing& crossing = crossings_[static_cast<std::size_t>(route.kind)];
  crossing.clear_log();
  Base base;
  if (route.visits.empty()) {
    crossing.start(set_);
    base = normalise(set_);
    if (result != nullptr) store(*result, base);
  } else {
    const RouteState::Cell& cell = route.cells[static_cast<std::size_t>(edit.first)];
    load(route, cell);
    base = {cell.cost, cell.time_s};
    for (int c = 0; result != nullptr && c <= edit.first; ++c) {
      copy_cell(route, route.cells[static_cast<std::size_t>(c)], 0.0, 0.0, *result);
    }
  }
  int site = edit.first == 0
                 ? kind.vehicle.start
                 : model_.mode(route.visits[static_cast<std::size_t>(edit.first - 1)]).exit;
  const auto advance = [&](Visit visit, const Crossing::Outlook& outlook) {
    crossing.cross(set_, site, model_.mode(visit).entry, outlook, arrived_);
    crossing.work(arrived_, visit, set_);
    if (set_.empty()) return false;
    const Base change = normalise(set_);
    base = {base.cost + change.cost, base.time_s + change.time_s};
    if (result != nullptr) store(*result, base);
    site = model_.mode(visit).exit;
    return true;
  };
  look_ahead(route, edit);
  for (std::size_t i = 0; i < edit.visits.size(); ++i) {
    if (!advance(edit.visits[i], outlooks_[i])) return {};
  }
  for (int k = edit.last; k < route.size(); ++k) {
    const auto index = static_cast<std::size_t>(k);
    if (!advance(route.visits[index], {route.need_j[index], route.latest_s[index]})) return {};
    const RouteState::Cell& old = route.cells[index + 1];
    if (!same(route, old)) continue;
    const Base shift{base.cost - old.cost, base.time_s - old.time_s};
    for (std::size_t c = index + 2; result != nullptr && c < route.cells.size(); ++c) {
      copy_cell(route, route.cells[c], shift.cost, shift.time_s, *result);
    }
    return shifted(route, shift);
  }
  crossing.finish(set_, site, arrived_);
  if (arrived_.empty()) return {};
  std::swap(set_, arrived_);
  const Base change = normalise(set_);
  base = {base.cost + change.cost, base.time_s + change.time_s};
  if (result != nullptr) store(*result, base);
  return outcome(route.kind, base);
}

// Outlooks at the edit's new visits, from the last to the first.
void RouteEvaluator::look_ahead(const RouteState& route, const RouteEdit& edit) {
  const VehicleKind& kind = model_.kind(route.kind);
  const auto last = static_cast<std::size_t>(edit.last);
  Crossing::Outlook next = crossing(route.kind).at_finish();
  if (!route.visits.empty()) next = {route.need_j[last], route.latest_s[last]};
  int to = edit.last < route.size() ? model_.mode(route.visits[last]).entry : kind.vehicle.finish;
  outlooks_.resize(edit.visits.size());
  for (std::size_t i = edit.visits.size(); i-- > 0;) {
    next = crossing(route.kind).before(edit.visits[i], to, next);
    to = model_.mode(edit.visits[i]).entry;
    outlooks_[i] = next;
  }
}

// The best label at the finish that is in time.
std::optional<RouteOutcome> RouteEvaluator::outcome(int kind_index, const Base& base) const {
  const TourVehicle& vehicle = model_.kind(kind_index).vehicle;
  std::optional<RouteOutcome> best;
  double least = kNever;
  for (const Label& label : set_.labels) {
    const double time = base.time_s + set_.curve(label).front().time_s;
    const double cost = base.cost + label.cost;
    const double price = cost + model_.duration_price() * time;
    if (price >= least || time > vehicle.latest_s + model_.time_slack()) continue;
    least = price;
    const double duration = model_.problem().duration_weight * (time - vehicle.earliest_s);
    best = RouteOutcome{vehicle.fixed_cost + cost + (model_.timeless() ? 0.0 : duration), time};
  }
  return best;
}

std::optional<RouteOutcome> RouteEvaluator::shifted(const RouteState& route, const Base& shift) {
  const RouteState::Cell& cell = route.cells.back();
  load(route, cell);
  return outcome(route.kind, {cell.cost + shift.cost, cell.time_s + shift.time_s});
}

RouteEvaluator::Base RouteEvaluator::normalise(LabelSet& set) const {
  Base base{kNever, model_.windows() ? 0.0 : kNever};
  for (const Label& label : set.labels) {
    base.cost = std::min(base.cost, label.cost);
    if (!model_.windows()) {
      base.time_s = std::min(base.time_s, set.curve(label).front().time_s);
    }
  }
  for (Label& label : set.labels) {
    label.cost -= base.cost;
    for (int p = 0; base.time_s != 0.0 && p < label.points; ++p) {
      set.points[static_cast<std::size_t>(label.first_point + p)].time_s -= base.time_s;
    }
  }
  return base;
}

bool RouteEvaluator::same(const RouteState& route, const RouteState::Cell& cell) const {
  if (static_cast<int>(set_.labels.size()) != cell.labels) return false;
  const double energy_slack =
      crossings_[static_cast<std::size_t>(route.kind)].dominance().energy_slack;
  for (int i = 0; i < cell.labels; ++i) {
    const Label& a = set_.labels[static_cast<std::size_t>(i)];
    const Label& b = route.labels[static_cast<std::size_t>(cell.first_label + i)];
    if (a.points != b.points || !near(a.cost, b.cost, model_.cost_slack())) return false;
    for (int p = 0; p < a.points; ++p) {
      const CurvePoint& x = set_.points[static_cast<std::size_t>(a.first_point + p)];
      const CurvePoint& y =
          route.points[static_cast<std::size_t>(cell.first_point + b.first_point + p)];
      if (!near(x.energy_j, y.energy_j, energy_slack)) return false;
      if (!near(x.time_s, y.time_s, model_.time_slack())) return false;
    }
  }
  return true;
}

void RouteEvaluator::load(const RouteState& route, const RouteState::Cell& cell) {
  const auto labels = route.labels.begin() + cell.first_label;
  const auto points = route.points.begin() + cell.first_point;
  set_.labels.assign(labels, labels + cell.labels);
  set_.points.assign(points, points + cell.points);
}

void RouteEvaluator::store(RouteState& route, const Base& base) const {
  RouteState::Cell cell{static_cast<int>(route.labels.size()),
                        static_cast<int>(set_.labels.size()),
                        static_cast<int>(route.points.size()),
                        static_cast<int>(set_.points.size()),
                        base.cost,
                        base.time_s,
                        kNever};
  for (const Label& label : set_.labels) {
    cell.earliest_s = std::min(cell.earliest_s, base.time_s + set_.curve(label).front().time_s);
  }
  route.labels.insert(route.labels.end(), set_.labels.begin(), set_.labels.end());
  route.points.insert(route.points.end(), set_.points.begin(), set_.points.end());
  route.cells.push_back(cell);
}

// Outlooks at all visits, from the finish backwards.
void RouteEvaluator::look_ahead(RouteState& route) {
  const VehicleKind& kind = model_.kind(route.kind);
  const std::size_t n = route.visits.size();
  Crossing::Outlook next = crossing(route.kind).at_finish();
  route.need_j.assign(n + 1, next.need_j);
  route.latest_s.assign(n + 1, next.latest_s);
  route.load = 0.0;
  int to = kind.vehicle.finish;
  for (std::size_t i = n; i-- > 0;) {
    next = crossing(route.kind).before(route.visits[i], to, next);
    route.need_j[i] = next.need_j;
    route.latest_s[i] = next.latest_s;
    route.load += model_.task(route.visits[i].task).demand;
    to = model_.mode(route.visits[i]).entry;
  }
}

}  // namespace headland::tour
