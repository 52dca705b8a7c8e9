// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "global_planner/tour/internal/cycle_prices.hpp"
#include "global_planner/tour/internal/least_legs.hpp"

namespace headland::tour {
namespace {

constexpr double kRounding = 1e-9;     // of a bound: what its sums may be off by
constexpr double kPriceSteps = 1.5e9;  // assignments take n^3 steps at worst
constexpr int kMostRounds = 400;
constexpr double kReach = 0.1;   // of all tasks' cheapest ways: how far prices may raise the bound
constexpr int kTimePrices = 24;  // bisections
constexpr double kFirstTimePrice = 1e-3;
constexpr double kMostTimePrice = 1e12;
constexpr int kTurns = 12;  // of prices for time and for cycles, one after the other

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool must(const TourTask& task) { return !(task.reward < kNever); }

// The problem as an assignment: nodes are the tasks, then the vehicles.
class Relaxed {
 public:
  explicit Relaxed(const TourProblem& problem)
      : problem_(problem),
        per_second_(problem.duration_weight +
                    problem.span_weight / std::max(1.0, static_cast<double>(vehicles()))),
        legs_(problem,
              [this](const TourLeg& leg) { return leg.cost + per_second_ * leg.duration_s; }),
        times_(problem, [](const TourLeg& leg) { return leg.duration_s; }),
        capacity_(0.0),
        costs_(tasks() + vehicles(), kNever),
        durations_(tasks() + vehicles(), kNever) {
    for (const TourVehicle& v : problem.vehicles) {
      capacity_ = std::max(capacity_, v.load_capacity);
    }
    fill();
  }

  bool bounded() const { return legs_.bounded() && times_.bounded(); }
  const CostMatrix& costs() const { return costs_; }
  const CostMatrix& durations() const { return durations_; }
  int tasks() const { return static_cast<int>(problem_.tasks.size()); }
  int vehicles() const { return static_cast<int>(problem_.vehicles.size()); }

  // Time of all vehicles together; infinity if one may take any.
  double time_budget() const {
    double sum = 0.0;
    for (const TourVehicle& v : problem_.vehicles) sum += v.latest_s - v.earliest_s;
    return sum;
  }

  // A cycle of tasks alone must be left, unless its dearest task is left out; tasks between two
  // visits to vehicles must be left as often as their loads need.
  void rules(const std::vector<int>& cycle, std::vector<LeavingRule>& rules) const {
    const auto vehicle =
        std::find_if(cycle.begin(), cycle.end(), [&](int node) { return node >= tasks(); });
    if (vehicle == cycle.end()) {
      if (cycle.size() > 1) rules.push_back(rule(cycle));
      return;
    }
    std::vector<int> trip;
    for (std::size_t k = 1; k <= cycle.size(); ++k) {
      const auto from = static_cast<std::size_t>(vehicle - cycle.begin());
      const int node = cycle[(from + k) % cycle.size()];
      if (node < tasks()) {
        trip.push_back(node);
        continue;
      }
      LeavingRule needed = rule(trip);
      if (needed.times > 1) rules.push_back(std::move(needed));
      trip.clear();
    }
  }

 private:
  LeavingRule rule(const std::vector<int>& tasks) const {
    LeavingRule rule{tasks, 1, -1};
    double load = 0.0;
    double highest = 0.0;
    for (const int t : tasks) {
      const TourTask& task = problem_.tasks[at(t)];
      if (must(task)) {
        load += task.demand;
        highest = kNever;
        rule.keeper = -1;
      } else if (task.reward > highest || (rule.keeper < 0 && highest == 0.0)) {
        highest = task.reward;
        rule.keeper = t;
      }
    }
    if (capacity_ < kNever && load > capacity_) {
      rule.times = static_cast<int>(std::ceil(load / capacity_ - 1e-9));
    }
    return rule;
  }

  // When work on each task can begin at the earliest, whatever is done before (Dijkstra: ways need
  // not keep the triangle inequality).
  std::vector<double> earliest() const {
    std::vector<double> begin(at(tasks()), kNever);
    std::vector<bool> settled(at(tasks()), false);
    for (const TourVehicle& v : problem_.vehicles) arrive(v.start, v.earliest_s, begin);
    for (int round = 0; round < tasks(); ++round) {
      int next = -1;
      for (int t = 0; t < tasks(); ++t) {
        if (!settled[at(t)] && (next < 0 || begin[at(t)] < begin[at(next)])) next = t;
      }
      settled[at(next)] = true;
      const auto& modes = problem_.tasks[at(next)].modes;
      for (int m = 0; m < std::ssize(modes); ++m) {
        arrive(modes[at(m)].exit, begin[at(next)] + times_.work(next, m), begin);
      }
    }
    return begin;
  }

  void arrive(int from, double time, std::vector<double>& begin) const {
    for (int t = 0; t < tasks(); ++t) {
      const TourTask& task = problem_.tasks[at(t)];
      for (const TourMode& mode : task.modes) {
        const double arrival = std::max(task.earliest_s, time + times_.way(from, mode.entry));
        begin[at(t)] = std::min(begin[at(t)], arrival);
      }
    }
  }

  struct Arc {
    double cost = kNever;
    double duration = kNever;
  };

  // From a site to a task with its work, or to the least of its modes.
  Arc arc_to(int from, int task) const {
    Arc arc;
    const auto& modes = problem_.tasks[at(task)].modes;
    for (int m = 0; m < std::ssize(modes); ++m) {
      const int entry = modes[at(m)].entry;
      arc.cost = std::min(arc.cost, legs_.way(from, entry) + legs_.work(task, m));
      arc.duration = std::min(arc.duration, times_.way(from, entry) + times_.work(task, m));
    }
    return arc;
  }

  void fill() {
    const std::vector<double> begin = earliest();
    for (int i = 0; i < tasks(); ++i) {
      const TourTask& task = problem_.tasks[at(i)];
      if (!must(task)) costs_.at(i, i) = task.reward;
      durations_.at(i, i) = 0.0;
      for (int j = 0; j < tasks(); ++j) {
        if (i != j) set_between(i, j, begin[at(i)]);
      }
    }
    const int least = identical() ? least_vehicles(problem_) : 0;
    for (int v = 0; v < vehicles(); ++v) set_vehicle(v, begin, v < least);
  }

  void set_between(int i, int j, double begin) {
    const TourTask& from = problem_.tasks[at(i)];
    const TourTask& to = problem_.tasks[at(j)];
    if (from.demand + to.demand > capacity_ * (1.0 + kRounding)) return;
    for (int m = 0; m < std::ssize(from.modes); ++m) {
      const Arc arc = arc_to(from.modes[at(m)].exit, j);
      double way = kNever;
      for (const TourMode& mode : to.modes) {
        way = std::min(way, times_.way(from.modes[at(m)].exit, mode.entry));
      }
      const double arrival = begin + times_.work(i, m) + way;
      if (arrival > to.latest_s + kRounding * (1.0 + std::abs(to.latest_s))) continue;
      costs_.at(i, j) = std::min(costs_.at(i, j), arc.cost);
      durations_.at(i, j) = std::min(durations_.at(i, j), arc.duration);
    }
  }

  // A vehicle's node: to itself if it stays unused, which those that are needed cannot.
  void set_vehicle(int v, const std::vector<double>& begin, bool needed) {
    const TourVehicle& vehicle = problem_.vehicles[at(v)];
    const int node = tasks() + v;
    const double begins = problem_.span_weight * vehicle.earliest_s / vehicles();
    const double empty = vehicle.fixed_cost + legs_.way(vehicle.start, vehicle.finish) + begins;
    durations_.at(node, node) = 0.0;
    costs_.at(node, node) = needed ? kNever : std::min(0.0, empty);
    for (int i = 0; i < tasks(); ++i) {
      const TourTask& task = problem_.tasks[at(i)];
      const Arc arc = arc_to(vehicle.start, i);
      const double latest = task.latest_s + kRounding * (1.0 + std::abs(task.latest_s));
      if (begin[at(i)] <= latest && task.demand <= vehicle.load_capacity * (1.0 + kRounding)) {
        costs_.at(node, i) = arc.cost + vehicle.fixed_cost + begins;
        durations_.at(node, i) = arc.duration;
      }
      for (int m = 0; m < std::ssize(task.modes); ++m) {
        const int exit = task.modes[at(m)].exit;
        const double home = times_.way(exit, vehicle.finish);
        const double last = vehicle.latest_s + kRounding * (1.0 + std::abs(vehicle.latest_s));
        if (begin[at(i)] + times_.work(i, m) + home > last) continue;
        costs_.at(i, node) = std::min(costs_.at(i, node), legs_.way(exit, vehicle.finish));
        durations_.at(i, node) = std::min(durations_.at(i, node), home);
      }
    }
  }

  bool identical() const {
    const auto same = [&](const TourVehicle& v) {
      const TourVehicle& first = problem_.vehicles.front();
      return v.start == first.start && v.finish == first.finish && v.profile == first.profile &&
             v.fixed_cost == first.fixed_cost && v.load_capacity == first.load_capacity &&
             v.earliest_s == first.earliest_s && v.latest_s == first.latest_s;
    };
    return std::all_of(problem_.vehicles.begin(), problem_.vehicles.end(), same);
  }

  const TourProblem& problem_;
  double per_second_;
  LeastLegs legs_;
  LeastLegs times_;
  double capacity_;
  CostMatrix costs_;
  CostMatrix durations_;
};

// The scale of all ways together: each task's cheapest.
double scale_of(const CostMatrix& costs, int tasks) {
  double sum = 0.0;
  for (int i = 0; i < tasks; ++i) {
    double least = kNever;
    for (int j = 0; j < tasks; ++j) {
      if (i != j) least = std::min(least, std::abs(costs.at(i, j)));
    }
    sum += least < kNever ? least : 0.0;
  }
  return sum;
}

// Time at a price: it is paid for by every arc, and the budget's worth is given back.
CostMatrix with_time(const CostMatrix& costs, const CostMatrix& durations, double price) {
  CostMatrix dearer = costs;
  for (std::size_t k = 0; k < costs.cost.size(); ++k) {
    if (costs.cost[k] < kNever) dearer.cost[k] += price * durations.cost[k];
  }
  return dearer;
}

double time_of(const CostMatrix& durations, const Successors& next) {
  double sum = 0.0;
  for (int i = 0; i < durations.size; ++i) sum += durations.at(i, next[at(i)]);
  return sum;
}

// By how much the price of time, `price` so far, should change for the cheapest assignment just to
// use the budget (the bound is concave in it): a bracket is widened upwards, then halved.
double time_price_change(const CostMatrix& costs, const CostMatrix& durations, double budget,
                         double price) {
  const auto over = [&](double change) {
    Assignment assignment;
    return assign(with_time(costs, durations, change), assignment) &&
           time_of(durations, assignment.column_of) > budget;
  };
  double low = -price;
  double high = 0.0;
  for (double width = kFirstTimePrice; over(high); width *= 4.0) {
    if (width > kMostTimePrice) return 0.0;
    low = high;
    high += width;
  }
  for (int k = 0; k < kTimePrices && high - low > 1e-4 * (price + high); ++k) {
    const double middle = 0.5 * (low + high);
    (over(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

int least_vehicles(const TourProblem& problem) {
  double capacity = 0.0;
  for (const TourVehicle& v : problem.vehicles) capacity = std::max(capacity, v.load_capacity);
  std::vector<double> loads;
  for (const TourTask& task : problem.tasks) {
    if (must(task)) loads.push_back(task.demand);
  }
  if (loads.empty()) return 0;
  if (!(capacity < kNever) || !(capacity > 0.0)) return 1;
  // Loads above capacity - k are alone but for loads below k; those above half need one each.
  int least = 1;
  std::vector<double> thresholds = {0.0};
  for (const double load : loads) {
    if (load <= 0.5 * capacity) thresholds.push_back(load);
  }
  for (const double k : thresholds) {
    int alone = 0;
    int halves = 0;
    double room = 0.0;
    double small = 0.0;
    for (const double load : loads) {
      if (load > capacity - k) {
        ++alone;
      } else if (load > 0.5 * capacity) {
        ++halves;
        room += capacity - load;
      } else if (load >= k) {
        small += load;
      }
    }
    const double more = std::ceil((small - room) / capacity - 1e-9);
    least = std::max(least, alone + halves + std::max(0, static_cast<int>(more)));
  }
  return std::min(least, static_cast<int>(problem.vehicles.size()));
}

double lower_bound(const TourProblem& problem, const std::function<bool()>& stop) {
  if (problem.tasks.empty() || problem.vehicles.empty()) {
    double lost = 0.0;
    for (const TourTask& task : problem.tasks) lost += task.reward;
    return problem.vehicles.empty() ? lost : -kNever;
  }
  const Relaxed relaxed(problem);
  if (!relaxed.bounded()) return -kNever;
  const double n = relaxed.costs().size;
  PriceAscent ascent;
  ascent.rounds = 1 + std::min(kMostRounds, static_cast<int>(kPriceSteps / (n * n * n)));
  ascent.stop = stop;
  ascent.rules = [&](const std::vector<int>& cycle, std::vector<LeavingRule>& rules) {
    relaxed.rules(cycle, rules);
  };
  const double budget = relaxed.time_budget();
  PricedCosts priced{relaxed.costs()};
  double best = -kNever;
  double time_price = 0.0;
  double terms = 0.0;  // what was added up, for its rounding
  for (int turn = 0; turn < (budget < kNever ? kTurns : 1); ++turn) {
    const double before = priced.offset;
    if (budget < kNever) {
      const double change =
          time_price_change(priced.costs, relaxed.durations(), budget, time_price);
      priced.costs = with_time(priced.costs, relaxed.durations(), change);
      time_price += change;
      terms += std::abs(change) * budget;
      priced.offset = before - change * budget;
    }
    if (turn == 0) ascent.reach = kReach * scale_of(priced.costs, relaxed.tasks());
    const double so_far = priced.offset;
    priced = price_cycles(priced.costs, ascent);
    priced.offset += so_far;
    priced.bound += so_far;
    terms += std::abs(priced.bound);
    best = std::max(best, priced.bound - kRounding * terms);
    if (priced.offset == before) break;
  }
  return best;
}

}  // namespace headland::tour
