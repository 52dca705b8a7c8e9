// SPDX-License-Identifier: Apache-2.0
#include <initializer_list>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "control/receding_horizon/ipopt_solver.hpp"
#include "control/receding_horizon/rti_solver.hpp"
#include "tests/control/receding_horizon/problems.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

using testing::guess_of;
using testing::random_problem;

RtiOptions to_convergence() { return {300, 1e-10, 1e-12}; }

IpoptOptions exact() {
  IpoptOptions options;
  options.tolerance = 1e-10;
  options.most_iterations = 200;
  options.warm = false;
  return options;
}

double largest_difference(const HorizonPlan& a, const HorizonPlan& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.controls.size(); ++k) {
    largest = std::max(largest, (a.controls[k] - b.controls[k]).cwiseAbs().maxCoeff());
  }
  return largest;
}

// How many numbers of a plan lie at a bound.
int active_bounds(const HorizonProblem& problem, const HorizonPlan& plan) {
  const auto at = [](double value, const Bounds& bounds) {
    return value < bounds.low + 1e-6 || value > bounds.high - 1e-6 ? 1 : 0;
  };
  int count = 0;
  for (int k = 0; k < problem.intervals(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    count += at(plan.controls[i](0), problem.acceleration);
    count += at(plan.controls[i](1), problem.turn_rate);
    count += at(plan.states[i + 1](kWheelTurn), problem.stage(k + 1).turn);
  }
  return count;
}

TEST(HorizonSolvers, TheRealTimeIterationConvergesToIpoptsPlanOnAThousandProblems) {
  RandomStream random(5, "problems");
  RtiSolver rti(15, to_convergence());
  IpoptSolver ipopt(15, exact());
  int bound = 0;
  double worst = 0.0;
  for (int trial = 0; trial < 1000; ++trial) {
    const HorizonProblem problem = random_problem(random);
    HorizonPlan ours = guess_of(problem);
    HorizonPlan theirs = guess_of(problem);
    ASSERT_EQ(rti.solve(problem, ours, {}).status, SolveStatus::kOptimal) << trial;
    ASSERT_EQ(ipopt.solve(problem, theirs, {}).status, SolveStatus::kOptimal) << trial;
    worst = std::max(worst, largest_difference(ours, theirs));
    ASSERT_LT(largest_difference(ours, theirs), 1e-6)
        << trial << ": " << cost(problem, ours) << " " << cost(problem, theirs);
    ASSERT_LT(dynamics_gap(problem, ours), 1e-9);
    bound += active_bounds(problem, ours) > 0 ? 1 : 0;
  }
  EXPECT_GT(bound, 300);  // limits bind in many of them
  RecordProperty("worst", std::to_string(worst));
}

// Every look at it takes a second.
class SteppingClock : public Clock {
 public:
  double now() const override { return now_ += 1.0; }

 private:
  mutable double now_ = 0.0;
};

TEST(HorizonSolvers, PastTheDeadlineThePlanIsLeftAlone) {
  RandomStream random(6, "problems");
  const HorizonProblem problem = random_problem(random);
  const SteppingClock clock;
  RtiSolver rti(15, to_convergence());
  IpoptSolver ipopt(15, exact());
  for (HorizonSolver* solver : std::initializer_list<HorizonSolver*>{&rti, &ipopt}) {
    for (const double seconds : {0.5, 2.5}) {  // before the first iteration, and after some
      HorizonPlan plan = guess_of(problem);
      const SolveResult result = solver->solve(problem, plan, Deadline::in(&clock, seconds));
      EXPECT_EQ(result.status, SolveStatus::kTimedOut);
      EXPECT_EQ(largest_difference(plan, guess_of(problem)), 0.0);
    }
    HorizonPlan plan = guess_of(problem);
    EXPECT_EQ(solver->solve(problem, plan, {}).status, SolveStatus::kOptimal);
  }
}

TEST(HorizonSolvers, NumbersThatAreNoneFailAndTheNextProblemIsSolved) {
  RandomStream random(7, "problems");
  const HorizonProblem good = random_problem(random);
  HorizonProblem bad = good;
  bad.start(kYaw) = std::numeric_limits<double>::quiet_NaN();
  RtiSolver rti(15, to_convergence());
  IpoptSolver ipopt(15, exact());
  for (HorizonSolver* solver : std::initializer_list<HorizonSolver*>{&rti, &ipopt}) {
    HorizonPlan plan = guess_of(good);
    EXPECT_EQ(solver->solve(bad, plan, {}).status, SolveStatus::kFailed);
    EXPECT_EQ(largest_difference(plan, guess_of(good)), 0.0);
    EXPECT_EQ(solver->solve(good, plan, {}).status, SolveStatus::kOptimal);
  }
}

TEST(RtiSolver, DoesNotAllocate) {
  RandomStream random(8, "problems");
  RtiSolver rti(15, to_convergence());
  int bound = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const HorizonProblem problem = random_problem(random);
    HorizonPlan plan = guess_of(problem);
    const long before = testing::allocation_count();
    rti.solve(problem, plan, {});
    EXPECT_EQ(testing::allocation_count(), before);
    bound += active_bounds(problem, plan) > 0 ? 1 : 0;
  }
  EXPECT_GT(bound, 10);
}

TEST(RtiSolver, OneProgrammeIsNearTheOptimumAndKeepsTheBounds) {
  RandomStream random(9, "problems");
  RtiSolver once(15);
  RtiSolver converged(15, to_convergence());
  double first = 0.0;
  double second = 0.0;
  for (int trial = 0; trial < 100; ++trial) {
    const HorizonProblem problem = random_problem(random);
    HorizonPlan quick = guess_of(problem);
    HorizonPlan best = guess_of(problem);
    ASSERT_EQ(once.solve(problem, quick, {}).status, SolveStatus::kUsable);
    converged.solve(problem, best, {});
    EXPECT_LT(dynamics_gap(problem, quick), 0.1);
    for (const HorizonControl& u : quick.controls) {
      EXPECT_LE(std::abs(u(0)), 1.0 + 1e-4);
      EXPECT_LE(std::abs(u(1)), 0.6 + 1e-4);
    }
    HorizonPlan again = quick;
    once.solve(problem, again, {});
    first += largest_difference(quick, best);
    second += largest_difference(again, best);
  }
  EXPECT_LT(second, 0.5 * first);  // another programme from there comes nearer
}

TEST(IpoptSolver, TenInThreadsGiveTheSameAsOneAfterTheOther) {
  constexpr int kVehicles = 10;
  const auto drive = [](int vehicle) {
    RandomStream random(static_cast<std::uint64_t>(vehicle), "fleet");
    IpoptSolver solver(15);
    double sum = 0.0;
    for (int i = 0; i < 20; ++i) {
      const HorizonProblem problem = random_problem(random);
      HorizonPlan plan = guess_of(problem);
      if (solved(solver.solve(problem, plan, {}).status)) sum += plan.controls[0].sum();
    }
    return sum;
  };
  double together[kVehicles] = {};
  std::vector<std::thread> threads;
  for (int v = 0; v < kVehicles; ++v) {
    threads.emplace_back([&, v] { together[v] = drive(v); });
  }
  for (std::thread& thread : threads) thread.join();
  for (int v = 0; v < kVehicles; ++v) EXPECT_EQ(together[v], drive(v)) << v;
}

}  // namespace
}  // namespace headland
