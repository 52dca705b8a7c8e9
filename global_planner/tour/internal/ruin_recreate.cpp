// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/ruin_recreate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace headland::tour {
namespace {

// Christiaens and Vanden Berghe 2020, Table 1: tasks removed on average, longest string, share of
// split strings, their growth, and blinks.
constexpr double kRemovedOnAverage = 10.0;
constexpr double kRemovedShare = 0.4;  // of all tasks at most, where there are few
constexpr double kLongestString = 10.0;
constexpr double kSplitShare = 0.5;
constexpr double kSplitGrowth = 0.01;
constexpr double kBlink = 0.01;
// Temperatures, in mean costs of a way to a near task (theirs are 100 and 1 on a 1000 x 1000 grid).
constexpr double kHot = 1.0;
constexpr double kCold = 0.01;
constexpr double kGenerousShare = 0.2;
constexpr long kPollEvery = 100;

double temperature_unit(const Model& model, const NearTasks& near) {
  double sum = 0.0;
  int count = 0;
  for (int t = 0; t < model.tasks(); ++t) {
    const auto& others = near[static_cast<std::size_t>(t)];
    for (std::size_t i = 0; i < std::min<std::size_t>(5, others.size()); ++i) {
      const TourLeg& leg = model.way(0, model.mode({t, 0}).exit, model.mode({others[i], 0}).entry);
      if (!(leg.cost < kNever)) continue;
      sum += std::abs(leg.cost + model.duration_price() * leg.duration_s);
      ++count;
    }
    if (model.task(t).reward < kNever) {
      sum += 0.2 * model.task(t).reward;
      ++count;
    }
  }
  return count > 0 ? std::max(sum / count, 1e-12) : 1.0;
}

}  // namespace

RuinRecreate::RuinRecreate(const Model& model, const NearTasks& near, FleetPlan& plan,
                           std::uint64_t seed, const Control& control)
    : model_(model),
      near_(near),
      plan_(plan),
      random_(seed, "tour"),
      control_(control),
      absent_count_(static_cast<std::size_t>(model.tasks()), 0) {
  for (int t = 0; t < model.tasks(); ++t) {
    const TourLeg& leg = model.way(0, model.kind(0).vehicle.start, model.mode({t, 0}).entry);
    distance_.push_back(leg.cost + 1e-6 * leg.duration_s);
  }
}

bool RuinRecreate::poll() {
  if (++rounds_ % kPollEvery != 0) return !stopped_;
  if (control_.stop && control_.stop()) stopped_ = true;
  if (control_.progress && best_cost_ < kNever) {
    control_.progress(std::min(1.0, static_cast<double>(rounds_) / static_cast<double>(expected_)),
                      best_cost_);
  }
  return !stopped_;
}

void RuinRecreate::construct() {
  recreate(0.0);
  plan_.keep();
}

std::vector<int> RuinRecreate::missing() const {
  std::vector<int> tasks;
  for (int t = 0; t < model_.tasks(); ++t) {
    if (plan_.absent(t) && model_.task(t).reward == kNever) tasks.push_back(t);
  }
  return tasks;
}

double RuinRecreate::absences(const std::vector<int>& tasks) const {
  double sum = 0.0;
  for (const int t : tasks) sum += static_cast<double>(absent_count_[static_cast<std::size_t>(t)]);
  return sum;
}

// Their fleet minimisation: a plan is taken over if fewer tasks stay out, or such as stayed out
// less often before.
bool RuinRecreate::place_all(long rounds) {
  std::vector<int> out = missing();
  for (long i = 0; i < rounds && !out.empty() && poll(); ++i) {
    const double before = plan_.cost();
    ruin();
    recreate(kBlink);
    const std::vector<int> now = missing();
    const double after = plan_.cost();
    const bool better =
        now.size() < out.size() || absences(now) < absences(out) || (now == out && after <= before);
    for (const int t : now) ++absent_count_[static_cast<std::size_t>(t)];
    if (after < kNever && better) {
      plan_.keep();
      out = now;
    } else {
      plan_.undo();
    }
  }
  return out.empty();
}

// The vehicle whose tasks were the easiest to place.
int RuinRecreate::cheapest_to_save() const {
  int best = -1;
  double least = kNever;
  for (int v = 0; v < plan_.vehicles(); ++v) {
    const RouteState& route = plan_.route(v);
    if (route.visits.empty() || model_.kind(route.kind).vehicle.fixed_cost <= 0.0) continue;
    double sum = 0.0;
    for (const Visit visit : route.visits) {
      sum += 1.0 + static_cast<double>(absent_count_[static_cast<std::size_t>(visit.task)]);
    }
    if (sum < least) {
      least = sum;
      best = v;
    }
  }
  return best;
}

void RuinRecreate::save_vehicles(long rounds) {
  double load = 0.0;
  double most = 0.0;
  for (int t = 0; t < model_.tasks(); ++t) load += model_.task(t).demand;
  for (const VehicleKind& kind : model_.kinds()) {
    most = std::max(most, kind.vehicle.load_capacity);
  }
  while (!stopped_ && plan_.used_vehicles() > 1) {
    const int fewer = plan_.used_vehicles() - 1;
    const int victim = cheapest_to_save();
    if (victim < 0 || static_cast<double>(fewer) * most < load) break;
    const auto before = plan_.visits();
    const double cost = plan_.cost();
    plan_.set_route(victim, {});
    plan_.keep();
    plan_.limit_vehicles(fewer);
    const bool placed = place_all(rounds);
    if (!placed || plan_.cost() >= cost) {
      plan_.limit_vehicles(plan_.vehicles());
      plan_.restore(before);
      break;
    }
  }
  plan_.limit_vehicles(plan_.vehicles());
}

long RuinRecreate::anneal(long rounds, long labels) {
  const double unit = temperature_unit(model_, near_);
  const long labels_before = plan_.labels_made();
  double current = plan_.cost();
  double best = current;
  auto best_visits = plan_.visits();
  const std::size_t out = missing().size();
  long i = 0;
  for (; i < rounds; ++i) {
    const double done = std::max(
        static_cast<double>(i) / static_cast<double>(rounds),
        static_cast<double>(plan_.labels_made() - labels_before) / static_cast<double>(labels));
    if (done >= 1.0) break;
    const double temperature = unit * kHot * std::pow(kCold / kHot, done);
    best_cost_ = std::min(best_cost_, best);
    if (!poll()) break;
    ruin();
    recreate(kBlink);
    const double cost = plan_.cost();
    const double limit = current - temperature * std::log(1.0 - random_.uniform());
    if (cost < limit && missing().size() <= out) {
      plan_.keep();
      current = cost;
      if (cost < best - model_.cost_slack()) {
        best = cost;
        best_visits = plan_.visits();
      }
    } else {
      plan_.undo();
    }
  }
  plan_.restore(best_visits);
  return i;
}

// Strings around a random task, one from each of several routes (several from one where there are
// too few).
void RuinRecreate::ruin() {
  const int n = model_.tasks();
  const int absent = static_cast<int>(absent_.size());
  const int routes = std::max(1, plan_.used_vehicles());
  const double mean_size = static_cast<double>(n - absent) / routes;
  const double longest =
      std::max(1.0, std::min({kLongestString, mean_size, 2.0 * kRemovedShare * n}));
  const double removed_tasks = std::min(kRemovedOnAverage, 1.0 + kRemovedShare * n);
  const double most_strings = std::max(1.0, 4.0 * removed_tasks / (1.0 + longest) - 1.0);
  const int strings = static_cast<int>(random_.uniform(1.0, most_strings + 1.0));
  std::vector<int> ruined;
  const int seed = random_.index(n);
  int removed = 0;
  const auto take = [&](int task) {
    const FleetPlan::Place at = plan_.place(task);
    if (at.vehicle < 0 || removed >= strings) return;
    const bool again = std::find(ruined.begin(), ruined.end(), at.vehicle) != ruined.end();
    if (again && routes > strings) return;
    const double size = plan_.route(at.vehicle).size();
    const int length = static_cast<int>(random_.uniform(1.0, std::min(size, longest) + 1.0));
    remove_string(task, length);
    ruined.push_back(at.vehicle);
    ++removed;
  };
  take(seed);
  for (const int task : near_[static_cast<std::size_t>(seed)]) take(task);
}

// A string of visits that holds the task; split: it spares some visits in its middle.
void RuinRecreate::remove_string(int task, int length) {
  const FleetPlan::Place at = plan_.place(task);
  const int size = plan_.route(at.vehicle).size();
  int spared = 0;
  if (length > 1 && length < size && random_.uniform() < kSplitShare) {
    spared = 1;
    while (length + spared < size && random_.uniform() > kSplitGrowth) ++spared;
  }
  const int span = length + spared;
  const int low = std::max(0, at.position - span + 1);
  const int high = std::min(at.position, size - span);
  const int first = low + random_.index(high - low + 1);
  const int gap = spared > 0 ? 1 + random_.index(length - 1) : length;  // visits before the spared
  std::vector<int> positions;
  for (int i = 0; i < span; ++i) {
    if (i >= gap && i < gap + spared) continue;
    positions.push_back(first + i);
  }
  plan_.remove(at.vehicle, positions);
}

void RuinRecreate::sort_absent() {
  const bool windows = model_.windows();
  constexpr Order kOrders[] = {Order::kRandom, Order::kRandom, Order::kRandom, Order::kRandom,
                               Order::kDemand, Order::kDemand, Order::kReward, Order::kReward,
                               Order::kFar,    Order::kFar,    Order::kClose,  Order::kEarly,
                               Order::kEarly,  Order::kNarrow, Order::kNarrow};
  const Order order = kOrders[random_.index(windows ? 15 : 11)];
  for (std::size_t i = absent_.size(); i > 1; --i) {
    std::swap(absent_[i - 1],
              absent_[static_cast<std::size_t>(random_.index(static_cast<int>(i)))]);
  }
  const auto key = [&](int t) {
    const TourTask& task = model_.task(t);
    switch (order) {
      case Order::kDemand:
        return -task.demand;
      case Order::kReward:
        return -task.reward;
      case Order::kFar:
        return -distance(t);
      case Order::kClose:
        return distance(t);
      case Order::kEarly:
        return task.latest_s;
      case Order::kNarrow:
        return task.latest_s - task.earliest_s;
      default:
        return 0.0;
    }
  };
  std::stable_sort(absent_.begin(), absent_.end(), [&](int a, int b) { return key(a) < key(b); });
}

void RuinRecreate::recreate(double blink) {
  absent_.clear();
  for (int t = 0; t < model_.tasks(); ++t) {
    if (plan_.absent(t)) absent_.push_back(t);
  }
  sort_absent();
  // What does not pay by itself may pay with others: now and then it is put in all the same.
  const bool generous = blink > 0.0 && random_.uniform() < kGenerousShare;
  const double worth = generous ? 1.0 / (1.0 - random_.uniform()) : 1.0;
  for (const int task : absent_) {
    const FleetPlan::Insertion best = plan_.best_insertion(task, blink, random_);
    if (best.vehicle >= 0 && best.change < worth * model_.task(task).reward) {
      plan_.insert(best);
    }
  }
  std::erase_if(absent_, [&](int task) { return !plan_.absent(task); });
}

}  // namespace headland::tour
