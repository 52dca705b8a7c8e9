// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/itinerary.hpp"

#include <algorithm>

namespace headland::tour {
namespace {

using Items = std::vector<ItineraryItem>;

// The label that is cheapest at the finish, time counted; -1: none in time.
int cheapest(const Model& model, const VehicleKind& kind, const LabelSet& finished) {
  int best = -1;
  double least = kNever;
  for (int i = 0; i < static_cast<int>(finished.labels.size()); ++i) {
    const Label& label = finished.labels[static_cast<std::size_t>(i)];
    const double time = finished.curve(label).front().time_s;
    const double value = label.cost + model.duration_price() * time;
    if (time > kind.vehicle.latest_s + model.time_slack() || value >= least) continue;
    least = value;
    best = i;
  }
  return best;
}

// Sets up to the finish, one after each visit; empty if some visit cannot be reached.
std::vector<LabelSet> label_sets(const Model& model, Crossing& crossing, const VehicleKind& kind,
                                 const std::vector<Visit>& visits) {
  std::vector<Crossing::Outlook> outlooks(visits.size());
  Crossing::Outlook next = crossing.at_finish();
  int to = kind.vehicle.finish;
  for (std::size_t i = visits.size(); i-- > 0;) {
    outlooks[i] = next = crossing.before(visits[i], to, next);
    to = model.mode(visits[i]).entry;
  }
  std::vector<LabelSet> sets(visits.size() + 2);
  crossing.clear_log();
  crossing.start(sets[0]);
  int site = kind.vehicle.start;
  LabelSet arrived;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    crossing.cross(sets[i], site, model.mode(visits[i]).entry, outlooks[i], arrived);
    crossing.work(arrived, visits[i], sets[i + 1]);
    if (sets[i + 1].empty()) return {};
    site = model.mode(visits[i]).exit;
  }
  crossing.finish(sets[visits.size()], site, sets.back());
  return sets;
}

// Follows labels back from the finish. The set after visit i was extended from the one after i - 1.
Items trace(const std::vector<LabelSet>& sets, const std::vector<Crossing::Passage>& log,
            const std::vector<Visit>& visits, int label) {
  Items items;
  for (std::size_t set = sets.size() - 1; set > 0; --set) {
    const Label& at = sets[set].labels[static_cast<std::size_t>(label)];
    if (set <= visits.size()) items.push_back({visits[set - 1], -1, 0.0});
    for (int p = at.stations; p >= 0; p = log[static_cast<std::size_t>(p)].before) {
      items.push_back({{-1, 0}, log[static_cast<std::size_t>(p)].station, 0.0});
    }
    label = at.before;
  }
  std::reverse(items.begin(), items.end());
  return items;
}

int entry_of(const Model& model, const ItineraryItem& item) {
  return item.visit.task >= 0 ? model.mode(item.visit).entry : model.station_site(item.station);
}
int exit_of(const Model& model, const ItineraryItem& item) {
  return item.visit.task >= 0 ? model.mode(item.visit).exit : model.station_site(item.station);
}

// How much to charge at each stop of a fixed sequence: curves forward, then, from the energy that
// must be left at the finish, the least energy at each stop that keeps the earliest finish.
void set_charges(const Model& model, int kind_index, Items& items) {
  const VehicleKind& kind = model.kind(kind_index);
  const auto& charging = kind.vehicle.charging;
  std::vector<EnergyCurve> arrivals;
  EnergyCurve curve{{kind.start_j, model.timeless() ? 0.0 : kind.vehicle.earliest_s}};
  EnergyCurve scratch;
  int site = kind.vehicle.start;
  for (const ItineraryItem& item : items) {
    const TourLeg& way = model.way(kind_index, site, entry_of(model, item));
    drive(curve, way, model.duration(way), kind.battery);
    arrivals.push_back(curve);
    if (item.visit.task >= 0) {
      const TourTask& task = model.task(item.visit.task);
      if (model.windows()) {
        wait_window(curve, task.earliest_s, task.latest_s + model.time_slack());
      }
      const TourLeg& work = model.work(kind_index, item.visit);
      drive(curve, work, model.duration(work), kind.battery);
    } else {
      charge(curve, charging[static_cast<std::size_t>(item.station)], kind.battery.full_j,
             model.timeless(), scratch);
    }
    site = exit_of(model, item);
  }
  double need = kind.finish_need_j;
  int next_site = kind.vehicle.finish;
  for (std::size_t i = items.size(); i-- > 0;) {
    ItineraryItem& item = items[i];
    need = need_before(model.way(kind_index, exit_of(model, item), next_site), need, kind.battery);
    next_site = entry_of(model, item);
    if (item.visit.task >= 0) {
      need = need_before(model.work(kind_index, item.visit), need, kind.battery);
      continue;
    }
    const ChargeFunction& function = charging[static_cast<std::size_t>(item.station)];
    item.leave_j =
        model.timeless() ? std::min(kind.battery.full_j, function.points.back().energy_j) : need;
    if (model.timeless()) {
      need = kind.battery.floor_j;
    } else if (need > arrivals[i].front().energy_j) {
      need = best_arrival(arrivals[i], function, need);
    }
  }
}

// One vehicle on its way through its itinerary.
class Driver {
 public:
  Driver(const Model& model, int vehicle, const Itinerary& itinerary)
      : model_(model),
        kind_(model.kind(itinerary.kind)),
        itinerary_(itinerary),
        site_(kind_.vehicle.start),
        time_(kind_.vehicle.earliest_s),
        energy_(kind_.start_j) {
    route_.vehicle = vehicle;
    route_.cost = kind_.vehicle.fixed_cost;
    route_.lowest_j = energy_;
  }

  const TourRoute& route() const { return route_; }
  double time() const { return time_; }
  bool done() const { return next_ > itinerary_.items.size(); }
  int station() const { return itinerary_.items[next_].station; }

  // Up to the arrival at the next station, or the finish. False: too late somewhere.
  bool go_on() {
    for (; next_ < itinerary_.items.size(); ++next_) {
      const ItineraryItem& item = itinerary_.items[next_];
      spend(model_.way(itinerary_.kind, site_, entry_of(model_, item)));
      site_ = exit_of(model_, item);
      if (item.visit.task < 0) return true;
      if (!work(item.visit)) return false;
    }
    spend(model_.way(itinerary_.kind, site_, kind_.vehicle.finish));
    route_.finish_s = time_;
    route_.finish_j = energy_;
    ++next_;
    return time_ <= kind_.vehicle.latest_s + 10.0 * model_.time_slack();
  }

  bool charges() const { return itinerary_.items[next_].leave_j > energy_; }

  // Charges at the station it stands at, from `begin` on. Returns when it is done.
  double charge(double begin) {
    const ItineraryItem& item = itinerary_.items[next_++];
    TourStop stop{-1, 0, item.station, time_, begin, begin, energy_, energy_};
    if (item.leave_j > energy_) {
      const auto& function = kind_.vehicle.charging[static_cast<std::size_t>(item.station)];
      stop.end_j = std::min(item.leave_j, function.points.back().energy_j);
      stop.end_s = begin + charge_time(function, stop.end_j) - charge_time(function, energy_);
    }
    time_ = stop.end_s;
    energy_ = stop.end_j;
    route_.stops.push_back(stop);
    return time_;
  }

 private:
  bool work(Visit visit) {
    const TourTask& task = model_.task(visit.task);
    TourStop stop{visit.task, visit.mode, -1, time_, 0.0, 0.0, energy_, 0.0};
    time_ = stop.begin_s = std::max(time_, task.earliest_s);
    spend(model_.work(itinerary_.kind, visit));
    stop.end_s = time_;
    stop.end_j = energy_;
    route_.stops.push_back(stop);
    return stop.begin_s <= task.latest_s + 10.0 * model_.time_slack();
  }

  void spend(const TourLeg& leg) {
    route_.cost += leg.cost;
    time_ += leg.duration_s;
    route_.lowest_j = std::min({route_.lowest_j, energy_ - leg.peak_j, energy_ - leg.energy_j});
    energy_ = std::min(kind_.battery.full_j, energy_ - leg.energy_j);
  }

  const Model& model_;
  const VehicleKind& kind_;
  const Itinerary& itinerary_;
  TourRoute route_;
  std::size_t next_ = 0;  // item; one past the last: the finish lies ahead, then done
  int site_;
  double time_;
  double energy_;
};

}  // namespace

std::optional<Itinerary> best_itinerary(const Model& model, Crossing& crossing, int kind,
                                        const std::vector<Visit>& visits) {
  const std::vector<LabelSet> sets = label_sets(model, crossing, model.kind(kind), visits);
  if (sets.empty()) return {};
  const int label = cheapest(model, model.kind(kind), sets.back());
  if (label < 0) return {};
  Itinerary itinerary{kind, trace(sets, crossing.log(), visits, label)};
  set_charges(model, kind, itinerary.items);
  return itinerary;
}

std::optional<std::vector<TourRoute>> drive_fleet(const Model& model,
                                                  const std::vector<int>& vehicles,
                                                  const std::vector<Itinerary>& itineraries) {
  std::vector<Driver> drivers;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    drivers.emplace_back(model, vehicles[i], itineraries[i]);
    if (!drivers.back().go_on()) return {};
  }
  std::vector<std::vector<double>> free_from;  // of each slot in use, by station
  free_from.resize(model.problem().stations.size());
  // The next to be served is always the one who has come first.
  for (;;) {
    Driver* first = nullptr;
    for (Driver& driver : drivers) {
      if (!driver.done() && (first == nullptr || driver.time() < first->time())) first = &driver;
    }
    if (first == nullptr) break;
    double begin = first->time();
    if (first->charges()) {
      const auto station = static_cast<std::size_t>(first->station());
      auto& slots = free_from[station];
      const auto count = static_cast<std::size_t>(model.problem().stations[station].slots);
      if (slots.size() < count) slots.push_back(-kNever);
      auto slot = std::min_element(slots.begin(), slots.end());
      begin = std::max(begin, *slot);
      *slot = first->charge(begin);
    } else {
      first->charge(begin);
    }
    if (!first->go_on()) return {};
  }
  std::vector<TourRoute> routes;
  for (const Driver& driver : drivers) routes.push_back(driver.route());
  std::sort(routes.begin(), routes.end(),
            [](const TourRoute& a, const TourRoute& b) { return a.vehicle < b.vehicle; });
  return routes;
}

double objective(const TourProblem& problem, const std::vector<TourRoute>& routes) {
  double cost = 0.0;
  double span = 0.0;
  std::vector<char> done(problem.tasks.size(), 0);
  for (const TourRoute& route : routes) {
    const TourVehicle& vehicle = problem.vehicles[static_cast<std::size_t>(route.vehicle)];
    cost += route.cost + problem.duration_weight * (route.finish_s - vehicle.earliest_s);
    span = std::max(span, route.finish_s);
    for (const TourStop& stop : route.stops) {
      if (stop.task >= 0) done[static_cast<std::size_t>(stop.task)] = 1;
    }
  }
  for (std::size_t t = 0; t < done.size(); ++t) {
    if (!done[t]) cost += problem.tasks[t].reward;
  }
  return cost + problem.span_weight * span;
}

}  // namespace headland::tour
