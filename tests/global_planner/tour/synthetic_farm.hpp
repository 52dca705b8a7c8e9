// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Core>

#include "core/base/random.hpp"
#include "global_planner/tour/row_tour.hpp"

namespace headland::testing {

/// Rows in rectangular blocks of random place, heading and row length, on a slope: turns between
/// rows of one headland (Pi or Omega), drives around or across for all others.
struct SyntheticFarm {
  int blocks = 10;
  int rows_per_block = 10;
  double extent = 1000.0;  ///< side of the square that holds the blocks [m]
  double radius = 3.0;     ///< turning radius [m]
  double climb = 0.0;      ///< extra cost per metre of height gained [m]; makes costs asymmetric
};

inline RowTourProblem synthetic_problem(const SyntheticFarm& farm, std::uint64_t seed) {
  RandomStream random(seed, "synthetic farm");
  const int n = farm.blocks * farm.rows_per_block;
  std::vector<Eigen::Vector2d> ends;
  std::vector<int> headland;  // of each end: 2 block + side
  std::vector<int> place;     // of each end: the row's number in its block
  constexpr double kSpacing = 3.0;
  for (int b = 0; b < farm.blocks; ++b) {
    const double heading = random.uniform(0.0, std::numbers::pi);
    const Eigen::Vector2d along(std::cos(heading), std::sin(heading));
    const Eigen::Vector2d across(-along.y(), along.x());
    const Eigen::Vector2d corner(random.uniform(0.0, farm.extent),
                                 random.uniform(0.0, farm.extent));
    const double length = random.uniform(40.0, 120.0);
    for (int i = 0; i < farm.rows_per_block; ++i) {
      for (const double s : {0.0, length}) {
        ends.push_back(corner + s * along + kSpacing * i * across);
        headland.push_back(2 * b + (s > 0.0 ? 1 : 0));
        place.push_back(i);
      }
    }
  }
  // Pi and Omega turns between rows that lie `d` apart (Bochtis and Vougioukas 2008).
  const auto turn = [&](double d) {
    const double r = farm.radius;
    if (d >= 2.0 * r) return d + (std::numbers::pi - 2.0) * r;
    return r * (3.0 * std::numbers::pi - 4.0 * std::asin((2.0 * r + d) / (4.0 * r)));
  };
  const auto climb = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const double rise = 0.1 * (to.y() - from.y());
    return farm.climb * std::max(rise, 0.0);
  };
  RowTourProblem problem;
  problem.transition =
      Eigen::MatrixXd::Constant(2 * n, 2 * n, std::numeric_limits<double>::infinity());
  problem.start.resize(2 * n);
  problem.finish.resize(2 * n);
  const Eigen::Vector2d depot(0.0, 0.0);
  for (int e = 0; e < 2 * n; ++e) {
    const Eigen::Vector2d& from = ends[static_cast<std::size_t>(e)];
    problem.start[e] = from.norm() + climb(depot, from);
    problem.finish[e] = from.norm() + climb(from, depot);
    for (int f = 0; f < 2 * n; ++f) {
      if (e / 2 == f / 2) continue;
      const auto se = static_cast<std::size_t>(e);
      const auto sf = static_cast<std::size_t>(f);
      const double apart = (ends[sf] - from).norm();
      const double length = headland[se] == headland[sf]
                                ? turn(kSpacing * std::abs(place[se] - place[sf]))
                                : 1.1 * apart + 2.0 * farm.radius;
      problem.transition(e, f) = length + climb(from, ends[sf]);
    }
  }
  return problem;
}

/// Costs drawn at random, without any geometry; `missing` is the share of ways that do not exist.
inline RowTourProblem random_problem(int rows, bool symmetric, double missing,
                                     RandomStream& random) {
  const auto draw = [&] {
    return random.uniform() < missing ? std::numeric_limits<double>::infinity()
                                      : random.uniform(1.0, 100.0);
  };
  RowTourProblem problem;
  problem.transition.resize(2 * rows, 2 * rows);
  problem.start.resize(2 * rows);
  problem.finish.resize(2 * rows);
  for (int e = 0; e < 2 * rows; ++e) {
    problem.start[e] = draw();
    problem.finish[e] = draw();
    for (int f = 0; f < 2 * rows; ++f) {
      problem.transition(e, f) = symmetric && f < e ? problem.transition(f, e) : draw();
    }
  }
  return problem;
}

}  // namespace headland::testing
