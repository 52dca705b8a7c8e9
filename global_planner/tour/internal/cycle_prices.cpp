// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/cycle_prices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace headland::tour {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// A set of nodes with a price for leaving it.
struct Set {
  std::vector<int> inside;
  std::vector<int> outside;
  std::vector<bool> holds;
  double price = 0.0;
};

class Ascent {
 public:
  explicit Ascent(const CostMatrix& costs) : priced_{costs} {}

  // How many arcs of the assignment leave the set; a tour's at least one.
  int leaving(const Set& set, const Successors& next) const {
    return static_cast<int>(std::count_if(set.inside.begin(), set.inside.end(),
                                          [&](int i) { return !set.holds[at(next[at(i)])]; }));
  }

  void add_cycles(const Successors& next) {
    std::vector<bool> seen(next.size(), false);
    for (int first = 0; first < std::ssize(next); ++first) {
      if (seen[at(first)]) continue;
      Set set;
      set.holds.assign(next.size(), false);
      for (int node = first; !seen[at(node)]; node = next[at(node)]) {
        seen[at(node)] = set.holds[at(node)] = true;
      }
      for (int node = 0; node < std::ssize(next); ++node) {
        (set.holds[at(node)] ? set.inside : set.outside).push_back(node);
      }
      if (!set.outside.empty() && known_.emplace(set.holds, 0).second) {
        sets_.push_back(std::move(set));
      }
    }
  }

  // One step along the subgradient.
  void step(const Successors& next, double length) {
    double norm = 0.0;
    std::vector<int> slack(sets_.size());
    for (std::size_t s = 0; s < sets_.size(); ++s) {
      slack[s] = 1 - leaving(sets_[s], next);
      if (slack[s] < 0 && sets_[s].price == 0.0) slack[s] = 0;
      norm += slack[s] * slack[s];
    }
    if (norm == 0.0) return;
    for (std::size_t s = 0; s < sets_.size(); ++s) {
      if (slack[s] == 0) continue;
      set_price(sets_[s], std::max(0.0, sets_[s].price + length / norm * slack[s]));
    }
  }

  const PricedCosts& priced() const { return priced_; }

 private:
  void set_price(Set& set, double price) {
    const double change = price - set.price;
    if (change == 0.0) return;
    for (const int i : set.inside) {
      for (const int j : set.outside) priced_.costs.at(i, j) -= change;
    }
    priced_.offset += change;
    set.price = price;
  }

  PricedCosts priced_;
  std::vector<Set> sets_;
  std::map<std::vector<bool>, int> known_;
};

}  // namespace

PricedCosts price_cycles(const CostMatrix& costs, double target, int rounds,
                         const std::function<bool()>& stop) {
  Ascent ascent(costs);
  PricedCosts best{costs};
  best.bound = -kInfinity;
  double scale = 1.0;
  int since = 0;
  for (int round = 0; round < rounds && scale > 1e-4; ++round) {
    if (stop && stop()) break;
    Assignment assignment;
    if (!assign(ascent.priced().costs, assignment)) break;
    const double bound = assignment.bound() + ascent.priced().offset;
    if (bound > best.bound) {
      best = ascent.priced();
      best.bound = bound;
      since = 0;
    } else if (++since > 15) {
      scale *= 0.7;
      since = 0;
    }
    ascent.add_cycles(assignment.column_of);
    ascent.step(assignment.column_of, scale * std::max(target - bound, 1e-9 * std::abs(target)));
  }
  return best;
}

}  // namespace headland::tour
