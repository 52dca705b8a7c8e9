// SPDX-License-Identifier: Apache-2.0
// Solve times of the receding-horizon controller along a drive: 15 intervals of 0.2 s, bicycle with
// slip on straights and a half circle, a disturbed start every tick, warm starts.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "control/receding_horizon/ipopt_solver.hpp"
#include "control/receding_horizon/rti_solver.hpp"
#include "core/base/random.hpp"
#include "core/geometry/path.hpp"

namespace {

using namespace headland;

constexpr int kIntervals = 15;
constexpr double kInterval = 0.2;
constexpr double kTick = 0.05;

Path course(double radius) {
  Path path;
  path.append({{0.0, 0.0, 0.0}, 0.0, 15.0, Gear::kForward, 0});
  path.append({{15.0, 0.0, 0.0}, 1.0 / radius, kPi * radius, Gear::kForward, 0});
  path.append({{15.0, 2.0 * radius, kPi}, 0.0, 15.0, Gear::kForward, 0});
  return path;
}

HorizonProblem problem_at(const Path& path, double s, double speed, const HorizonState& start) {
  HorizonProblem problem(MotionModel(Steering::kAckermann, 1.5), kIntervals, kInterval);
  problem.slip = {0.1, deg_to_rad(3.0), deg_to_rad(2.0)};
  const double wheels = speed / (1.0 - problem.slip.loss_ratio);
  for (int k = 0; k <= kIntervals; ++k) {
    HorizonStage& stage = problem.stages[static_cast<std::size_t>(k)];
    const PathSample at = path.at(s + k * kInterval * speed);
    const double yaw = at.pose.yaw - problem.slip.side_rad;
    stage.wanted << at.pose.x, at.pose.y, start(kYaw) + wrap_angle(yaw - start(kYaw)), wheels,
        problem.model.turn_for(at.curvature, wheels, problem.slip);
    stage.speed = {0.0, 3.5};
    stage.turn = {-deg_to_rad(40.0), deg_to_rad(40.0)};
  }
  problem.acceleration = {-1.0, 1.0};
  problem.turn_rate = {-1.0, 1.0};
  problem.start = start;
  return problem;
}

// Drives the course with the solver in the loop; returns its solve times [s].
std::vector<double> drive(HorizonSolver& solver, double radius, double speed) {
  const SteadyClock clock;
  const Path path = course(radius);
  RandomStream random(1, "bench");
  std::vector<double> times;
  HorizonState state = problem_at(path, 0.0, speed, HorizonState::Zero()).stages[0].wanted;
  HorizonPlan plan(kIntervals);
  HorizonPlan shifted(kIntervals);
  double s = 0.0;
  while (s < path.length() - 4.0 * speed) {
    HorizonState measured = state;
    for (int i = 0; i < 2; ++i) measured(i) += 0.01 * random.normal();
    measured(kYaw) += deg_to_rad(0.3) * random.normal();
    s = path.project(measured.head<2>(), s - 1.0, s + 2.0).s;
    const HorizonProblem problem = problem_at(path, s, speed, measured);
    if (times.empty()) {
      for (std::size_t k = 0; k < plan.states.size(); ++k)
        plan.states[k] = problem.stages[k].wanted;
    }
    const double begin = clock.now();
    const SolveResult result = solver.solve(problem, plan, {});
    times.push_back(clock.now() - begin);
    if (!solved(result.status)) std::printf("a solve failed\n");
    HorizonProblem tick = problem;
    tick.interval_s = kTick;
    state = tick.next(state, plan.controls[0]);
    plan.shift_into(shifted, kTick, kInterval);
    std::swap(plan, shifted);
  }
  return times;
}

void report(const char* name, HorizonSolver& solver, double radius, double speed) {
  std::vector<double> times = drive(solver, radius, speed);
  std::sort(times.begin(), times.end());
  const auto quantile = [&](double q) {
    return 1e3 * times[static_cast<std::size_t>(q * static_cast<double>(times.size() - 1))];
  };
  std::printf(
      "%-8s R %.1f m, %.1f m/s: %5zu solves, median %.4f ms, p99 %.4f ms, largest %.4f ms\n", name,
      radius, speed, times.size(), quantile(0.5), quantile(0.99), quantile(1.0));
}

}  // namespace

int main() {
  for (const double speed : {0.5, 1.5, 2.5}) {
    for (const double radius : {3.0, 1.9}) {
      RtiSolver rti(kIntervals);
      IpoptSolver ipopt(kIntervals);
      report("rti", rti, radius, speed);
      report("ipopt", ipopt, radius, speed);
    }
  }
  return 0;
}
