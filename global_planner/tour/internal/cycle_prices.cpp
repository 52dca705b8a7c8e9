// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/cycle_prices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace headland::tour {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kPatience = 15;  // rounds without a better bound before steps shrink

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// A rule with its price.
struct Set {
  LeavingRule rule;
  std::vector<int> outside;
  std::vector<bool> holds;
  double price = 0.0;
};

using Rules = std::vector<LeavingRule>;

class Ascent {
 public:
  explicit Ascent(const CostMatrix& costs) : priced_{costs} {}

  void add(Rules rules) {
    for (LeavingRule& rule : rules) {
      Set set;
      set.holds.assign(at(priced_.costs.size), false);
      for (const int node : rule.inside) set.holds[at(node)] = true;
      for (int node = 0; node < priced_.costs.size; ++node) {
        if (!set.holds[at(node)]) set.outside.push_back(node);
      }
      if (set.outside.empty() || !known_.emplace(set.holds).second) continue;
      set.rule = std::move(rule);
      sets_.push_back(std::move(set));
    }
  }

  // One step along the subgradient.
  void step(const Successors& next, double length) {
    double norm = 0.0;
    std::vector<int> slack(sets_.size());
    for (std::size_t s = 0; s < sets_.size(); ++s) {
      slack[s] = sets_[s].rule.times - leaving(sets_[s], next);
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
  static int leaving(const Set& set, const Successors& next) {
    return static_cast<int>(
        std::count_if(set.rule.inside.begin(), set.rule.inside.end(), [&](int i) {
          return !set.holds[at(next[at(i)])] || (i == set.rule.keeper && next[at(i)] == i);
        }));
  }

  void set_price(Set& set, double price) {
    const double change = price - set.price;
    if (change == 0.0) return;
    for (const int i : set.rule.inside) {
      for (const int j : set.outside) priced_.costs.at(i, j) -= change;
    }
    if (set.rule.keeper >= 0) priced_.costs.at(set.rule.keeper, set.rule.keeper) -= change;
    priced_.offset += set.rule.times * change;
    set.price = price;
  }

  PricedCosts priced_;
  std::vector<Set> sets_;
  std::set<std::vector<bool>> known_;
};

}  // namespace

PricedCosts price_cycles(const CostMatrix& costs, const PriceAscent& how) {
  Ascent ascent(costs);
  PricedCosts best{costs};
  best.bound = -kInfinity;
  double scale = 1.0;
  int since = 0;
  for (int round = 0; round < how.rounds && scale > 1e-4; ++round) {
    if (how.stop && how.stop()) break;
    Assignment assignment;
    if (!assign(ascent.priced().costs, assignment)) break;
    const double bound = assignment.bound() + ascent.priced().offset;
    const double target = std::max(best.bound, bound) + how.reach;
    if (bound > best.bound) {
      best = ascent.priced();
      best.bound = bound;
      since = 0;
    } else if (++since > kPatience) {
      scale *= 0.7;
      since = 0;
    }
    Rules rules;
    for (const auto& cycle : cycles_of(assignment.column_of)) {
      if (how.rules) {
        how.rules(cycle, rules);
      } else {
        rules.push_back({cycle});
      }
    }
    ascent.add(std::move(rules));
    ascent.step(assignment.column_of, scale * (target - bound));
  }
  return best;
}

}  // namespace headland::tour
