// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <vector>

namespace headland::tour {

/// An undirected edge between two row ends.
struct Edge {
  int a = 0;
  int b = 0;
  double u = 0.0;  ///< cost
};

/// An odd number of row ends. Tours join ends in pairs, so that at most (size - 1) / 2 of their
/// edges lie inside: the blossom inequalities (Edmonds 1965), which trees do not know of. Where
/// rows lie in blocks they decide by which headland a block is entered and left.
struct OddSet {
  std::vector<int> ends;                                                ///< ascending
  double most() const { return static_cast<double>(ends.size() / 2); }  ///< edges inside
};

/// Finds odd sets that hold too many edges of a fractional solution: connected parts of the edges
/// taken by falling share, and of the edges taken by rising cost (after the odd components of
/// Padberg and Hong 1980).
class OddSetFinder {
 public:
  explicit OddSetFinder(int ends);

  /// New sets that `share` (of each edge, about 0..1) violates, at most `limit`.
  std::vector<OddSet> find(const std::vector<Edge>& edges, const std::vector<double>& share,
                           int limit);

 private:
  void scan(const std::vector<Edge>& edges, const std::vector<int>& order);
  void consider(const std::vector<int>& part);

  struct Found {
    double violation = 0.0;
    std::vector<int> ends;
  };
  struct Link {
    int to = 0;
    double share = 0.0;
  };
  int ends_;
  std::vector<std::vector<Link>> links_;  // of each end, edges with a share
  std::vector<char> inside_;
  std::vector<Found> found_;
  std::set<std::vector<int>> known_;
};

}  // namespace headland::tour
