// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/one_way_tour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "global_planner/tour/internal/local_search.hpp"

namespace headland::tour {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kNeighbours = 10;
// Settled by trial on TSPLIB's instances, each part a few seconds at most. A node of the tree takes
// a few n^2 steps, an assignment n^3 at worst.
constexpr double kFirstTreeSteps = 5e8;
constexpr double kTreeSteps = 4e9;
constexpr double kPriceSteps = 3e9;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

CostMatrix cycle_costs(const RowTourProblem& problem) {
  const int depot = problem.rows();
  CostMatrix costs(depot + 1, kInfinity);
  for (int a = 0; a < depot; ++a) {
    costs.at(depot, a) = problem.start[2 * a];
    costs.at(a, depot) = problem.finish[2 * a + 1];
    for (int b = 0; b < depot; ++b) {
      if (a != b) costs.at(a, b) = problem.transition(2 * a + 1, 2 * b);
    }
  }
  return costs;
}

bool whole(const CostMatrix& costs) {
  return std::all_of(costs.cost.begin(), costs.cost.end(),
                     [](double cost) { return cost == kInfinity || cost == std::floor(cost); });
}

// For each end the ends that cost least beyond the assignment's prices, cheapest way first.
Neighbours priced_neighbours(const CostMatrix& costs, const PricedCosts& priced) {
  Assignment prices;
  assign(priced.costs, prices);
  const auto n = at(costs.size);
  Neighbours neighbours(2 * n);
  std::vector<int> nodes(n);
  for (int node = 0; node < costs.size; ++node) {
    for (const bool leaving : {true, false}) {
      const auto cost = [&](int other) {
        return leaving ? costs.at(node, other) : costs.at(other, node);
      };
      const auto reduced = [&](int other) {
        return (leaving ? priced.costs.at(node, other) : priced.costs.at(other, node)) -
               (leaving ? prices.column_price : prices.row_price)[at(other)];
      };
      std::iota(nodes.begin(), nodes.end(), 0);
      const auto last = nodes.begin() + static_cast<std::ptrdiff_t>(std::min(kNeighbours, n));
      std::partial_sort(nodes.begin(), last, nodes.end(), [&](int a, int b) {
        return reduced(a) < reduced(b) || (reduced(a) == reduced(b) && a < b);
      });
      auto& list = neighbours[2 * at(node) + (leaving ? 1 : 0)];
      for (auto other = nodes.begin(); other != last; ++other) {
        if (!(cost(*other) < kInfinity)) continue;
        list.push_back({2 * *other + (leaving ? 0 : 1), static_cast<float>(cost(*other))});
      }
      std::stable_sort(list.begin(), list.end(),
                       [](const Neighbour& a, const Neighbour& b) { return a.cost < b.cost; });
    }
  }
  return neighbours;
}

Successors improved(const RowTourProblem& problem, const Neighbours& neighbours,
                    const Successors& known, double stop_cost, int kicks,
                    const OneWaySearch& search) {
  const Cycle cycle(problem);
  const int depot = problem.rows();
  Entries entries{2 * depot};
  for (int node = known[at(depot)]; node != depot; node = known[at(node)]) {
    entries.push_back(2 * node);
  }
  entries =
      iterated_local_search(cycle, neighbours, entries, kicks, stop_cost, search.seed, search.stop);
  Successors next(known.size());
  for (std::size_t p = 0; p < entries.size(); ++p) {
    next[at(entries[p] / 2)] = entries[(p + 1) % entries.size()] / 2;
  }
  return next;
}

}  // namespace

TreeAnswer one_way_tour(const RowTourProblem& problem, const OneWaySearch& search) {
  const CostMatrix costs = cycle_costs(problem);
  const double n = costs.size;
  TreeSearch limits;
  limits.stop = search.stop;
  limits.improved = search.improved;
  limits.whole_costs = whole(costs);
  limits.most_nodes = 1 + std::lround(kFirstTreeSteps / (n * n));
  const TreeAnswer first = search_assignments(costs, {costs}, {}, limits);
  if (first.next.empty() || first.cost <= first.lower_bound) return first;

  // A quick descent sets the target of the prices; those tell the search proper what is worth
  // trying.
  const Successors quick = improved(problem, priced_neighbours(costs, {costs}), first.next,
                                    first.lower_bound, 50 + costs.size, search);
  const int rounds = static_cast<int>(std::clamp(kPriceSteps / (n * n * n), 20.0, 1500.0));
  const double target = std::min(first.cost, tour_length(costs, quick));
  const PricedCosts priced =
      price_cycles(costs, {target - first.lower_bound, rounds, search.stop, {}});
  const int kicks = search.iterations > 0 ? search.iterations : 20000 + 200 * costs.size;
  const Successors known = improved(problem, priced_neighbours(costs, priced), quick,
                                    std::max(priced.bound, first.lower_bound), kicks, search);
  limits.most_nodes = 1 + std::lround(kTreeSteps / (n * n));
  TreeAnswer answer = search_assignments(
      costs, priced, tour_length(costs, known) < first.cost ? known : first.next, limits);
  answer.lower_bound = std::max(answer.lower_bound, first.lower_bound);
  return answer;
}

}  // namespace headland::tour
