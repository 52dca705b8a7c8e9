// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "global_planner/tour/internal/cycle.hpp"
#include "global_planner/tour/internal/odd_sets.hpp"

namespace headland::tour {

/// A spanning tree over the rows, and one edge each from the start and to the finish.
struct Tree {
  double bound = 0.0;           ///< on every tour; infinity if the rows do not hang together
  std::vector<Edge> edges;      ///< rows - 1 between rows
  std::vector<double> weights;  ///< w of these
  std::vector<int> indices;     ///< of these in the sparse graph, where they are from there
  Edge start;                   ///< from a depot end (a) to a row's (b)
  Edge finish;
};

/// What multiplies the relaxed constraints.
struct Multipliers {
  std::vector<double> penalty;  ///< p of every row end
  std::vector<double> set;      ///< m >= 0 of every odd set
};

/// The Lagrangian relaxation of the cycle to trees.
///
/// Symbols: u(a, b) undirected cost; p(a) penalty of end a; m(S) multiplier of odd set S;
/// w(a, b) = u(a, b) + p(a) + p(b) + sum of m(S) over all S that hold both a and b.
/// For every p and m >= 0 the least tree of w, less the sum of all p and of all m(S) (|S| - 1) / 2,
/// is a lower bound: a tour is a tree too, with one edge at each end and at most (|S| - 1) / 2
/// inside S (Held and Karp 1970; Edmonds 1965).
class Relaxation {
 public:
  explicit Relaxation(const Cycle& cycle);

  const Cycle& cycle() const { return cycle_; }
  int rows() const { return rows_; }  ///< without the depot
  int ends() const { return 2 * rows_; }

  Multipliers multipliers;
  const std::vector<OddSet>& sets() const { return sets_; }
  const std::vector<Edge>& edges() const { return edges_; }  ///< of the sparse graph
  /// Edges of the sparse graph inside an odd set.
  const std::vector<int>& inside(std::size_t set) const { return inside_[set]; }

  /// Both keep what is there already, and its number.
  void add_edge(int a, int b);
  void add_set(OddSet set);

  /// w(a, b) of all row ends b.
  void weigh(int a, std::vector<double>& w) const;
  double penalty(int end) const { return multipliers.penalty[static_cast<std::size_t>(end)]; }

  /// The least tree of all edges: Prim's algorithm, O(rows^2). Only its bound is valid.
  Tree dense_tree() const;
  /// The least tree of the sparse graph: Kruskal's algorithm.
  Tree sparse_tree();
  /// A bound less what rounding can have added to it.
  double rounded_down(double bound) const;

 private:
  void weigh_edges();
  Edge depot_edge(int depot_end) const;
  void close(Tree& tree, double weight) const;
  int find(int row);

  struct Keyed {
    double w = 0.0;
    int edge = 0;
  };

  const Cycle& cycle_;
  int rows_;
  std::vector<OddSet> sets_;
  std::vector<std::vector<int>> sets_of_;  // of each end
  std::vector<std::vector<int>> inside_;
  std::vector<Edge> edges_;
  std::vector<std::vector<int>> edges_of_;  // of each end
  std::vector<double> weight_;              // w of each edge
  std::vector<Keyed> order_;
  std::vector<int> root_;  // of each row, in Kruskal's algorithm
};

/// For every end (the depot's too) the `per_end` ends joined most cheaply by alpha-nearness: by how
/// much the least tree grows if it must hold the edge (Helsgaun 2000). Cheapest first.
Neighbours alpha_nearest(const Relaxation& relaxation, const Tree& tree, int per_end);

}  // namespace headland::tour
