// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/goal_tour.hpp"

#include "global_planner/tour/tour_solver.hpp"

namespace headland {

Result<std::vector<int>> round_tour(int count, const std::function<double(int, int)>& cost) {
  TourProblem problem;
  problem.sites = count;
  TourProfile profile;
  for (int from = 0; from < count; ++from) {
    for (int to = 0; to < count; ++to) {
      profile.ways.push_back({from == to ? kNever : cost(from, to)});
    }
  }
  for (int task = 1; task < count; ++task) {
    TourTask visit;
    visit.modes = {{task, task}};
    problem.tasks.push_back(visit);
    profile.work.push_back({TourLeg{}});
  }
  problem.profiles.push_back(std::move(profile));
  problem.vehicles.emplace_back();
  const auto solution = solve_tour(problem);
  if (!solution) return tl::unexpected<Error>(solution.error());
  std::vector<int> order;
  for (const TourStop& stop : solution->routes.front().stops) order.push_back(stop.task + 1);
  return order;
}

}  // namespace headland
