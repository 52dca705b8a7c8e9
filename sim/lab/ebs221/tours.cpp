// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/ebs221/tours.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/geometry/dubins.hpp"

namespace headland {

double turn_cost(const Ebs221Field& field, double radius, TurnCosts costs, int jump) {
  const double across = jump * field.row_width_m;
  if (costs == TurnCosts::kTrue) {
    return dubins_length({0.0, 0.0, 0.5 * kPi}, {across, 0.0, -0.5 * kPi}, radius);
  }
  return radius <= 0.5 * across ? kPi * radius + (jump - 1) * field.row_width_m
                                : 2.0 * kPi * radius;
}

RowTourProblem tour_problem(const Ebs221Field& field, double radius, TurnCosts costs) {
  const int ends = 2 * field.rows_count;
  const Pose2 depot = field.depot();
  RowTourProblem problem;
  problem.transition =
      Eigen::MatrixXd::Constant(ends, ends, std::numeric_limits<double>::infinity());
  problem.start.resize(ends);
  for (int e = 0; e < ends; ++e) {
    const double y = e % 2 == 0 ? 0.0 : field.row_length_m;
    problem.start[e] = std::abs(field.row_x(e / 2) - depot.x) + std::abs(y - depot.y);
    for (int f = 0; f < ends; ++f) {
      const int jump = std::abs(e / 2 - f / 2);
      if (e % 2 != f % 2 || jump == 0) continue;
      problem.transition(e, f) = turn_cost(field, radius, costs, jump);
    }
  }
  problem.finish = problem.start;
  return problem;
}

}  // namespace headland
