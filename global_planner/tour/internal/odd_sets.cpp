// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/odd_sets.hpp"

#include <algorithm>
#include <numeric>

namespace headland::tour {
namespace {

constexpr double kLeastShare = 0.02;
constexpr double kLeastViolation = 0.05;
constexpr std::size_t kLargestSet = 121;

}  // namespace

OddSetFinder::OddSetFinder(int ends)
    : ends_(ends),
      links_(static_cast<std::size_t>(ends)),
      inside_(static_cast<std::size_t>(ends), 0) {}

std::vector<OddSet> OddSetFinder::find(const std::vector<Edge>& edges,
                                       const std::vector<double>& share, int limit) {
  for (auto& links : links_) links.clear();
  std::vector<int> order;
  for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
    const auto i = static_cast<std::size_t>(e);
    if (share[i] < kLeastShare) continue;
    order.push_back(e);
    links_[static_cast<std::size_t>(edges[i].a)].push_back({edges[i].b, share[i]});
    links_[static_cast<std::size_t>(edges[i].b)].push_back({edges[i].a, share[i]});
  }
  found_.clear();
  const auto sort_by = [&order](const auto& key) {
    std::stable_sort(order.begin(), order.end(), [&key](int x, int y) { return key(x) < key(y); });
  };
  sort_by([&](int e) { return -share[static_cast<std::size_t>(e)]; });
  scan(edges, order);
  // Without the edges that are all but certain, odd cycles of halves stand alone.
  std::vector<int> halves = order;
  std::erase_if(halves, [&](int e) { return share[static_cast<std::size_t>(e)] > 0.9; });
  scan(edges, halves);
  sort_by([&](int e) { return edges[static_cast<std::size_t>(e)].u; });
  scan(edges, order);
  std::stable_sort(found_.begin(), found_.end(),
                   [](const Found& x, const Found& y) { return x.violation > y.violation; });
  std::vector<OddSet> sets;
  for (Found& f : found_) {
    if (static_cast<int>(sets.size()) == limit) break;
    if (known_.insert(f.ends).second) sets.push_back({std::move(f.ends)});
  }
  return sets;
}

// Unites ends along the edges in the given order and considers every part that arises.
void OddSetFinder::scan(const std::vector<Edge>& edges, const std::vector<int>& order) {
  std::vector<int> part_of(static_cast<std::size_t>(ends_));
  std::iota(part_of.begin(), part_of.end(), 0);
  std::vector<std::vector<int>> parts(static_cast<std::size_t>(ends_));
  for (int e = 0; e < ends_; ++e) parts[static_cast<std::size_t>(e)] = {e};
  for (const int index : order) {
    const Edge& edge = edges[static_cast<std::size_t>(index)];
    int into = part_of[static_cast<std::size_t>(edge.a)];
    int from = part_of[static_cast<std::size_t>(edge.b)];
    if (into == from) continue;
    auto* a = &parts[static_cast<std::size_t>(into)];
    auto* b = &parts[static_cast<std::size_t>(from)];
    if (a->size() < b->size()) {
      std::swap(a, b);
      std::swap(into, from);
    }
    for (const int end : *b) part_of[static_cast<std::size_t>(end)] = into;
    a->insert(a->end(), b->begin(), b->end());
    b->clear();
    consider(*a);
  }
}

void OddSetFinder::consider(const std::vector<int>& part) {
  if (part.size() % 2 == 0 || part.size() < 3 || part.size() > kLargestSet) return;
  for (const int end : part) inside_[static_cast<std::size_t>(end)] = 1;
  double twice = 0.0;
  for (const int end : part) {
    for (const Link& link : links_[static_cast<std::size_t>(end)]) {
      if (inside_[static_cast<std::size_t>(link.to)]) twice += link.share;
    }
  }
  for (const int end : part) inside_[static_cast<std::size_t>(end)] = 0;
  const double violation = 0.5 * twice - static_cast<double>(part.size() / 2);
  if (violation < kLeastViolation) return;
  std::vector<int> ends = part;
  std::sort(ends.begin(), ends.end());
  if (!known_.contains(ends)) found_.push_back({violation, std::move(ends)});
}

}  // namespace headland::tour
