// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/row_tour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "global_planner/tour/internal/cycle.hpp"
#include "global_planner/tour/internal/held_karp.hpp"
#include "global_planner/tour/internal/local_search.hpp"
#include "global_planner/tour/internal/one_tree.hpp"

namespace headland {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kProven = 2e-9;  // relative; twice what the bound is rounded down by

void check(const RowTourProblem& problem) {
  const auto ends = problem.start.size();
  if (ends % 2 != 0 || problem.finish.size() != ends || problem.transition.rows() != ends ||
      problem.transition.cols() != ends) {
    throw std::invalid_argument(fmt::format(
        "row tour: start has {} ends, finish {}, the transitions {} x {}; all must be "
        "twice the number of rows",
        ends, problem.finish.size(), problem.transition.rows(), problem.transition.cols()));
  }
  for (Eigen::Index e = 0; e < ends; ++e) {
    bool ok = problem.start[e] > -kInfinity && problem.finish[e] > -kInfinity;
    for (Eigen::Index f = 0; f < ends; ++f) {
      ok = ok && (e / 2 == f / 2 || problem.transition(e, f) > -kInfinity);
    }
    if (!ok) {
      throw std::invalid_argument(
          fmt::format("row tour: a cost at end {} is not a number or minus infinity", e));
    }
  }
}

// Rows that can be driven on a way that begins at the start (or, backwards, ends at the finish).
std::vector<bool> reachable(const RowTourProblem& problem, bool backwards) {
  const int ends = 2 * problem.rows();
  std::vector<bool> seen(static_cast<std::size_t>(ends), false);  // by the end met first
  std::vector<int> stack;
  const auto meet = [&](int end, double cost) {
    if (!(cost < kInfinity) || seen[static_cast<std::size_t>(end)]) return;
    seen[static_cast<std::size_t>(end)] = true;
    stack.push_back(end);
  };
  for (int e = 0; e < ends; ++e) meet(e, backwards ? problem.finish[e] : problem.start[e]);
  while (!stack.empty()) {
    const int far = stack.back() ^ 1;
    stack.pop_back();
    for (int e = 0; e < ends; ++e) {
      if (e / 2 == far / 2) continue;
      meet(e, backwards ? problem.transition(e, far) : problem.transition(far, e));
    }
  }
  std::vector<bool> rows(static_cast<std::size_t>(problem.rows()));
  for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = seen[2 * r] || seen[2 * r + 1];
  return rows;
}

tl::unexpected<Error> no_tour(const RowTourProblem& problem) {
  const std::string remedy = "widen the headlands, add a gate or road, or leave rows out";
  for (const bool backwards : {false, true}) {
    const std::vector<bool> rows = reachable(problem, backwards);
    const auto row = std::find(rows.begin(), rows.end(), false) - rows.begin();
    if (row == std::ssize(rows)) continue;
    return fail(ErrorCode::kNoPath,
                backwards ? fmt::format("row {}: no way leads from it to the finish", row)
                          : fmt::format("row {}: no way leads to it from the start", row),
                remedy);
  }
  return fail(ErrorCode::kNoPath,
              fmt::format("no order of the {} rows was found in which a way leads from each to the "
                          "next",
                          problem.rows()),
              remedy);
}

// Settled by trial: more gains little up to 100 rows, and takes too long far above.
int automatic_iterations(int rows) { return std::min(300 * rows, 20000 + 110 * rows); }

RowTour solve_exactly(const RowTourProblem& problem) {
  RowTour tour;
  tour.visits = tour::held_karp(problem);
  tour.cost = tour.visits.empty() ? kInfinity : tour_cost(problem, tour.visits);
  tour.lower_bound = tour.cost;
  tour.optimal = true;
  return tour;
}

RowTour search(const RowTourProblem& problem, const RowTourOptions& options) {
  const tour::Cycle cycle(problem);
  const tour::Neighbours nearest = tour::nearest_neighbours(cycle, 8);
  const auto first = tour::iterated_local_search(cycle, nearest, greedy_order(cycle, nearest), 0,
                                                 -kInfinity, options.seed);
  RowTour tour;
  const auto adopt = [&](const tour::Entries& entries) {
    tour.visits.clear();
    for (std::size_t p = 1; p < entries.size(); ++p) {
      tour.visits.push_back({entries[p] / 2, entries[p] % 2});
    }
    tour.cost = tour_cost(problem, tour.visits);
  };
  adopt(first);
  const tour::TreeBound bound = tour::one_tree_bound(cycle, tour.cost);
  tour.lower_bound = bound.bound;
  if (bound.bound == kInfinity) return tour;
  const int iterations =
      options.iterations > 0 ? options.iterations : automatic_iterations(problem.rows());
  const double stop_cost = bound.bound + kProven * std::abs(bound.bound);
  adopt(tour::iterated_local_search(cycle, bound.neighbours, first, iterations, stop_cost,
                                    options.seed, options.stop));
  tour.lower_bound = std::min(tour.lower_bound, tour.cost);
  tour.optimal = tour.cost <= stop_cost;
  return tour;
}

}  // namespace

double tour_cost(const RowTourProblem& problem, const std::vector<RowVisit>& visits) {
  if (visits.empty()) return kInfinity;
  double cost = problem.start[visits.front().entry_end()];
  for (std::size_t i = 1; i < visits.size(); ++i) {
    cost += problem.transition(visits[i - 1].exit_end(), visits[i].entry_end());
  }
  return cost + problem.finish[visits.back().exit_end()];
}

Result<RowTour> solve_row_tour(const RowTourProblem& problem, const RowTourOptions& options) {
  check(problem);
  if (problem.rows() == 0) return fail(ErrorCode::kNoRows, "there are no rows to order");
  // The search needs room for its moves.
  const int exact = std::clamp(options.exact_up_to_rows, 3, tour::kMaxExactRows);
  RowTour tour = problem.rows() <= exact ? solve_exactly(problem) : search(problem, options);
  if (!(tour.cost < kInfinity)) return no_tour(problem);
  return tour;
}

}  // namespace headland
