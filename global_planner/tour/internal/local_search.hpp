// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/random.hpp"
#include "global_planner/tour/internal/cycle.hpp"

namespace headland::tour {

/// An order of rows, as the end by which each is entered; the depot comes first.
using Entries = std::vector<int>;

/// Joins the cheapest pairs of free ends first, as long as no cycle closes without all rows.
Entries greedy_order(const Cycle& cycle, const Neighbours& neighbours);

/// For every end the `count` cheapest ends of other rows.
Neighbours nearest_neighbours(const Cycle& cycle, int count);

/// 2-opt and 3-opt (both with all reversals that keep one cycle) on an order of rows, over
/// neighbour lists and a queue of ends whose surroundings changed (Bentley 1992), with
/// double-bridge kicks that can be taken back. A reversed stretch is driven the other way through
/// all its rows; where costs are asymmetric its change is read from prefix sums.
class LocalSearch {
 public:
  LocalSearch(const Cycle& cycle, const Neighbours& neighbours, Entries entries);

  const Entries& entries() const { return entries_; }
  double cost() const { return cost_; }

  void enqueue_all();
  /// Applies improving moves until none is left near any queued end.
  void descend();
  /// A random double bridge over four edges near each other; queues its ends.
  void kick(RandomStream& random);
  /// Keeps all changes since the last keep() or undo(), or takes them back.
  void keep();
  void undo();

 private:
  // Cuts behind positions i < j (< k): A = ..i, B = i+1..j, C = j+1..k; r marks reversal.
  enum class Kind { kNone, kBr, kCB, kCrB, kCBr, kBrCr };
  struct Move {
    Kind kind = Kind::kNone;
    double change = 0.0;
    int i = 0;
    int j = 0;
    int k = 0;
  };

  int rows() const { return static_cast<int>(entries_.size()); }
  int at(int position) const { return entries_[static_cast<std::size_t>(position)]; }
  int next_at(int position) const { return at(position + 1 == rows() ? 0 : position + 1); }
  int position(int end) const { return position_[static_cast<std::size_t>(end / 2)]; }
  bool is_entry(int end) const { return at(position(end)) == end; }
  // Edge p leads from the row at position p to the next.
  int edge_of(int end) const;
  int mate(int end) const;  // the other end of the edge at `end`
  double edge_cost(int edge) const { return cycle_.directed(at(edge) ^ 1, next_at(edge)); }
  // Change of cost when the rows at positions first..last are driven the other way.
  double reversal(int first, int last) const;

  bool improve_at(int end);
  void try_two(int t1, int t3, Move& best) const;
  void try_three(const int (&t)[6], Move& best) const;
  void apply(const Move& move);
  void reverse(int first, int last);
  void refresh(int first, int last);
  void touch(int first, int last);
  void enqueue(int end);
  void enqueue_edge(int edge);
  double recompute_cost() const;

  const Cycle& cycle_;
  const Neighbours& neighbours_;
  Entries entries_;
  std::vector<int> position_;      // of each row
  std::vector<double> turn_back_;  // sum over edges before a position: backward less forward cost
  double cost_ = 0.0;
  double least_gain_;  // smaller ones are rounding

  std::vector<int> queue_;  // ring of ends; each at most once
  int queue_head_ = 0;
  int queue_size_ = 0;
  std::vector<char> queued_;

  Entries kept_;
  double kept_cost_ = 0.0;
  int touched_first_;
  int touched_last_ = -1;
  Entries scratch_;
};

/// Iterated local search: `iterations` kicks from `entries`, keeping slightly dearer
/// orders too at first; ends early at `stop_cost`, and when `stop`, asked now and then, says so.
Entries iterated_local_search(const Cycle& cycle, const Neighbours& neighbours, Entries entries,
                              int iterations, double stop_cost, std::uint64_t seed,
                              const std::function<bool()>& stop = {});

}  // namespace headland::tour
