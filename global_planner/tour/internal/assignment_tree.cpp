// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/assignment_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <queue>

namespace headland::tour {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-9;  // of a bound: what sums of prices may be off by
// Patching takes longer than an assignment's repair, and seldom finds more deep in the tree.
constexpr long kPatched = 2000;
constexpr long kPatchedEvery = 50;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Karp's patching: joins the smallest cycle to another by the cheapest exchange of one arc each,
// until one is left. Empty if no exchange is possible.
Successors patched(const CostMatrix& costs, Successors next) {
  Cycles cycles = cycles_of(next);
  std::vector<int> home(next.size());
  for (std::size_t c = 0; c < cycles.size(); ++c) {
    for (const int node : cycles[c]) home[at(node)] = static_cast<int>(c);
  }
  for (std::size_t left = cycles.size(); left > 1; --left) {
    const auto smaller = [](const auto& a, const auto& b) {
      return !a.empty() && (b.empty() || a.size() < b.size());
    };
    auto& small = *std::min_element(cycles.begin(), cycles.end(), smaller);
    double least = kInfinity;
    int inside = -1;
    int outside = -1;
    for (const int i : small) {
      const double removed = costs.at(i, next[at(i)]);
      for (int j = 0; j < costs.size; ++j) {
        if (home[at(j)] == home[at(i)]) continue;
        const double change = costs.at(i, next[at(j)]) + costs.at(j, next[at(i)]) - removed -
                              costs.at(j, next[at(j)]);
        if (change < least) {
          least = change;
          inside = i;
          outside = j;
        }
      }
    }
    if (inside < 0) return {};
    std::swap(next[at(inside)], next[at(outside)]);
    const int target = home[at(outside)];
    for (const int i : small) home[at(i)] = target;
    auto& big = cycles[at(target)];
    big.insert(big.end(), small.begin(), small.end());
    small.clear();
  }
  return next;
}

struct Arc {
  int from = 0;
  int to = 0;
};

// A node of the tree: its assignment, and by its ancestors which arcs are fixed.
struct Node {
  std::shared_ptr<const Node> parent;
  Arc excluded{-1, -1};
  std::vector<Arc> included;  // beyond the parent's
  Assignment assignment;
  double bound = 0.0;
  long number = 0;
};
using NodePtr = std::shared_ptr<Node>;

struct Later {
  bool operator()(const NodePtr& a, const NodePtr& b) const {
    return a->bound > b->bound || (a->bound == b->bound && a->number < b->number);
  }
};

class Search {
 public:
  Search(const CostMatrix& costs, const PricedCosts& priced, const TreeSearch& limits)
      : costs_(costs), priced_(priced), limits_(limits), restricted_(priced.costs) {}

  TreeAnswer run(const Successors& known) {
    answer_.cost = kInfinity;
    if (!known.empty()) adopt(known);
    auto root = std::make_shared<Node>();
    if (!assign(priced_.costs, root->assignment)) {
      answer_.lower_bound = kInfinity;
      return answer_;
    }
    add(std::move(root));
    while (!open_.empty() && count_ < limits_.most_nodes && open_.top()->bound < worth() &&
           open_.size() * node_bytes() < limits_.most_memory_bytes &&
           !(limits_.stop && limits_.stop())) {
      const NodePtr node = open_.top();
      open_.pop();
      branch(node);
    }
    answer_.lower_bound = open_.empty() || open_.top()->bound >= worth()
                              ? answer_.cost
                              : std::min(rounded(open_.top()->bound), answer_.cost);
    return answer_;
  }

 private:
  std::size_t node_bytes() const { return sizeof(Node) + at(costs_.size) * 24 + 64; }

  // A whole number, where all tours are; else a little less than the sum of prices.
  double rounded(double bound) const {
    const double safe = bound - kRounding * std::abs(bound);
    return limits_.whole_costs ? std::ceil(safe - 1e-6) : safe;
  }
  // Bounds of this or more hold no better tour.
  double worth() const {
    if (!(answer_.cost < kInfinity)) return kInfinity;
    if (limits_.whole_costs) return answer_.cost - 1.0 + 1e-6 * (1.0 + 1e-3 * answer_.cost);
    return answer_.cost - 2.0 * kRounding * std::abs(answer_.cost);
  }

  void adopt(const Successors& next) {
    const double cost = tour_length(costs_, next);
    if (!(cost < answer_.cost)) return;
    answer_.cost = cost;
    answer_.next = next;
    if (limits_.improved) limits_.improved(cost);
  }

  void add(NodePtr node) {
    ++count_;
    node->number = count_;
    node->bound = node->assignment.bound() + priced_.offset;
    if (node->bound >= worth()) return;
    if (count_ <= kPatched || count_ % kPatchedEvery == 0 ||
        cycles_of(node->assignment.column_of).size() == 1) {
      const Successors tour = patched(costs_, node->assignment.column_of);
      if (!tour.empty()) adopt(tour);
    }
    open_.push(std::move(node));
  }

  // The costs as the fixed arcs of a node leave them.
  void restrict_to(const Node& node, CostMatrix& costs, std::vector<bool>& fixed) const {
    std::vector<Arc> included;
    costs.cost = priced_.costs.cost;
    for (const Node* n = &node; n != nullptr; n = n->parent.get()) {
      if (n->excluded.from >= 0) costs.at(n->excluded.from, n->excluded.to) = kInfinity;
      included.insert(included.end(), n->included.begin(), n->included.end());
    }
    fixed.assign(at(costs.size), false);
    for (const Arc& arc : included) fix(arc, costs, fixed);
  }

  void fix(const Arc& arc, CostMatrix& costs, std::vector<bool>& fixed) const {
    fixed[at(arc.from)] = true;
    for (int k = 0; k < costs.size; ++k) {
      if (k != arc.to) costs.at(arc.from, k) = kInfinity;
      if (k != arc.from) costs.at(k, arc.to) = kInfinity;
    }
  }

  // The cycle with the fewest arcs that are not fixed.
  std::vector<int> cycle_to_break(const Node& node, const std::vector<bool>& fixed) const {
    const Cycles cycles = cycles_of(node.assignment.column_of);
    const auto free_arcs = [&](const std::vector<int>& cycle) {
      return std::count_if(cycle.begin(), cycle.end(), [&](int i) { return !fixed[at(i)]; });
    };
    return *std::min_element(cycles.begin(), cycles.end(), [&](const auto& a, const auto& b) {
      return free_arcs(a) < free_arcs(b);
    });
  }

  // Child k leaves out the k-th free arc of the cycle and keeps those before it. That is everything
  // but the cycle itself, which no tour contains, or which is a tour and was adopted when its node
  // was added (and may still be dearer than its bound, where it leaves a priced set twice).
  void branch(const NodePtr& node) {
    restrict_to(*node, restricted_, fixed_);
    const std::vector<int> cycle = cycle_to_break(*node, fixed_);
    std::vector<Arc> kept;
    for (const int from : cycle) {
      if (fixed_[at(from)]) continue;
      const Arc arc{from, node->assignment.column_of[at(from)]};
      auto child = std::make_shared<Node>();
      child->parent = node;
      child->excluded = arc;
      child->included = kept;
      child->assignment = node->assignment;
      child->assignment.column_of[at(arc.from)] = -1;
      child->assignment.row_of[at(arc.to)] = -1;
      const double cost = restricted_.at(arc.from, arc.to);
      restricted_.at(arc.from, arc.to) = kInfinity;
      if (augment(restricted_, child->assignment, arc.from)) add(std::move(child));
      restricted_.at(arc.from, arc.to) = cost;
      fix(arc, restricted_, fixed_);
      kept.push_back(arc);
    }
  }

  const CostMatrix& costs_;
  const PricedCosts& priced_;
  const TreeSearch& limits_;
  TreeAnswer answer_;
  std::priority_queue<NodePtr, std::vector<NodePtr>, Later> open_;
  CostMatrix restricted_;
  std::vector<bool> fixed_;
  long count_ = 0;
};

}  // namespace

double tour_length(const CostMatrix& costs, const Successors& next) {
  double length = 0.0;
  for (int i = 0; i < costs.size; ++i) length += costs.at(i, next[at(i)]);
  return length;
}

TreeAnswer search_assignments(const CostMatrix& costs, const PricedCosts& priced,
                              const Successors& known, const TreeSearch& limits) {
  return Search(costs, priced, limits).run(known);
}

}  // namespace headland::tour
