// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/completion_bound.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace headland::tour {
namespace {

constexpr int kPriceSteps = 300;

using Matrix = std::vector<std::vector<double>>;

// The sites that matter: of the start, the finish, visits, stations, in this order.
std::vector<int> sites_of(const Model& model, const VehicleKind& kind) {
  std::vector<int> sites{kind.vehicle.start, kind.vehicle.finish};
  for (int t = 0; t < model.tasks(); ++t) {
    for (const TourMode& mode : model.task(t).modes) {
      sites.push_back(mode.entry);
      sites.push_back(mode.exit);
    }
  }
  for (const int s : kind.stations) sites.push_back(model.station_site(s));
  return sites;
}

// Least sums between sites, with those from index `through` on as stops between (Floyd-Warshall).
Matrix closure(const std::vector<int>& sites, std::size_t through,
               const std::function<double(int, int)>& length) {
  Matrix least(sites.size(), std::vector<double>(sites.size()));
  for (std::size_t a = 0; a < sites.size(); ++a) {
    for (std::size_t b = 0; b < sites.size(); ++b) least[a][b] = length(sites[a], sites[b]);
  }
  for (std::size_t c = through; c < sites.size(); ++c) {
    for (auto& row : least) {
      for (std::size_t b = 0; b < sites.size(); ++b) {
        row[b] = std::min(row[b], row[c] + least[c][b]);
      }
    }
  }
  return least;
}

}  // namespace

CompletionBound::CompletionBound(const Model& model)
    : model_(model),
      tasks_(model.tasks()),
      arc_(static_cast<std::size_t>(tasks_),
           std::vector<double>(static_cast<std::size_t>(tasks_), kNever)),
      price_(static_cast<std::size_t>(tasks_), 0.0) {
  int visits = 0;
  for (int t = 0; t < tasks_; ++t) {
    first_visit_.push_back(visits);
    visits += model.modes(t);
  }
  for (int k = 0; k < static_cast<int>(model.kinds().size()); ++k) add_kind(k);
  find_prices();
}

void CompletionBound::add_kind(int kind_index) {
  const VehicleKind& kind = model_.kind(kind_index);
  const double time_price = model_.problem().duration_weight;
  const std::vector<int> sites = sites_of(model_, kind);
  const std::size_t stations = sites.size() - kind.stations.size();
  const auto price = [&](const TourLeg& leg) { return leg.cost + time_price * leg.duration_s; };
  const Matrix cost =
      closure(sites, stations, [&](int a, int b) { return price(model_.way(kind_index, a, b)); });
  const Matrix time = closure(sites, model_.windows() ? 0 : sites.size(), [&](int a, int b) {
    const TourLeg& leg = model_.way(kind_index, a, b);
    return leg.cost < kNever ? leg.duration_s : kNever;
  });
  const auto entry = [&](int t, int m) {
    return static_cast<std::size_t>(2 + 2 * (first_visit_[static_cast<std::size_t>(t)] + m));
  };
  std::vector<double> first(static_cast<std::size_t>(tasks_), kNever);
  std::vector<double> finish(static_cast<std::size_t>(tasks_), kNever);
  for (int t = 0; t < tasks_; ++t) {
    const auto to = static_cast<std::size_t>(t);
    for (int m = 0; m < model_.modes(t); ++m) {
      const TourLeg& work = model_.work(kind_index, {t, m});
      if (!(work.cost < kNever)) continue;
      first[to] = std::min(first[to], kind.vehicle.fixed_cost + cost[0][entry(t, m)] + price(work));
      finish[to] = std::min(finish[to], cost[entry(t, m) + 1][1]);
      for (int p = 0; p < tasks_; ++p) {
        for (int i = 0; p != t && i < model_.modes(p); ++i) {
          const double arrival = model_.task(p).earliest_s +
                                 model_.work(kind_index, {p, i}).duration_s +
                                 time[entry(p, i) + 1][entry(t, m)];
          if (arrival > model_.task(t).latest_s + model_.time_slack()) continue;
          double& arc = arc_[static_cast<std::size_t>(p)][to];
          arc = std::min(arc, cost[entry(p, i) + 1][entry(t, m)] + price(work));
        }
      }
    }
  }
  first_.push_back(std::move(first));
  finish_.push_back(std::move(finish));
  Matrix between;  // exit of one visit, entry of another
  for (std::size_t from = 3; from < stations; from += 2) {
    between.emplace_back();
    for (std::size_t to = 2; to < stations; to += 2) between.back().push_back(time[from][to]);
  }
  way_time_.push_back(std::move(between));
}

// Subgradient ascent: tasks left by no one become cheaper to leave, tasks left by many dearer.
void CompletionBound::find_prices() {
  std::vector<int> leavings;
  std::vector<double> best = price_;
  whole_ = relax(leavings);
  double step = tasks_ > 0 ? 0.1 * std::abs(whole_) / tasks_ : 0.0;
  for (const auto& row : arc_) {
    for (const double arc : row) {
      if (arc < kNever) step = std::min(step, std::max(std::abs(arc), 1e-9));
    }
  }
  for (const auto& row : arc_) {
    const double least = row.empty() ? kNever : *std::min_element(row.begin(), row.end());
    if (least < kNever) step = std::max(step, std::abs(least));
  }
  for (int i = 0; i < kPriceSteps; ++i, step *= 0.98) {
    for (std::size_t t = 0; t < price_.size(); ++t) price_[t] += step * (1 - leavings[t]);
    const double value = relax(leavings);
    if (value <= whole_) continue;
    whole_ = value;
    best = price_;
  }
  price_ = best;
  relax(leavings);
}

// All choices at their least with the present prices.
double CompletionBound::relax(std::vector<int>& leavings) {
  const auto n = static_cast<std::size_t>(tasks_);
  leavings.assign(n, 0);
  cheapest_finish_.assign(finish_.size(), kNever);
  std::vector<int> finisher(finish_.size(), -1);
  for (std::size_t k = 0; k < finish_.size(); ++k) {
    for (std::size_t p = 0; p < n; ++p) {
      if (finish_[k][p] - price_[p] >= cheapest_finish_[k]) continue;
      cheapest_finish_[k] = finish_[k][p] - price_[p];
      finisher[k] = static_cast<int>(p);
    }
  }
  arrival_.assign(n, kNever);
  first_arrival_.assign(n, kNever);
  double sum = 0.0;
  for (std::size_t t = 0; t < n; ++t) {
    int from = -1;
    for (std::size_t k = 0; k < first_.size(); ++k) {
      const double arrival = first_[k][t] + cheapest_finish_[k] + price_[t];
      if (arrival >= first_arrival_[t]) continue;
      first_arrival_[t] = arrival;
      from = finisher[k];
    }
    arrival_[t] = first_arrival_[t];
    for (std::size_t p = 0; p < n; ++p) {
      if (arc_[p][t] - price_[p] + price_[t] >= arrival_[t]) continue;
      arrival_[t] = arc_[p][t] - price_[p] + price_[t];
      from = static_cast<int>(p);
    }
    const double reward = model_.task(static_cast<int>(t)).reward;
    if (arrival_[t] >= reward) {
      arrival_[t] = reward;
      ++leavings[t];  // left out: not a reason to change its price
    } else if (from >= 0) {
      ++leavings[static_cast<std::size_t>(from)];
    }
    sum += arrival_[t];
  }
  return sum;
}

bool CompletionBound::reachable(int kind, Visit last, double time_s, int task) const {
  const auto from =
      static_cast<std::size_t>(first_visit_[static_cast<std::size_t>(last.task)] + last.mode);
  const auto& times = way_time_[static_cast<std::size_t>(kind)][from];
  for (int m = 0; m < model_.modes(task); ++m) {
    const auto to = static_cast<std::size_t>(first_visit_[static_cast<std::size_t>(task)] + m);
    if (time_s + times[to] <= model_.task(task).latest_s + model_.time_slack()) return true;
  }
  return false;
}

double CompletionBound::rest(int kind, Visit last, double time_s, unsigned mask) const {
  double sum = cheapest_finish_[static_cast<std::size_t>(kind)] +
               price_[static_cast<std::size_t>(last.task)];
  double another = kNever;  // more, at least, if there is one more route: for its first task
  double late = 0.0;        // more, at most, for leaving out a task that this route cannot reach
  for (int t = 0; t < tasks_; ++t) {
    if (mask >> t & 1U) continue;
    const auto index = static_cast<std::size_t>(t);
    sum += arrival_[index];
    another = std::min(another, first_arrival_[index] - arrival_[index]);
    const double more = model_.task(t).reward - arrival_[index];
    if (model_.windows() && more > late && !reachable(kind, last, time_s, t)) late = more;
  }
  return late > 0.0 ? sum + std::min(another, late) : sum;
}

}  // namespace headland::tour
