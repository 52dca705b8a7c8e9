// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "global_planner/tour/row_tour.hpp"

namespace headland::tour {

/// A row tour closed to a cycle: one more row, the depot, is entered by the finish and left by the
/// start. Every end then has exactly one edge besides its row, and end ^ 1 is the row's other end.
class Cycle {
 public:
  explicit Cycle(const RowTourProblem& problem);

  int rows() const { return rows_; }  ///< with the depot, which is the last
  int ends() const { return 2 * rows_; }
  int finish_end() const { return 2 * rows_ - 2; }
  int start_end() const { return 2 * rows_ - 1; }

  /// Cost of leaving by `from` and entering by `to`; a large penalty where there is no way.
  /// Rounded to float: half the memory traffic, and far below the accuracy of any cost model.
  double directed(int from, int to) const { return directed_[index(from, to)]; }
  /// The cheaper of both directions, exactly; infinity where there is no way.
  double undirected(int a, int b) const { return undirected_[index(a, b)]; }
  const double* undirected_row(int a) const { return &undirected_[index(a, 0)]; }

  /// Both directions of every transition cost the same.
  bool symmetric() const { return symmetric_; }
  /// The mean over all ends of the cheapest way from that end: the scale of one step of a tour.
  double step() const { return step_; }

 private:
  std::size_t index(int a, int b) const {
    return static_cast<std::size_t>(a) * static_cast<std::size_t>(2 * rows_) +
           static_cast<std::size_t>(b);
  }

  int rows_;
  bool symmetric_ = true;
  double step_ = 0.0;
  std::vector<float> directed_;
  std::vector<double> undirected_;
};

/// For every end the ends worth joining to it, cheapest first.
struct Neighbour {
  int end = 0;
  float cost = 0.0F;  ///< undirected
};
using Neighbours = std::vector<std::vector<Neighbour>>;

}  // namespace headland::tour
