// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "global_planner/tour/internal/relaxation.hpp"

namespace headland::tour {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Candidate {
  double alpha = 0.0;
  Neighbour neighbour;
};

struct Branch {
  int row = 0;
  double w = 0.0;
};
using Branches = std::vector<std::vector<Branch>>;  // of a tree, at each row

Branches branches_of(const Tree& tree, int rows) {
  Branches branches(static_cast<std::size_t>(rows));
  for (std::size_t i = 0; i < tree.edges.size(); ++i) {
    const int a = tree.edges[i].a / 2;
    const int b = tree.edges[i].b / 2;
    branches[static_cast<std::size_t>(a)].push_back({b, tree.weights[i]});
    branches[static_cast<std::size_t>(b)].push_back({a, tree.weights[i]});
  }
  return branches;
}

// The dearest edge on the tree's path from `from` to every row: the one that would leave if the
// tree had to hold an edge between the two.
void dearest_on_path(const Branches& branches, int from, std::vector<double>& dearest) {
  constexpr double kUnseen = kInfinity;
  dearest.assign(branches.size(), kUnseen);
  dearest[static_cast<std::size_t>(from)] = -kInfinity;
  std::vector<int> stack{from};
  while (!stack.empty()) {
    const int at = stack.back();
    stack.pop_back();
    for (const Branch& branch : branches[static_cast<std::size_t>(at)]) {
      double& d = dearest[static_cast<std::size_t>(branch.row)];
      if (d != kUnseen) continue;
      d = std::max(dearest[static_cast<std::size_t>(at)], branch.w);
      stack.push_back(branch.row);
    }
  }
}

// The best candidates by alpha, then by cost.
std::vector<Neighbour> best_of(std::vector<Candidate>& candidates, int count) {
  const auto end = candidates.begin() + std::min<std::ptrdiff_t>(count, std::ssize(candidates));
  std::partial_sort(
      candidates.begin(), end, candidates.end(), [](const Candidate& x, const Candidate& y) {
        return x.alpha < y.alpha || (x.alpha == y.alpha && x.neighbour.end < y.neighbour.end);
      });
  std::vector<Neighbour> best;
  for (auto c = candidates.begin(); c != end; ++c) best.push_back(c->neighbour);
  std::sort(best.begin(), best.end(), [](const Neighbour& x, const Neighbour& y) {
    return x.cost < y.cost || (x.cost == y.cost && x.end < y.end);
  });
  return best;
}

}  // namespace

Neighbours alpha_nearest(const Relaxation& relaxation, const Tree& tree, int per_end) {
  const Cycle& cycle = relaxation.cycle();
  const int ends = relaxation.ends();
  const Branches branches = branches_of(tree, relaxation.rows());
  Neighbours result(static_cast<std::size_t>(cycle.ends()));
  std::vector<double> dearest;
  std::vector<double> w;
  std::vector<Candidate> candidates;
  const Edge depot_edges[2] = {tree.finish, tree.start};
  const auto depot_alpha = [&](const Edge& held, int end) {
    return cycle.undirected(held.a, end) + relaxation.penalty(end) - held.u -
           relaxation.penalty(held.b);
  };
  const auto offer = [&](int a, int b, double alpha) {
    const double u = cycle.undirected(a, b);
    if (u < kInfinity) candidates.push_back({alpha, {b, static_cast<float>(u)}});
  };
  for (int a = 0; a < ends; ++a) {
    if (a % 2 == 0) dearest_on_path(branches, a / 2, dearest);
    relaxation.weigh(a, w);
    candidates.clear();
    for (int b = 0; b < ends; ++b) {
      const double leaves = dearest[static_cast<std::size_t>(b / 2)];
      if (b / 2 != a / 2) offer(a, b, w[static_cast<std::size_t>(b)] - leaves);
    }
    for (const Edge& held : depot_edges) offer(a, held.a, depot_alpha(held, a));
    result[static_cast<std::size_t>(a)] = best_of(candidates, per_end);
  }
  for (const Edge& held : depot_edges) {
    candidates.clear();
    for (int b = 0; b < ends; ++b) offer(held.a, b, depot_alpha(held, b));
    result[static_cast<std::size_t>(held.a)] = best_of(candidates, per_end);
  }
  return result;
}

}  // namespace headland::tour
