// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/order.hpp"

#include <algorithm>
#include <cmath>

#include "global_planner/tour/internal/one_way_tour.hpp"
#include "global_planner/tour/row_tour.hpp"

namespace headland::tour {
namespace {

constexpr double kProven = 2e-9;  // relative; twice what bounds are rounded down by
constexpr int kExactTasks =
    12;  // of tasks with one mode, above which the assignments' tree is faster

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool fits(const TourProblem& problem) {
  return problem.vehicles.size() == 1 && !problem.tasks.empty() &&
         std::all_of(problem.tasks.begin(), problem.tasks.end(), [](const TourTask& task) {
           return task.modes.size() == 1 || task.modes.size() == 2;
         });
}

bool all_one_way(const TourProblem& problem) {
  return std::all_of(problem.tasks.begin(), problem.tasks.end(),
                     [](const TourTask& task) { return task.modes.size() == 1; });
}

// A task is a row that is entered by end m in mode m; its work counts with the way to it.
class Rows {
 public:
  explicit Rows(const TourProblem& problem)
      : problem_(problem),
        vehicle_(problem.vehicles.front()),
        per_second_(problem.duration_weight + problem.span_weight) {}

  RowTourProblem rows() const {
    const int tasks = static_cast<int>(problem_.tasks.size());
    RowTourProblem rows;
    rows.transition.setConstant(2 * tasks, 2 * tasks, kNever);
    rows.start.setConstant(2 * tasks, kNever);
    rows.finish.setConstant(2 * tasks, kNever);
    for (int a = 0; a < tasks; ++a) {
      for (int m = 0; m < modes(a); ++m) {
        const TourMode& mode = problem_.tasks[at(a)].modes[at(m)];
        const int exit_end = 2 * a + 1 - m;
        rows.start[2 * a + m] = reach(vehicle_.start, a, m);
        rows.finish[exit_end] = cost(problem_.way(vehicle_.profile, mode.exit, vehicle_.finish));
        for (int b = 0; b < tasks; ++b) {
          for (int k = 0; b != a && k < modes(b); ++k) {
            rows.transition(exit_end, 2 * b + k) = reach(mode.exit, b, k);
          }
        }
      }
    }
    return rows;
  }

  // Of the objective, what every order costs.
  double constant() const {
    return vehicle_.fixed_cost + problem_.span_weight * vehicle_.earliest_s;
  }

 private:
  int modes(int task) const { return static_cast<int>(problem_.tasks[at(task)].modes.size()); }
  double cost(const TourLeg& leg) const {
    return leg.cost < kNever ? leg.cost + per_second_ * leg.duration_s : kNever;
  }
  double reach(int site, int task, int mode) const {
    const TourMode& m = problem_.tasks[at(task)].modes[at(mode)];
    return cost(problem_.way(vehicle_.profile, site, m.entry)) +
           cost(problem_.profiles[at(vehicle_.profile)].work[at(task)][at(mode)]);
  }

  const TourProblem& problem_;
  const TourVehicle& vehicle_;
  double per_second_;
};

std::optional<OrderAnswer> one_way_order(const RowTourProblem& rows, const TourOptions& options,
                                         double constant) {
  OneWaySearch search;
  search.seed = options.seed;
  search.iterations = static_cast<int>(std::min(options.iterations, 100'000'000L));
  search.stop = options.stop;
  if (options.progress) {
    search.improved = [&](double cost) { options.progress(0.0, cost + constant); };
  }
  const TreeAnswer tour = one_way_tour(rows, search);
  if (tour.next.empty()) return {};
  OrderAnswer answer;
  const int depot = rows.rows();
  for (int node = tour.next[at(depot)]; node != depot; node = tour.next[at(node)]) {
    answer.visits.emplace_back(node, 0);
  }
  answer.cost = tour.cost;
  answer.lower_bound = tour.lower_bound;
  return answer;
}

std::optional<OrderAnswer> row_order(const RowTourProblem& rows, const TourOptions& options) {
  RowTourOptions row_options;
  row_options.seed = options.seed;
  row_options.iterations = static_cast<int>(std::min(options.iterations, 100'000'000L));
  row_options.stop = options.stop;
  const auto tour = solve_row_tour(rows, row_options);
  if (!tour) return {};
  OrderAnswer answer;
  for (const RowVisit& visit : tour->visits) answer.visits.emplace_back(visit.row, visit.entry);
  answer.cost = tour->cost;
  answer.lower_bound = tour->lower_bound;
  return answer;
}

}  // namespace

std::optional<OrderAnswer> solve_order(const TourProblem& problem, const TourOptions& options) {
  if (!fits(problem)) return {};
  const Rows converted(problem);
  const RowTourProblem rows = converted.rows();
  auto answer = all_one_way(problem) && rows.rows() > kExactTasks
                    ? one_way_order(rows, options, converted.constant())
                    : row_order(rows, options);
  if (!answer || !(answer->cost < kNever)) return {};
  answer->optimal =
      answer->cost <= answer->lower_bound + kProven * std::max(1.0, std::abs(answer->cost));
  answer->cost += converted.constant();
  answer->lower_bound += converted.constant();
  return answer;
}

}  // namespace headland::tour
