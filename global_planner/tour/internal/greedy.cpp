// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <numeric>

#include "core/base/error.hpp"
#include "global_planner/tour/internal/local_search.hpp"

namespace headland::tour {
namespace {

// Fragments of a tour: ends joined in pairs, rows united into strings.
class Fragments {
 public:
  explicit Fragments(const Cycle& cycle)
      : cycle_(cycle),
        joined_(static_cast<std::size_t>(cycle.ends()), -1),
        root_(static_cast<std::size_t>(cycle.rows())),
        strings_(cycle.rows()) {
    std::iota(root_.begin(), root_.end(), 0);
  }

  int strings() const { return strings_; }
  bool is_free(int end) const { return joined_[static_cast<std::size_t>(end)] < 0; }
  int joined(int end) const { return joined_[static_cast<std::size_t>(end)]; }

  void join(int a, int b) {
    if (!is_free(a) || !is_free(b)) return;
    const int ra = find(a / 2);
    const int rb = find(b / 2);
    if (ra == rb && strings_ > 1) return;
    root_[static_cast<std::size_t>(ra)] = rb;
    joined_[static_cast<std::size_t>(a)] = b;
    joined_[static_cast<std::size_t>(b)] = a;
    --strings_;
  }

  // Offers pairs of ends, cheapest first.
  void join_all(std::vector<Neighbour>& second, std::vector<int>& first) {
    std::vector<int> order(first.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&second](int x, int y) {
      return second[static_cast<std::size_t>(x)].cost < second[static_cast<std::size_t>(y)].cost;
    });
    for (const int x : order) {
      join(first[static_cast<std::size_t>(x)], second[static_cast<std::size_t>(x)].end);
    }
  }

 private:
  int find(int row) {
    while (root_[static_cast<std::size_t>(row)] != row) row = root_[static_cast<std::size_t>(row)];
    return row;
  }

  const Cycle& cycle_;
  std::vector<int> joined_;
  std::vector<int> root_;
  int strings_;
};

}  // namespace

Neighbours nearest_neighbours(const Cycle& cycle, int count) {
  Neighbours result(static_cast<std::size_t>(cycle.ends()));
  std::vector<int> ends(static_cast<std::size_t>(cycle.ends()));
  std::iota(ends.begin(), ends.end(), 0);
  const int size = std::min(count, cycle.ends());
  for (int a = 0; a < cycle.ends(); ++a) {
    const double* u = cycle.undirected_row(a);
    std::partial_sort(ends.begin(), ends.begin() + size, ends.end(),
                      [u](int x, int y) { return u[x] < u[y] || (u[x] == u[y] && x < y); });
    for (int i = 0; i < size; ++i) {
      const int b = ends[static_cast<std::size_t>(i)];
      if (!(u[b] < std::numeric_limits<double>::infinity())) break;
      result[static_cast<std::size_t>(a)].push_back({b, static_cast<float>(u[b])});
    }
  }
  return result;
}

Entries greedy_order(const Cycle& cycle, const Neighbours& neighbours) {
  Fragments fragments(cycle);
  std::vector<int> first;
  std::vector<Neighbour> second;
  for (int a = 0; a < cycle.ends(); ++a) {
    for (const Neighbour& n : neighbours[static_cast<std::size_t>(a)]) {
      first.push_back(a);
      second.push_back(n);
    }
  }
  fragments.join_all(second, first);
  // What the neighbour lists leave open is little: offer all pairs of the ends still free.
  std::vector<int> free_ends;
  for (int a = 0; a < cycle.ends(); ++a) {
    if (fragments.is_free(a)) free_ends.push_back(a);
  }
  first.clear();
  second.clear();
  for (const int a : free_ends) {
    for (const int b : free_ends) {
      if (a >= b || a / 2 == b / 2) continue;
      const double cost = std::min(cycle.directed(a, b), cycle.directed(b, a));
      first.push_back(a);
      second.push_back({b, static_cast<float>(cost)});
    }
  }
  fragments.join_all(second, first);
  // One string is left, from one free end to the other.
  for (int a = 0; a < cycle.ends(); ++a) {
    for (int b = 0; fragments.is_free(a) && b < a; ++b) fragments.join(a, b);
  }
  HEADLAND_CHECK(fragments.strings() == 0, "greedy fragments do not close to a cycle");
  Entries entries{cycle.finish_end()};
  for (int exit = cycle.start_end();;) {
    const int entry = fragments.joined(exit);
    if (entry == cycle.finish_end()) break;
    entries.push_back(entry);
    exit = entry ^ 1;
  }
  return entries;
}

}  // namespace headland::tour
