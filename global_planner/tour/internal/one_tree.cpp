// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/one_tree.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "global_planner/tour/internal/local_search.hpp"
#include "global_planner/tour/internal/relaxation.hpp"

namespace headland::tour {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Settled by trial on blocks of rows, scattered rows and random costs; see the slow test.
constexpr int kRounds = 15;               // of ascent on the sparse graph, then a dense tree
constexpr int kSteps = 200;               // of ascent in a round
constexpr double kFirstLambda = 8.0;      // step length; large since the direction is smoothed
constexpr double kLambdaPerRound = 0.85;  // what is left of it in the next round,
constexpr double kLambdaPerStall = 0.8;   // and after kPatience steps without a better bound
constexpr int kPatience = 40;
constexpr double kFresh = 0.07;        // share of the newest subgradient in the direction
constexpr double kShareFresh = 0.005;  // and of the newest tree in the edges' shares
constexpr int kStepsPerSearch = 100;   // for odd sets
constexpr int kSetsPerSearch = 300;
constexpr int kNearest = 6;       // edges per end in the first sparse graph,
constexpr int kAlphaNearest = 3;  // and added to it after every dense tree
constexpr int kNeighbours = 8;    // per end, for the local search

class Ascent {
 public:
  Ascent(const Cycle& cycle, double upper_bound)
      : cycle_(cycle),
        relaxation_(cycle),
        finder_(relaxation_.ends()),
        upper_bound_(upper_bound),
        direction_{std::vector<double>(static_cast<std::size_t>(relaxation_.ends()), 0.0), {}} {}

  TreeBound solve() {
    Tree tree = relaxation_.dense_tree();
    if (tree.bound == kInfinity) return {kInfinity, {}};
    TreeBound result{relaxation_.rounded_down(tree.bound), {}};
    add_edges(nearest_neighbours(cycle_, kNearest));
    double lambda = kFirstLambda;
    for (int round = 0; round < kRounds; ++round, lambda *= kLambdaPerRound) {
      add_edges(tree);
      add_edges(alpha_nearest(relaxation_, tree, kAlphaNearest));
      Multipliers best = climb(lambda);
      // The sparse graph may lack an edge of the least tree: only the dense tree's bound holds.
      std::swap(relaxation_.multipliers, best);
      tree = relaxation_.dense_tree();
      result.bound = std::max(result.bound, relaxation_.rounded_down(tree.bound));
      if (round + 1 == kRounds) break;
      std::swap(relaxation_.multipliers, best);
    }
    result.neighbours = alpha_nearest(relaxation_, tree, kNeighbours);
    return result;
  }

 private:
  void add_edges(const Neighbours& near) {
    for (int a = 0; a < relaxation_.ends(); ++a) {
      for (const Neighbour& n : near[static_cast<std::size_t>(a)]) {
        if (n.end < relaxation_.ends()) relaxation_.add_edge(a, n.end);
      }
    }
  }

  void add_edges(const Tree& tree) {
    for (const Edge& e : tree.edges) relaxation_.add_edge(e.a, e.b);
  }

  // Subgradient ascent on the sparse graph (Held and Karp 1971); returns the best multipliers.
  Multipliers climb(double lambda) {
    share_.resize(relaxation_.edges().size(), 0.0);
    Multipliers best = relaxation_.multipliers;
    double best_bound = -kInfinity;
    int stalled = 0;
    for (int step = 1; step <= kSteps; ++step) {
      const Tree tree = relaxation_.sparse_tree();
      if (tree.bound > best_bound) {
        best_bound = tree.bound;
        best = relaxation_.multipliers;
        stalled = 0;
      } else if (++stalled == kPatience) {
        lambda *= kLambdaPerStall;
        stalled = 0;
      }
      for (double& x : share_) x *= 1.0 - kShareFresh;
      for (const int e : tree.indices) share_[static_cast<std::size_t>(e)] += kShareFresh;
      if (!move(tree, lambda)) break;
      if (step % kStepsPerSearch == 0) add_sets();
    }
    best.set.resize(relaxation_.sets().size(), 0.0);
    return best;
  }

  // Moves the multipliers along the smoothed subgradient; false if the tree is a tour.
  bool move(const Tree& tree, double lambda) {
    const Multipliers excess = subgradient(tree);
    double square = 0.0;
    for (const double x : excess.penalty) square += x * x;
    if (square == 0.0) return false;
    Multipliers& m = relaxation_.multipliers;
    for (std::size_t s = 0; s < m.set.size(); ++s) {
      if (excess.set[s] > 0.0 || m.set[s] > 0.0) square += excess.set[s] * excess.set[s];
    }
    const double target = upper_bound_ < kInfinity
                              ? upper_bound_
                              : tree.bound + 0.1 * cycle_.step() * relaxation_.rows();
    const double length = lambda * std::max(target - tree.bound, 1e-4 * cycle_.step()) / square;
    for (std::size_t e = 0; e < m.penalty.size(); ++e) {
      double& d = direction_.penalty[e];
      d += kFresh * (excess.penalty[e] - d);
      m.penalty[e] += length * d;
    }
    for (std::size_t s = 0; s < m.set.size(); ++s) {
      double& d = direction_.set[s];
      d += kFresh * (excess.set[s] - d);
      m.set[s] = std::max(0.0, m.set[s] + length * d);
    }
    return true;
  }

  // By how much the tree violates each constraint: edges at an end, less one; edges inside an odd
  // set, less the most that a tour has there.
  Multipliers subgradient(const Tree& tree) const {
    Multipliers excess;
    excess.penalty.assign(direction_.penalty.size(), -1.0);
    for (const Edge& e : tree.edges) {
      excess.penalty[static_cast<std::size_t>(e.a)] += 1.0;
      excess.penalty[static_cast<std::size_t>(e.b)] += 1.0;
    }
    excess.penalty[static_cast<std::size_t>(tree.start.b)] += 1.0;
    excess.penalty[static_cast<std::size_t>(tree.finish.b)] += 1.0;
    std::vector<char> held(relaxation_.edges().size(), 0);
    for (const int e : tree.indices) held[static_cast<std::size_t>(e)] = 1;
    for (std::size_t s = 0; s < relaxation_.sets().size(); ++s) {
      double inside = 0.0;
      for (const int e : relaxation_.inside(s)) inside += held[static_cast<std::size_t>(e)];
      excess.set.push_back(inside - relaxation_.sets()[s].most());
    }
    return excess;
  }

  void add_sets() {
    for (OddSet& set : finder_.find(relaxation_.edges(), share_, kSetsPerSearch)) {
      relaxation_.add_set(std::move(set));
      direction_.set.push_back(0.0);
    }
  }

  const Cycle& cycle_;
  Relaxation relaxation_;
  OddSetFinder finder_;
  double upper_bound_;
  Multipliers direction_;
  std::vector<double> share_;  // of each sparse edge in the recent trees
};

}  // namespace

TreeBound one_tree_bound(const Cycle& cycle, double upper_bound) {
  return Ascent(cycle, upper_bound).solve();
}

}  // namespace headland::tour
