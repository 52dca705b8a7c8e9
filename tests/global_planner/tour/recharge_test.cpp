// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/recharge.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kWattHour = 3600.0;

// Items of 1 kJ, ways of 100 J for cost 1, and one charger that is 200 J and cost 2 away from
// everywhere.
RechargeProblem uniform_problem(int items, double capacity_j) {
  RechargeProblem problem;
  problem.item_energy_j.assign(static_cast<std::size_t>(items), 1000.0);
  problem.gaps.assign(static_cast<std::size_t>(items) + 1,
                      {{1.0, 100.0}, {{2.0, 200.0}}, {{2.0, 200.0}}});
  problem.stop_cost_per_j = {0.0};
  problem.capacity_j = capacity_j;
  problem.start_energy_j = capacity_j;
  return problem;
}

// Cost of driving with exactly these stops (charger or -1 in each gap), by the letter of the
// header; nothing if the battery falls below the reserve anywhere.
std::optional<double> simulate(const RechargeProblem& problem, const std::vector<int>& chosen) {
  double battery = problem.start_energy_j;
  double cost = 0.0;
  const auto go = [&](const RechargeProblem::Way& way) {
    cost += way.cost;
    battery = std::min(battery - way.energy_j, problem.capacity_j);
    return battery >= problem.reserve_j && cost < kInfinity;
  };
  for (std::size_t gap = 0; gap < problem.gaps.size(); ++gap) {
    if (chosen[gap] < 0) {
      if (!go(problem.gaps[gap].direct)) return {};
    } else {
      const auto charger = static_cast<std::size_t>(chosen[gap]);
      if (!go(problem.gaps[gap].to_charger[charger])) return {};
      cost += problem.stop_cost + problem.stop_cost_per_j[charger] * (problem.capacity_j - battery);
      battery = problem.capacity_j;
      if (!go(problem.gaps[gap].from_charger[charger])) return {};
    }
    if (gap < problem.item_energy_j.size() && !go({0.0, problem.item_energy_j[gap]})) return {};
  }
  return cost;
}

// Least cost over all subsets of stops.
double brute_force(const RechargeProblem& problem) {
  const int chargers = static_cast<int>(problem.stop_cost_per_j.size());
  std::vector<int> chosen(problem.gaps.size(), -1);
  double best = kInfinity;
  while (true) {
    best = std::min(best, simulate(problem, chosen).value_or(kInfinity));
    std::size_t digit = 0;
    while (digit < chosen.size() && ++chosen[digit] == chargers) chosen[digit++] = -1;
    if (digit == chosen.size()) return best;
  }
}

RechargeProblem random_problem(RandomStream& random) {
  RechargeProblem problem;
  const int chargers = random.index(3);
  const auto way = [&](double scale) {
    const double metres = random.uniform(0.1, scale);
    // Downhill ways give energy back; some ways do not exist.
    const bool missing = random.uniform() < 0.08;
    return RechargeProblem::Way{missing ? kInfinity : metres, metres * random.uniform(-0.2, 1.5)};
  };
  for (int i = random.index(7); i > 0; --i) {
    problem.item_energy_j.push_back(random.uniform(-1.0, 8.0));
  }
  for (std::size_t g = 0; g <= problem.item_energy_j.size(); ++g) {
    RechargeProblem::Gap gap;
    gap.direct = way(4.0);
    for (int c = 0; c < chargers; ++c) {
      gap.to_charger.push_back(way(6.0));
      gap.from_charger.push_back(way(6.0));
    }
    problem.gaps.push_back(gap);
  }
  for (int c = 0; c < chargers; ++c) problem.stop_cost_per_j.push_back(random.uniform(0.0, 0.5));
  problem.stop_cost = random.uniform(0.0, 2.0);
  problem.capacity_j = random.uniform(12.0, 30.0);
  problem.reserve_j = random.uniform(0.0, 3.0);
  problem.start_energy_j = random.uniform(problem.reserve_j, problem.capacity_j);
  return problem;
}

TEST(Recharge, FullBatteryThatLastsNeedsNoStop) {
  const auto plan = plan_recharges(uniform_problem(3, 3400.0));
  ASSERT_TRUE(plan) << to_string(plan.error());
  EXPECT_TRUE(plan->stops.empty());
  EXPECT_DOUBLE_EQ(plan->cost, 4.0);
}

TEST(Recharge, OneJouleLessNeedsOneStop) {
  const auto plan = plan_recharges(uniform_problem(3, 3399.0));
  ASSERT_TRUE(plan) << to_string(plan.error());
  EXPECT_EQ(plan->stops.size(), 1U);
  EXPECT_DOUBLE_EQ(plan->cost, 7.0);  // three direct ways and one by the charger
}

TEST(Recharge, ReserveHoldsOnArrivalAtTheCharger) {
  auto problem = uniform_problem(2, 2000.0);
  problem.start_energy_j = 1300.0;
  problem.reserve_j = 0.0;
  ASSERT_TRUE(plan_recharges(problem));  // 100 + 1000 + 200 J to the charger: arrives empty
  problem.reserve_j = 1.0;
  const auto plan = plan_recharges(problem);
  ASSERT_TRUE(plan) << to_string(plan.error());
  EXPECT_EQ(plan->stops.front().gap, 0);  // so that it must charge before the first item
}

TEST(Recharge, AgreesWithAllSubsetsOfStops) {
  RandomStream random(5, "recharge oracle");
  int feasible = 0;
  int with_stops = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const RechargeProblem problem = random_problem(random);
    const double best = brute_force(problem);
    const auto plan = plan_recharges(problem);
    ASSERT_EQ(plan.has_value(), best < kInfinity) << "trial " << trial;
    if (!plan) continue;
    EXPECT_NEAR(plan->cost, best, 1e-9) << "trial " << trial;
    std::vector<int> chosen(problem.gaps.size(), -1);
    for (const ChargeStop& s : plan->stops) chosen[static_cast<std::size_t>(s.gap)] = s.charger;
    EXPECT_NEAR(simulate(problem, chosen).value_or(kInfinity), best, 1e-9) << "trial " << trial;
    ++feasible;
    with_stops += plan->stops.empty() ? 0 : 1;
  }
  EXPECT_GT(feasible, 300);
  EXPECT_GT(with_stops, 150);
  EXPECT_LT(feasible, 1400);
}

TEST(Recharge, ErrorNamesTheItemAndWhatIsMissing) {
  auto problem = uniform_problem(4, 2000.0);
  // From the charger 200 J to item 2: 2000 - 200 - 1980 is 180 J = 0.05 Wh below an empty battery.
  problem.item_energy_j[2] = 1980.0;
  auto plan = plan_recharges(problem);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::kEnergyInfeasible);
  EXPECT_THAT(plan.error().what, HasSubstr("item 2"));
  EXPECT_THAT(plan.error().what, HasSubstr("0.1 Wh"));
  problem.item_energy_j[2] = 1800.0 + 5.0 * kWattHour;
  plan = plan_recharges(problem);
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().what, HasSubstr("5.0 Wh"));
}

TEST(Recharge, ErrorNamesTheFinishWhenAllItemsCanBeServed) {
  auto problem = uniform_problem(1, 1200.0);
  problem.gaps[1].direct.energy_j = 100.0 + 2.0 * kWattHour;
  problem.gaps[1].to_charger[0].energy_j = 100.0 + 7.0 * kWattHour;
  const auto plan = plan_recharges(problem);
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().what, HasSubstr("the finish"));
  EXPECT_THAT(plan.error().what, HasSubstr("2.0 Wh"));
}

TEST(Recharge, MissingWayIsNotAShortage) {
  auto problem = uniform_problem(2, 5000.0);
  problem.gaps[1].direct.cost = kInfinity;
  problem.gaps[1].to_charger[0].cost = kInfinity;
  const auto plan = plan_recharges(problem);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::kNoPath);
  EXPECT_THAT(plan.error().what, HasSubstr("item 1"));
}

TEST(Recharge, RejectsGapsThatDoNotFitTheItems) {
  auto problem = uniform_problem(2, 5000.0);
  problem.gaps.pop_back();
  EXPECT_THROW(static_cast<void>(plan_recharges(problem)), std::invalid_argument);
}

TEST(Recharge, LongWorkTakesFewMilliseconds) {
  // 1000 items, 3 per charge: a quadratic search over all pairs of stops would still pass, a
  // search over subsets would not end.
  const auto plan = plan_recharges(uniform_problem(1000, 3700.0));
  ASSERT_TRUE(plan) << to_string(plan.error());
  EXPECT_EQ(plan->stops.size(), 333U);
}

TEST(RechargeBound, CountsTheChargesThatNoPlanCanDoWithout) {
  EXPECT_EQ(min_charge_stops({.energy_j = 10.0, .start_j = 10.0, .per_charge_j = 4.0}), 0);
  EXPECT_EQ(min_charge_stops({.energy_j = 10.1, .start_j = 10.0, .per_charge_j = 4.0}), 1);
  EXPECT_EQ(min_charge_stops({.energy_j = 18.0, .start_j = 10.0, .per_charge_j = 4.0}), 2);
  EXPECT_EQ(min_charge_stops({.energy_j = 18.1, .start_j = 10.0, .per_charge_j = 4.0}), 3);
  EXPECT_EQ(min_charge_stops({.energy_j = 11.0, .start_j = 10.0, .per_charge_j = 0.0}), -1);
  const RechargeBound bound{18.1, 10.0, 4.0, 2.5};
  EXPECT_DOUBLE_EQ(recharge_lower_bound(bound), 7.5);
}

TEST(RechargeBound, NeverExceedsTheCheapestPlan) {
  RandomStream random(6, "recharge bound");
  int binding = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const RechargeProblem problem = random_problem(random);
    const auto plan = plan_recharges(problem);
    if (!plan) continue;
    double energy = 0.0;
    double cost = 0.0;
    double detour = kInfinity;
    for (const double item : problem.item_energy_j) energy += item;
    for (const auto& gap : problem.gaps) {
      // The least of each way, with or without a stop.
      double least_energy = gap.direct.energy_j;
      double least_cost = gap.direct.cost;
      for (std::size_t c = 0; c < gap.to_charger.size(); ++c) {
        const auto& to = gap.to_charger[c];
        const auto& from = gap.from_charger[c];
        least_energy = std::min(least_energy, to.energy_j + from.energy_j);
        least_cost = std::min(least_cost, to.cost + from.cost);
      }
      for (std::size_t c = 0; c < gap.to_charger.size(); ++c) {
        const double by_way = gap.to_charger[c].cost + gap.from_charger[c].cost;
        if (by_way < kInfinity) detour = std::min(detour, by_way - least_cost);
      }
      energy += least_energy;
      cost += least_cost;
    }
    const RechargeBound bound{energy, problem.start_energy_j - problem.reserve_j,
                              problem.capacity_j - problem.reserve_j,
                              (detour < kInfinity ? detour : 0.0) + problem.stop_cost};
    const double extra = recharge_lower_bound(bound);
    EXPECT_LE(cost + extra, plan->cost + 1e-9) << "trial " << trial;
    EXPECT_LE(min_charge_stops(bound), static_cast<int>(plan->stops.size())) << "trial " << trial;
    binding += extra > 0.0 ? 1 : 0;
  }
  EXPECT_GT(binding, 50);
}

}  // namespace
}  // namespace headland
