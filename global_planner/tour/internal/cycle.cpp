// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/cycle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace headland::tour {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A missing way costs as much as this many of the dearest ones: enough that no search keeps it
// willingly, little enough that sums keep their precision.
constexpr double kMissingFactor = 50.0;
constexpr double kSymmetryTolerance = 1e-9;

double cost_between(const RowTourProblem& problem, int from, int to) {
  const int ends = 2 * problem.rows();
  if (from / 2 == to / 2) return kInfinity;
  if (from < ends && to < ends) return problem.transition(from, to);
  if (from == ends + 1) return problem.start[to];
  if (to == ends) return problem.finish[from];
  return kInfinity;
}

}  // namespace

Cycle::Cycle(const RowTourProblem& problem) : rows_(problem.rows() + 1) {
  const auto size = static_cast<std::size_t>(ends()) * static_cast<std::size_t>(ends());
  std::vector<double> exact(size);
  double dearest = 0.0;
  for (int from = 0; from < ends(); ++from) {
    for (int to = 0; to < ends(); ++to) {
      const double cost = cost_between(problem, from, to);
      exact[index(from, to)] = cost;
      if (cost < kInfinity) dearest = std::max(dearest, std::abs(cost));
    }
  }
  const double missing = kMissingFactor * std::max(dearest, 1.0);
  directed_.resize(size);
  undirected_.resize(size);
  int counted = 0;
  for (int a = 0; a < ends(); ++a) {
    double cheapest = kInfinity;
    for (int b = 0; b < ends(); ++b) {
      const double there = exact[index(a, b)];
      const double back = exact[index(b, a)];
      directed_[index(a, b)] = static_cast<float>(std::min(there, missing));
      undirected_[index(a, b)] = std::min(there, back);
      cheapest = std::min(cheapest, undirected_[index(a, b)]);
      // The depot is never driven backwards, so that its own edges do not count.
      if (a < finish_end() && b < finish_end() && there != back &&
          !(std::abs(there - back) <= kSymmetryTolerance * dearest)) {
        symmetric_ = false;
      }
    }
    if (cheapest < kInfinity) {
      step_ += std::abs(cheapest);
      ++counted;
    }
  }
  step_ /= std::max(counted, 1);
}

}  // namespace headland::tour
