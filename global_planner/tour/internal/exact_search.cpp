// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/exact_search.hpp"

#include <algorithm>
#include <bit>

#include "global_planner/tour/internal/completion_bound.hpp"
#include "global_planner/tour/internal/labels.hpp"
#include "global_planner/tour/internal/partition.hpp"

namespace headland::tour {
namespace {

constexpr int kPollEvery = 256;  // sets of labels between two questions whether to stop

// A visit and the ones before it.
struct Step {
  Visit visit;
  int before = -1;
};

// The cheapest routes of one kind of vehicle for every set of tasks.
class RouteSearch {
 public:
  RouteSearch(const Model& model, int kind, const CompletionBound& bound, const ExactLimits& limits)
      : model_(model),
        kind_(model.kind(kind)),
        crossing_(model, kind, Crossing::Effort::kExact),
        bound_(bound),
        limits_(limits),
        kind_index_(kind) {
    for (int t = 0; t < model.tasks(); ++t) {
      for (int m = 0; m < model.modes(t); ++m) visits_.push_back({t, m});
    }
    set_of_.assign((std::size_t{1} << model.tasks()) * visits_.size(), -1);
    routes_.resize(std::size_t{1} << model.tasks());
  }

  // Sets of k tasks before those of k + 1. False if it took too long.
  bool run() {
    LabelSet start;
    crossing_.start(start);
    start.labels.front().cost = kind_.vehicle.fixed_cost;
    extend(start, 0U, kind_.vehicle.start);
    for (std::vector<Node> level = take_next(); !level.empty(); level = take_next()) {
      for (const Node& node : level) {
        if (++polled_ % kPollEvery == 0 && limits_.stop && limits_.stop()) return false;
        if (crossing_.labels_made() > limits_.effort) return false;
        const int exit = model_.mode(visits_[node.last]).exit;
        finish(node.labels, node.mask, exit);
        extend(node.labels, node.mask, exit);
      }
    }
    return true;
  }

  long effort() const { return crossing_.labels_made(); }
  RouteTable table() { return std::move(routes_); }
  std::vector<Visit> visits(int step) const {
    std::vector<Visit> order;
    for (; step >= 0; step = steps_[static_cast<std::size_t>(step)].before) {
      order.push_back(steps_[static_cast<std::size_t>(step)].visit);
    }
    std::reverse(order.begin(), order.end());
    return order;
  }

 private:
  struct Node {
    unsigned mask = 0;
    std::size_t last = 0;  // of visits_
    LabelSet labels;
  };

  std::vector<Node> take_next() {
    for (const Node& node : next_) {
      set_of_[node.mask * visits_.size() + node.last] = -1;
    }
    return std::exchange(next_, {});
  }

  double load(unsigned mask) const {
    double sum = 0.0;
    for (int t = 0; t < model_.tasks(); ++t) {
      if (mask >> t & 1U) sum += model_.task(t).demand;
    }
    return sum;
  }

  double value(const Label& label, double time) const {
    return label.cost + model_.problem().duration_weight * (time - kind_.vehicle.earliest_s);
  }

  // Whether no way of going on can lead to less than the upper bound.
  bool hopeless(const Label& label, double time, Visit last, unsigned mask) const {
    const double least = value(label, time) + model_.problem().span_weight * time;
    return least + bound_.rest(kind_index_, last, time, mask) >= limits_.upper_bound;
  }

  void extend(const LabelSet& from, unsigned mask, int site) {
    for (std::size_t last = 0; last < visits_.size(); ++last) {
      const Visit visit = visits_[last];
      const unsigned with = mask | 1U << visit.task;
      if (with == mask || load(with) > kind_.vehicle.load_capacity * (1.0 + 1e-12)) continue;
      if (too_late(from, site, visit)) continue;
      crossing_.clear_log();
      crossing_.cross(from, site, model_.mode(visit).entry, {}, arrived_);
      crossing_.work(arrived_, visit, worked_);
      for (const Label& label : worked_.labels) {
        if (hopeless(label, worked_.curve(label).front().time_s, visit, with)) continue;
        LabelSet& to = node(with, last).labels;
        if (!crossing_.dominance().add(to, label, worked_.curve(label))) continue;
        const int before = from.labels[static_cast<std::size_t>(label.before)].before;
        to.labels.back().before = static_cast<int>(steps_.size());
        steps_.push_back({visit, before});
      }
    }
  }

  bool too_late(const LabelSet& from, int site, Visit visit) const {
    if (!model_.windows() || !kind_.detours_never_pay) return false;
    double time = kNever;
    for (const Label& label : from.labels) {
      time = std::min(time, from.curve(label).front().time_s);
    }
    const TourLeg& way = model_.way(kind_index_, site, model_.mode(visit).entry);
    return time + way.duration_s > model_.task(visit.task).latest_s + model_.time_slack();
  }

  Node& node(unsigned mask, std::size_t last) {
    int& index = set_of_[mask * visits_.size() + last];
    if (index < 0) {
      index = static_cast<int>(next_.size());
      next_.push_back({mask, last, {}});
    }
    return next_[static_cast<std::size_t>(index)];
  }

  void finish(const LabelSet& from, unsigned mask, int site) {
    crossing_.clear_log();
    crossing_.finish(from, site, arrived_);
    for (const Label& label : arrived_.labels) {
      const double time = arrived_.curve(label).front().time_s;
      if (time > kind_.vehicle.latest_s + model_.time_slack()) continue;
      const int step = from.labels[static_cast<std::size_t>(label.before)].before;
      add_share(routes_[mask], {value(label, time), time, step, 0, 0},
                model_.problem().span_weight > 0.0);
    }
  }

  const Model& model_;
  const VehicleKind& kind_;
  Crossing crossing_;
  const CompletionBound& bound_;
  const ExactLimits& limits_;
  int kind_index_;
  int polled_ = 0;
  std::vector<Visit> visits_;
  std::vector<int> set_of_;  // index into next_ of each (set, visit); -1: none
  std::vector<Node> next_;
  std::vector<Step> steps_;
  RouteTable routes_;
  LabelSet arrived_;
  LabelSet worked_;
};

}  // namespace

ExactAnswer exact_search(const Model& model, const ExactLimits& limits) {
  const CompletionBound bound(model);
  std::vector<RouteSearch> searches;
  std::vector<RouteTable> tables;
  ExactLimits left = limits;
  for (int k = 0; k < static_cast<int>(model.kinds().size()); ++k) {
    searches.emplace_back(model, k, bound, left);
    if (!searches.back().run()) return {};
    left.effort -= searches.back().effort();
    tables.push_back(searches.back().table());
  }
  ExactAnswer answer;
  const std::optional<Partition> partition = cheapest_partition(model, tables);
  answer.complete = true;
  answer.cost = limits.upper_bound;
  if (!partition || partition->cost >= limits.upper_bound) return answer;
  answer.cost = partition->cost;
  for (const auto& [kind, step] : partition->routes) {
    answer.routes.push_back({kind, searches[static_cast<std::size_t>(kind)].visits(step)});
  }
  return answer;
}

}  // namespace headland::tour
