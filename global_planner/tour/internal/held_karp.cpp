// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/held_karp.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "core/base/error.hpp"

namespace headland::tour {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// best(S, e): the least cost from the start over all rows of S, the last of them left by end e.
class SubsetTable {
 public:
  explicit SubsetTable(const RowTourProblem& problem)
      : problem_(problem),
        ends_(2 * problem.rows()),
        all_((1U << problem.rows()) - 1),
        best_((static_cast<std::size_t>(all_) + 1) * static_cast<std::size_t>(ends_), kInfinity) {
    for (int exit = 0; exit < ends_; ++exit) at(bit(exit), exit) = problem.start[exit ^ 1];
  }

  void fill() {
    // Supersets have larger numbers, so that each set is final when its turn comes.
    for (std::uint32_t set = 1; set < all_; ++set) {
      for (std::uint32_t in = set; in != 0; in &= in - 1) {
        const int row = std::countr_zero(in);
        extend(set, 2 * row);
        extend(set, 2 * row + 1);
      }
    }
  }

  std::vector<RowVisit> backtrack() {
    int exit = 0;
    for (int e = 1; e < ends_; ++e) {
      if (at(all_, e) + problem_.finish[e] < at(all_, exit) + problem_.finish[exit]) exit = e;
    }
    if (!(at(all_, exit) + problem_.finish[exit] < kInfinity)) return {};
    std::vector<RowVisit> visits;
    for (std::uint32_t set = all_; set != 0;) {
      visits.push_back({exit / 2, 1 - exit % 2});
      const std::uint32_t rest = set ^ bit(exit);
      exit = rest == 0 ? exit : predecessor(rest, set, exit);
      set = rest;
    }
    std::reverse(visits.begin(), visits.end());
    return visits;
  }

 private:
  static std::uint32_t bit(int end) { return 1U << (end / 2); }

  double& at(std::uint32_t set, int exit) {
    return best_[static_cast<std::size_t>(set) * static_cast<std::size_t>(ends_) +
                 static_cast<std::size_t>(exit)];
  }

  // Appends every row that is not in `set` to the best order that leaves `set` by `from`.
  void extend(std::uint32_t set, int from) {
    const double base = at(set, from);
    if (base == kInfinity) return;
    for (std::uint32_t out = all_ & ~set; out != 0; out &= out - 1) {
      const int row = std::countr_zero(out);
      for (int exit = 2 * row; exit < 2 * row + 2; ++exit) {
        double& best = at(set | bit(exit), exit);
        best = std::min(best, base + problem_.transition(from, exit ^ 1));
      }
    }
  }

  int predecessor(std::uint32_t rest, std::uint32_t set, int exit) {
    for (int from = 0; from < ends_; ++from) {
      // The same sum as in extend(), so that it is found exactly.
      if ((rest & bit(from)) != 0 &&
          at(rest, from) + problem_.transition(from, exit ^ 1) == at(set, exit)) {
        return from;
      }
    }
    HEADLAND_CHECK(false, "the table holds a cost that no predecessor explains");
    return exit;
  }

  const RowTourProblem& problem_;
  int ends_;
  std::uint32_t all_;
  std::vector<double> best_;
};

}  // namespace

std::vector<RowVisit> held_karp(const RowTourProblem& problem) {
  HEADLAND_CHECK(problem.rows() >= 1 && problem.rows() <= kMaxExactRows, "rows out of range");
  SubsetTable table(problem);
  table.fill();
  return table.backtrack();
}

}  // namespace headland::tour
