// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/recharge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "core/base/error.hpp"

namespace headland {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-9;  // share of the capacity that sums of energies may be off by
constexpr double kJoulesPerWattHour = 3600.0;

// After a stop the battery is full, so that the rest of a plan depends on nothing but where the
// last stop was: a shortest path over stops, in the order of their gaps.
class Solver {
 public:
  explicit Solver(const RechargeProblem& problem)
      : problem_(problem),
        items_(static_cast<int>(problem.item_energy_j.size())),
        chargers_(static_cast<int>(problem.stop_cost_per_j.size())),
        floor_(problem.reserve_j - kRounding * problem.capacity_j),
        stops_(static_cast<std::size_t>((items_ + 1) * chargers_)) {}

  Result<RechargePlan> solve() {
    drive(kStart, 0, {0.0, 0.0}, problem_.start_energy_j, 0.0);
    for (int gap = 0; gap <= items_; ++gap) {
      for (int c = 0; c < chargers_; ++c) {
        const double cost = stop(gap, c).cost;
        if (cost == kInfinity) continue;
        drive(index(gap, c), gap, at(gap).from_charger[static_cast<std::size_t>(c)],
              problem_.capacity_j, cost);
      }
    }
    if (finish_.cost == kInfinity) return shortage();
    return plan();
  }

 private:
  static constexpr int kStart = -1;

  struct Label {
    double cost = kInfinity;  // of the plan up to here, this stop's charge included
    int before = kStart;      // the stop before
  };

  const RechargeProblem::Gap& at(int gap) const {
    return problem_.gaps[static_cast<std::size_t>(gap)];
  }
  int index(int gap, int charger) const { return gap * chargers_ + charger; }
  Label& stop(int gap, int charger) {
    return stops_[static_cast<std::size_t>(index(gap, charger))];
  }

  // Takes `energy` out of the battery, which never holds more than it can; false below the reserve.
  bool spend(double energy, double& battery) const {
    battery = std::min(battery - energy, problem_.capacity_j);
    return battery >= floor_;
  }

  // Drives on from a stop (or the start), whose way to item `gap` is `way`, without charging for as
  // long as the battery lasts, and offers the plan so far to every charger on the way and to the
  // finish.
  void drive(int from, int gap, RechargeProblem::Way way, double battery, double cost) {
    if (from == kStart) {
      offer_chargers(from, gap, battery, cost);
      way = at(gap).direct;
    }
    while (true) {
      cost += way.cost;
      if (!(cost < kInfinity)) return;
      const bool arrived = spend(way.energy_j, battery);
      if (gap == items_) {
        if (!arrived) return note_shortage(gap, battery);
        if (cost < finish_.cost) finish_ = {cost, from};
        return;
      }
      const double on_arrival = battery;
      const bool done =
          spend(problem_.item_energy_j[static_cast<std::size_t>(gap)], battery) && arrived;
      if (!done) return note_shortage(gap, std::min(battery, on_arrival));
      ++gap;
      served_ = std::max(served_, gap);
      offer_chargers(from, gap, battery, cost);
      way = at(gap).direct;
    }
  }

  void offer_chargers(int from, int gap, double battery, double cost) {
    for (int c = 0; c < chargers_; ++c) {
      const RechargeProblem::Way& way = at(gap).to_charger[static_cast<std::size_t>(c)];
      if (!(way.cost < kInfinity)) continue;
      double left = battery;
      if (!spend(way.energy_j, left)) {
        note_shortage(gap, left);
        continue;
      }
      const double charge =
          problem_.stop_cost +
          problem_.stop_cost_per_j[static_cast<std::size_t>(c)] * (problem_.capacity_j - left);
      const double total = cost + way.cost + charge;
      if (total < stop(gap, c).cost) stop(gap, c) = {total, from};
    }
  }

  // Remembers the smallest shortage on the way to each item.
  void note_shortage(int gap, double battery) {
    shortage_j_.resize(static_cast<std::size_t>(items_) + 1, kInfinity);
    double& least = shortage_j_[static_cast<std::size_t>(gap)];
    least = std::min(least, problem_.reserve_j - battery);
  }

  RechargePlan plan() const {
    RechargePlan result;
    result.cost = finish_.cost;
    for (int s = finish_.before; s != kStart; s = stops_[static_cast<std::size_t>(s)].before) {
      result.stops.push_back({s / chargers_, s % chargers_});
    }
    std::reverse(result.stops.begin(), result.stops.end());
    return result;
  }

  tl::unexpected<Error> shortage() const {
    const std::string what = served_ < items_ ? fmt::format("item {}", served_) : "the finish";
    const auto gap = static_cast<std::size_t>(served_);
    const double missing = gap < shortage_j_.size() ? shortage_j_[gap] : kInfinity;
    if (missing == kInfinity) {
      return fail(ErrorCode::kNoPath,
                  fmt::format("no way leads to {} from what lies before it", what),
                  "add a gate or road, or leave the item out");
    }
    return fail(
        ErrorCode::kEnergyInfeasible,
        fmt::format("{}: the battery is short of {:.1f} Wh in every plan (capacity {:.1f} "
                    "Wh, reserve {:.1f} Wh)",
                    what, missing / kJoulesPerWattHour, problem_.capacity_j / kJoulesPerWattHour,
                    problem_.reserve_j / kJoulesPerWattHour),
        "a larger battery, a charger nearer by, a smaller reserve, or less work in one item");
  }

  const RechargeProblem& problem_;
  int items_;
  int chargers_;
  double floor_;
  std::vector<Label> stops_;
  Label finish_;
  int served_ = 0;  // items that some plan serves
  std::vector<double> shortage_j_;
};

void check(const RechargeProblem& problem) {
  const auto chargers = problem.stop_cost_per_j.size();
  bool ok = problem.gaps.size() == problem.item_energy_j.size() + 1;
  for (const auto& gap : problem.gaps) {
    ok = ok && gap.to_charger.size() == chargers && gap.from_charger.size() == chargers;
  }
  if (!ok) {
    throw std::invalid_argument(
        fmt::format("recharge: {} items need {} gaps with {} ways to and from chargers in each",
                    problem.item_energy_j.size(), problem.item_energy_j.size() + 1, chargers));
  }
  if (!(problem.reserve_j >= 0.0 && problem.reserve_j < problem.capacity_j &&
        problem.start_energy_j <= problem.capacity_j)) {
    throw std::invalid_argument(
        fmt::format("recharge: needs 0 <= reserve < capacity and start <= capacity, got reserve {} "
                    "J, capacity {} J, start {} J",
                    problem.reserve_j, problem.capacity_j, problem.start_energy_j));
  }
}

}  // namespace

Result<RechargePlan> plan_recharges(const RechargeProblem& problem) {
  check(problem);
  return Solver(problem).solve();
}

int min_charge_stops(const RechargeBound& bound) {
  const double short_by = bound.energy_j - bound.start_j;
  if (short_by <= kRounding * std::abs(bound.energy_j)) return 0;
  if (!(bound.per_charge_j > 0.0)) return -1;
  return static_cast<int>(std::ceil(short_by / bound.per_charge_j - kRounding));
}

double recharge_lower_bound(const RechargeBound& bound) {
  const int stops = min_charge_stops(bound);
  return stops < 0 ? kInfinity : stops * std::max(bound.detour_cost, 0.0);
}

}  // namespace headland
