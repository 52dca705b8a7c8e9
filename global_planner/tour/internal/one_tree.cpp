// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/one_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace headland::tour {
namespace {

// Symbols: u(a, b) undirected cost, p(a) penalty of end a, w(a, b) = u(a, b) + p(a) + p(b).
// The least tree of w, less the sum of all p, is a lower bound for every p: a tour has one edge at
// each end, so that its w exceeds its u by exactly that sum.

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kNearest = 10;        // edges per end in the sparse graph of the ascent
constexpr int kRounds = 8;          // ascents; each adds the edges the last one was missing
constexpr int kNeighbours = 8;      // per end, for the local search
constexpr double kRounding = 1e-9;  // relative; the bound is rounded down by it

struct Edge {
  int a = 0;
  int b = 0;
  double u = 0.0;
};

struct Tree {
  double bound = -kInfinity;  // infinity: the rows do not hang together
  std::vector<Edge> edges;    // rows() - 2 between rows, then the depot's two
};

class Ascent {
 public:
  Ascent(const Cycle& cycle, double upper_bound)
      : cycle_(cycle),
        ends_(cycle.finish_end()),
        rows_(ends_ / 2),
        upper_bound_(upper_bound),
        penalty_(static_cast<std::size_t>(ends_), 0.0) {}

  TreeBound solve() {
    Tree tree = dense_tree();
    if (tree.bound == kInfinity) return {kInfinity, {}};
    TreeBound best{rounded_down(tree.bound), {}};
    add_nearest_edges();
    add_edges(tree);
    int steps = kFirstSteps;
    double lambda = 1.0;
    for (int round = 0; round < kRounds; ++round, steps = kLaterSteps, lambda = 0.3) {
      const double sparse_bound = climb(steps, lambda);
      tree = dense_tree();
      best.bound = std::max(best.bound, rounded_down(tree.bound));
      if (!add_edges(tree) || tree.bound >= sparse_bound - 1e-4 * cycle_.step()) break;
    }
    best.neighbours = neighbours(tree);
    return best;
  }

 private:
  static constexpr int kFirstSteps = 400;
  static constexpr int kLaterSteps = 60;

  double& p(int end) { return penalty_[static_cast<std::size_t>(end)]; }
  double w(const Edge& e) { return e.u + p(e.a) + p(e.b); }

  double rounded_down(double bound) const {
    double terms = std::abs(bound);
    for (const double x : penalty_) terms += 1e-3 * std::abs(x);
    return bound - kRounding * terms;
  }

  // Cheapest edge from a depot end; edge.b is the row's end.
  Edge depot_edge(int depot_end) {
    const double* u = cycle_.undirected_row(depot_end);
    int best = 0;
    for (int e = 1; e < ends_; ++e) {
      if (u[e] + p(e) < u[best] + p(best)) best = e;
    }
    return {depot_end, best, u[best]};
  }

  // Closes a spanning tree of the rows with the depot's edges and computes its bound.
  void close(Tree& tree) {
    double sum = 0.0;
    for (const Edge& e : tree.edges) sum += w(e);
    for (const int depot_end : {cycle_.start_end(), cycle_.finish_end()}) {
      tree.edges.push_back(depot_edge(depot_end));
      sum += tree.edges.back().u + p(tree.edges.back().b);
    }
    tree.bound = std::accumulate(penalty_.begin(), penalty_.end(), sum, std::minus<>());
  }

  // The least tree of all edges: Prim's algorithm over rows, four edges between any two.
  Tree dense_tree() {
    std::vector<Edge> link(static_cast<std::size_t>(rows_));
    std::vector<double> key(static_cast<std::size_t>(rows_), kInfinity);
    std::vector<int> outside(static_cast<std::size_t>(rows_));
    std::iota(outside.begin(), outside.end(), 0);
    Tree tree;
    int at = 0;  // index in `outside` of the row that joins the tree
    while (true) {
      const int row = outside[static_cast<std::size_t>(at)];
      outside[static_cast<std::size_t>(at)] = outside.back();
      outside.pop_back();
      if (outside.empty()) break;
      at = relax(row, outside, key, link);
      const int next = outside[static_cast<std::size_t>(at)];
      if (!(key[static_cast<std::size_t>(next)] < kInfinity)) {
        tree.bound = kInfinity;
        return tree;
      }
      tree.edges.push_back(link[static_cast<std::size_t>(next)]);
    }
    close(tree);
    return tree;
  }

  // Prim's step: offers the edges of `row` to all rows outside; returns the nearest of them.
  int relax(int row, const std::vector<int>& outside, std::vector<double>& key,
            std::vector<Edge>& link) {
    const double* u0 = cycle_.undirected_row(2 * row);
    const double* u1 = cycle_.undirected_row(2 * row + 1);
    const double p0 = p(2 * row);
    const double p1 = p(2 * row + 1);
    int nearest = 0;
    for (int i = 0; i < static_cast<int>(outside.size()); ++i) {
      const int other = outside[static_cast<std::size_t>(i)];
      double& k = key[static_cast<std::size_t>(other)];
      for (int b = 2 * other; b < 2 * other + 2; ++b) {
        const double w0 = u0[b] + p0 + p(b);
        const double w1 = u1[b] + p1 + p(b);
        if (std::min(w0, w1) < k) {
          k = std::min(w0, w1);
          link[static_cast<std::size_t>(other)] =
              w0 <= w1 ? Edge{2 * row, b, u0[b]} : Edge{2 * row + 1, b, u1[b]};
        }
      }
      if (k < key[static_cast<std::size_t>(outside[static_cast<std::size_t>(nearest)])]) {
        nearest = i;
      }
    }
    return nearest;
  }

  // The least tree of the sparse graph: Kruskal's algorithm.
  Tree sparse_tree() {
    // The order hardly changes between steps; sorting keys with indices is what costs.
    for (Keyed& k : order_) k.w = w(edges_[static_cast<std::size_t>(k.edge)]);
    std::sort(order_.begin(), order_.end(), [](const Keyed& x, const Keyed& y) {
      return x.w < y.w || (x.w == y.w && x.edge < y.edge);
    });
    std::iota(root_.begin(), root_.end(), 0);
    Tree tree;
    for (const Keyed& k : order_) {
      const Edge& e = edges_[static_cast<std::size_t>(k.edge)];
      const int a = find(e.a / 2);
      const int b = find(e.b / 2);
      if (a == b) continue;
      root_[static_cast<std::size_t>(a)] = b;
      tree.edges.push_back(e);
      if (static_cast<int>(tree.edges.size()) == rows_ - 1) break;
    }
    close(tree);
    return tree;
  }

  int find(int row) {
    while (root_[static_cast<std::size_t>(row)] != row) {
      int& up = root_[static_cast<std::size_t>(row)];
      up = root_[static_cast<std::size_t>(up)];
      row = up;
    }
    return row;
  }

  // Subgradient ascent on the sparse graph; leaves the best penalties in place, returns their
  // bound.
  double climb(int steps, double lambda) {
    std::vector<double> best_penalty = penalty_;
    std::vector<double> direction(static_cast<std::size_t>(ends_), 0.0);
    double best = -kInfinity;
    int since_best = 0;
    const int patience = 10;
    for (int step = 0; step < steps; ++step) {
      const Tree tree = sparse_tree();
      if (tree.bound > best) {
        best = tree.bound;
        best_penalty = penalty_;
        since_best = 0;
      } else if (++since_best >= patience) {
        lambda *= 0.7;
        since_best = 0;
      }
      if (!climb_step(tree, lambda, direction)) break;
    }
    penalty_ = best_penalty;
    return best;
  }

  // Moves the penalties along degree - 1, smoothed; false if the tree is a tour.
  bool climb_step(const Tree& tree, double lambda, std::vector<double>& direction) {
    std::vector<int> excess(static_cast<std::size_t>(ends_), -1);
    for (const Edge& e : tree.edges) {
      if (e.a < ends_) ++excess[static_cast<std::size_t>(e.a)];
      if (e.b < ends_) ++excess[static_cast<std::size_t>(e.b)];
    }
    double square = 0.0;
    for (const int x : excess) square += x * x;
    if (square == 0.0) return false;
    const double target =
        upper_bound_ < kInfinity ? upper_bound_ : tree.bound + 0.1 * cycle_.step() * rows_;
    const double gap = std::max(target - tree.bound, 1e-4 * cycle_.step());
    const double length = lambda * gap / square;
    for (int e = 0; e < ends_; ++e) {
      double& d = direction[static_cast<std::size_t>(e)];
      d = 0.7 * excess[static_cast<std::size_t>(e)] + 0.3 * d;
      p(e) += length * d;
    }
    return true;
  }

  void add_nearest_edges() {
    std::vector<int> ends(static_cast<std::size_t>(ends_));
    std::iota(ends.begin(), ends.end(), 0);
    const int count = std::min(kNearest, ends_);
    for (int a = 0; a < ends_; ++a) {
      const double* u = cycle_.undirected_row(a);
      std::partial_sort(ends.begin(), ends.begin() + count, ends.end(),
                        [u](int x, int y) { return u[x] < u[y] || (u[x] == u[y] && x < y); });
      for (int i = 0; i < count; ++i) {
        const int b = ends[static_cast<std::size_t>(i)];
        if (u[b] < kInfinity) add_edge({std::min(a, b), std::max(a, b), u[b]});
      }
    }
    sort_edges();
  }

  void add_edge(const Edge& edge) { edges_.push_back(edge); }

  // Adds the tree's edges between rows; false if all were there already.
  bool add_edges(const Tree& tree) {
    const std::size_t before = edges_.size();
    for (const Edge& e : tree.edges) {
      if (std::max(e.a, e.b) < ends_) add_edge({std::min(e.a, e.b), std::max(e.a, e.b), e.u});
    }
    sort_edges();
    return edges_.size() > before;
  }

  void sort_edges() {
    std::sort(edges_.begin(), edges_.end(),
              [](const Edge& x, const Edge& y) { return x.a < y.a || (x.a == y.a && x.b < y.b); });
    edges_.erase(std::unique(edges_.begin(), edges_.end(),
                             [](const Edge& x, const Edge& y) { return x.a == y.a && x.b == y.b; }),
                 edges_.end());
    order_.resize(edges_.size());
    for (int i = 0; i < static_cast<int>(edges_.size()); ++i) {
      order_[static_cast<std::size_t>(i)].edge = i;
    }
    root_.resize(static_cast<std::size_t>(rows_));
  }

  Neighbours neighbours(const Tree& tree);

  struct Keyed {
    double w = 0.0;
    int edge = 0;
  };

  const Cycle& cycle_;
  int ends_;  // of rows, without the depot's
  int rows_;  // without the depot
  double upper_bound_;
  std::vector<double> penalty_;
  std::vector<Edge> edges_;
  std::vector<Keyed> order_;
  std::vector<int> root_;
};

// Alpha-nearness (Helsgaun 2000): by how much the least tree grows if it must hold an edge. On the
// tree's own path between two rows, the dearest edge would leave.
Neighbours Ascent::neighbours(const Tree& tree) {
  std::vector<std::vector<Edge>> hanging(static_cast<std::size_t>(rows_));
  double depot_w[2] = {0.0, 0.0};
  for (const Edge& e : tree.edges) {
    if (e.a >= ends_) {
      depot_w[e.a - ends_] = e.u + p(e.b);
    } else {
      hanging[static_cast<std::size_t>(e.a / 2)].push_back(e);
      hanging[static_cast<std::size_t>(e.b / 2)].push_back(e);
    }
  }
  Neighbours result(static_cast<std::size_t>(cycle_.ends()));
  std::vector<double> dearest(static_cast<std::size_t>(rows_) + 1);
  std::vector<int> stack;
  struct Candidate {
    double alpha = 0.0;
    Neighbour neighbour;
  };
  std::vector<Candidate> candidates;
  for (int row = 0; row <= rows_; ++row) {
    std::fill(dearest.begin(), dearest.end(), -kInfinity);
    if (row < rows_) {
      // Depth-first walk over the tree from `row`.
      std::vector<char> seen(static_cast<std::size_t>(rows_), 0);
      seen[static_cast<std::size_t>(row)] = 1;
      stack.assign(1, row);
      while (!stack.empty()) {
        const int at = stack.back();
        stack.pop_back();
        for (const Edge& e : hanging[static_cast<std::size_t>(at)]) {
          const int next = e.a / 2 == at ? e.b / 2 : e.a / 2;
          if (seen[static_cast<std::size_t>(next)]) continue;
          seen[static_cast<std::size_t>(next)] = 1;
          dearest[static_cast<std::size_t>(next)] =
              std::max(dearest[static_cast<std::size_t>(at)], w(e));
          stack.push_back(next);
        }
      }
    }
    for (int a = 2 * row; a < 2 * row + 2; ++a) {
      const double* u = cycle_.undirected_row(a);
      candidates.clear();
      for (int b = 0; b < cycle_.ends(); ++b) {
        if (!(u[b] < kInfinity)) continue;
        const double weight = u[b] + (a < ends_ ? p(a) : 0.0) + (b < ends_ ? p(b) : 0.0);
        const double replaced = a >= ends_   ? depot_w[a - ends_]
                                : b >= ends_ ? depot_w[b - ends_]
                                             : dearest[static_cast<std::size_t>(b / 2)];
        candidates.push_back({weight - replaced, {b, static_cast<float>(u[b])}});
      }
      const auto count = std::min<std::ptrdiff_t>(kNeighbours, std::ssize(candidates));
      std::partial_sort(candidates.begin(), candidates.begin() + count, candidates.end(),
                        [](const Candidate& x, const Candidate& y) {
                          return x.alpha < y.alpha ||
                                 (x.alpha == y.alpha && x.neighbour.end < y.neighbour.end);
                        });
      auto& list = result[static_cast<std::size_t>(a)];
      for (int i = 0; i < count; ++i) {
        list.push_back(candidates[static_cast<std::size_t>(i)].neighbour);
      }
      std::sort(list.begin(), list.end(), [](const Neighbour& x, const Neighbour& y) {
        return x.cost < y.cost || (x.cost == y.cost && x.end < y.end);
      });
    }
  }
  return result;
}

}  // namespace

TreeBound one_tree_bound(const Cycle& cycle, double upper_bound) {
  return Ascent(cycle, upper_bound).solve();
}

}  // namespace headland::tour
