// SPDX-License-Identifier: Apache-2.0
// Written from tour_problem.hpp's words alone; shares nothing with the solver.
#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "global_planner/tour/tour_solver.hpp"

namespace headland {
namespace {

using Complaint = std::optional<std::string>;

// What sums of a route's numbers may be off by.
double slack(double a, double b) {
  const double scale =
      std::isfinite(a) && std::isfinite(b) ? std::max(std::abs(a), std::abs(b)) : 0;
  return 1e-6 + 1e-9 * scale;
}
bool same(double a, double b) { return a == b || std::abs(a - b) <= slack(a, b); }
bool at_most(double a, double b) { return a <= b + slack(a, b); }

template <class T>
bool has(const std::vector<T>& items, int index) {
  return index >= 0 && index < std::ssize(items);
}
template <class T>
const T& item(const std::vector<T>& items, int index) {
  return items[static_cast<std::size_t>(index)];
}

// The least time from empty after which the battery holds `energy`; infinity if it never does.
double time_to(const ChargeFunction& charging, double energy) {
  if (energy <= 0.0) return 0.0;
  for (std::size_t i = 1; i < charging.points.size(); ++i) {
    const auto& a = charging.points[i - 1];
    const auto& b = charging.points[i];
    if (energy > b.energy_j) continue;
    if (b.energy_j == a.energy_j) return a.time_s;
    return a.time_s + (b.time_s - a.time_s) * (energy - a.energy_j) / (b.energy_j - a.energy_j);
  }
  const auto& full = charging.points.back();
  return at_most(energy, full.energy_j) ? full.time_s : kNever;
}

// Drives one route again and compares.
class Replay {
 public:
  Replay(const TourProblem& problem, const TourRoute& route)
      : problem_(problem),
        route_(route),
        vehicle_(item(problem.vehicles, route.vehicle)),
        site_(vehicle_.start),
        time_(vehicle_.earliest_s),
        energy_(std::min(vehicle_.start_energy_j, vehicle_.battery_j)),
        lowest_(energy_),
        cost_(vehicle_.fixed_cost) {}

  Complaint run() {
    for (int i = 0; i < std::ssize(route_.stops); ++i) {
      const TourStop& stop = item(route_.stops, i);
      where_ = fmt::format("vehicle {} stop {}", route_.vehicle, i);
      if (auto wrong = stop.task >= 0 ? work(stop) : charge(stop)) return wrong;
    }
    where_ = fmt::format("vehicle {} at the finish", route_.vehicle);
    if (auto wrong = drive(vehicle_.finish)) return wrong;
    return finish();
  }

 private:
  template <class... Args>
  std::string say(fmt::format_string<Args...> format, Args&&... args) const {
    return where_ + ": " + fmt::format(format, std::forward<Args>(args)...);
  }

  Complaint spend(const TourLeg& leg, const std::string& what) {
    if (!(leg.cost < kNever)) return say("{} does not exist for this vehicle", what);
    cost_ += leg.cost;
    time_ += leg.duration_s;
    lowest_ = std::min({lowest_, energy_ - leg.peak_j, energy_ - leg.energy_j});
    energy_ = std::min(vehicle_.battery_j, energy_ - leg.energy_j);
    if (at_most(vehicle_.reserve_j, lowest_)) return {};
    return say("{} takes the battery to {} J, below the reserve of {} J", what, lowest_,
               vehicle_.reserve_j);
  }

  Complaint drive(int site) {
    const int from = site_;
    site_ = site;
    return spend(problem_.way(vehicle_.profile, from, site),
                 fmt::format("the way from site {} to site {}", from, site));
  }

  Complaint arrive(const TourStop& stop) const {
    if (!same(stop.arrival_s, time_)) {
      return say("arrives at {} s, not at {} s", time_, stop.arrival_s);
    }
    if (!same(stop.arrival_j, energy_)) {
      return say("arrives with {} J, not with {} J", energy_, stop.arrival_j);
    }
    if (at_most(stop.arrival_s, stop.begin_s)) return {};
    return say("begins at {} s, before it arrives at {} s", stop.begin_s, stop.arrival_s);
  }

  Complaint work(const TourStop& stop) {
    if (!has(problem_.tasks, stop.task)) return say("there is no task {}", stop.task);
    const TourTask& task = item(problem_.tasks, stop.task);
    if (!has(task.modes, stop.mode)) return say("task {} has no mode {}", stop.task, stop.mode);
    where_ += fmt::format(" (task {})", stop.task);
    const TourMode& mode = item(task.modes, stop.mode);
    if (auto wrong = drive(mode.entry)) return wrong;
    if (auto wrong = arrive(stop)) return wrong;
    if (!at_most(task.earliest_s, stop.begin_s) || !at_most(stop.begin_s, task.latest_s)) {
      return say("begins at {} s, outside its window of {} to {} s", stop.begin_s, task.earliest_s,
                 task.latest_s);
    }
    time_ = stop.begin_s;
    const auto& profile = item(problem_.profiles, vehicle_.profile);
    if (auto wrong = spend(item(item(profile.work, stop.task), stop.mode), "the work"))
      return wrong;
    site_ = mode.exit;
    load_ += task.demand;
    if (!at_most(load_, vehicle_.load_capacity)) {
      return say("the load of {} exceeds the capacity of {}", load_, vehicle_.load_capacity);
    }
    return leave(stop);
  }

  Complaint charge(const TourStop& stop) {
    if (!has(problem_.stations, stop.station)) return say("there is no station {}", stop.station);
    where_ += fmt::format(" (station {})", stop.station);
    if (!has(vehicle_.charging, stop.station) ||
        item(vehicle_.charging, stop.station).points.empty()) {
      return say("this vehicle cannot charge there");
    }
    if (auto wrong = drive(item(problem_.stations, stop.station).site)) return wrong;
    if (auto wrong = arrive(stop)) return wrong;
    if (!at_most(stop.arrival_j, stop.end_j)) {
      return say("leaves with {} J, less than the {} J it came with", stop.end_j, stop.arrival_j);
    }
    const ChargeFunction& charging = item(vehicle_.charging, stop.station);
    const double needed =
        stop.end_j > energy_ ? time_to(charging, stop.end_j) - time_to(charging, energy_) : 0.0;
    if (!at_most(stop.end_j, vehicle_.battery_j) || !at_most(needed, stop.end_s - stop.begin_s)) {
      return say("charges from {} to {} J in {} s, which takes {} s", energy_, stop.end_j,
                 stop.end_s - stop.begin_s, needed);
    }
    time_ = stop.end_s;
    energy_ = stop.end_j;
    return {};
  }

  Complaint leave(const TourStop& stop) const {
    if (!same(stop.end_s, time_)) return say("ends at {} s, not at {} s", time_, stop.end_s);
    if (same(stop.end_j, energy_)) return {};
    return say("ends with {} J, not with {} J", energy_, stop.end_j);
  }

  Complaint finish() const {
    if (!same(route_.finish_s, time_)) return say("at {} s, not at {} s", time_, route_.finish_s);
    if (!at_most(time_, vehicle_.latest_s)) {
      return say("at {} s, later than {} s", time_, vehicle_.latest_s);
    }
    if (!same(route_.finish_j, energy_)) {
      return say("{} J are left, not {} J", energy_, route_.finish_j);
    }
    if (!at_most(vehicle_.finish_energy_j, energy_)) {
      return say("{} J are left, less than the {} J it must have", energy_,
                 vehicle_.finish_energy_j);
    }
    if (!same(route_.lowest_j, lowest_)) {
      return say("the battery's lowest is {} J, not {} J", lowest_, route_.lowest_j);
    }
    if (same(route_.cost, cost_)) return {};
    return say("the route costs {}, not {}", cost_, route_.cost);
  }

  const TourProblem& problem_;
  const TourRoute& route_;
  const TourVehicle& vehicle_;
  int site_;
  double time_;
  double energy_;
  double lowest_;
  double cost_;
  double load_ = 0.0;
  std::string where_;
};

Complaint check_routes(const TourProblem& problem, const TourSolution& solution) {
  int last = -1;
  for (const TourRoute& route : solution.routes) {
    if (!has(problem.vehicles, route.vehicle)) {
      return fmt::format("there is no vehicle {}", route.vehicle);
    }
    if (route.vehicle <= last) {
      return fmt::format("vehicle {} comes after vehicle {}: routes go by vehicle, each once",
                         route.vehicle, last);
    }
    last = route.vehicle;
    if (auto wrong = Replay(problem, route).run()) return wrong;
  }
  return {};
}

Complaint check_tasks(const TourProblem& problem, const TourSolution& solution) {
  std::vector<int> done(problem.tasks.size(), 0);
  std::vector<int> dropped(problem.tasks.size(), 0);
  for (const TourRoute& route : solution.routes) {
    for (const TourStop& stop : route.stops) {
      if (stop.task >= 0) ++done[static_cast<std::size_t>(stop.task)];
    }
  }
  for (const DroppedTask& drop : solution.dropped) {
    if (!has(problem.tasks, drop.task)) return fmt::format("there is no task {}", drop.task);
    ++dropped[static_cast<std::size_t>(drop.task)];
  }
  for (int task = 0; task < std::ssize(problem.tasks); ++task) {
    if (item(done, task) + item(dropped, task) != 1) {
      return fmt::format("task {} is done {} times and left out {} times", task, item(done, task),
                         item(dropped, task));
    }
    if (item(dropped, task) > 0 && item(problem.tasks, task).reward == kNever) {
      return fmt::format("task {} must be done, and is left out", task);
    }
  }
  return {};
}

// Sweeps over begins and ends of all charges at one station; at equal times ends come first.
Complaint check_slots(const TourProblem& problem, const TourSolution& solution) {
  for (int station = 0; station < std::ssize(problem.stations); ++station) {
    std::vector<std::pair<double, int>> events;
    for (const TourRoute& route : solution.routes) {
      for (const TourStop& stop : route.stops) {
        if (stop.task >= 0 || stop.station != station) continue;
        const double end = stop.end_s - slack(stop.end_s, stop.begin_s);
        if (end <= stop.begin_s) continue;
        events.push_back({stop.begin_s, 1});
        events.push_back({end, -1});
      }
    }
    std::sort(events.begin(), events.end());
    int charging = 0;
    for (const auto& [time, change] : events) {
      charging += change;
      if (charging > item(problem.stations, station).slots) {
        return fmt::format("station {}: {} vehicles charge at {} s; it has {} slots", station,
                           charging, time, item(problem.stations, station).slots);
      }
    }
  }
  return {};
}

Complaint check_cost(const TourProblem& problem, const TourSolution& solution) {
  double cost = 0.0;
  double span = 0.0;
  for (const TourRoute& route : solution.routes) {
    const double begin = item(problem.vehicles, route.vehicle).earliest_s;
    cost += route.cost + problem.duration_weight * (route.finish_s - begin);
    span = std::max(span, route.finish_s);
  }
  cost += problem.span_weight * span;
  for (const DroppedTask& drop : solution.dropped) cost += item(problem.tasks, drop.task).reward;
  if (!same(cost, solution.cost)) {
    return fmt::format("the solution costs {}, not {}", cost, solution.cost);
  }
  if (!at_most(solution.lower_bound, cost)) {
    return fmt::format("the lower bound of {} lies above the cost of {}", solution.lower_bound,
                       cost);
  }
  if (solution.optimal && !at_most(cost, solution.lower_bound)) {
    return fmt::format("called optimal at a cost of {} and a lower bound of {}", cost,
                       solution.lower_bound);
  }
  return {};
}

}  // namespace

std::optional<std::string> check_solution(const TourProblem& problem,
                                          const TourSolution& solution) {
  for (const auto check : {check_routes, check_tasks, check_slots, check_cost}) {
    if (auto wrong = check(problem, solution)) return wrong;
  }
  return {};
}

}  // namespace headland
