// SPDX-License-Identifier: Apache-2.0
#include "sim/crowd/nearest.hpp"

#include <algorithm>
#include <array>

namespace headland {
namespace {
constexpr int kLeaf = 8;
constexpr std::size_t kDepth = 64;  // more than halving any list of int length takes
}  // namespace

double Nearest::Node::distance2(double x, double y) const {
  const double dx = std::max({low_x - x, x - high_x, 0.0});
  const double dy = std::max({low_y - y, y - high_y, 0.0});
  return dx * dx + dy * dy;
}

void Nearest::build(std::span<const Point2> points) {
  if (items_.size() != points.size()) {
    items_.resize(points.size());
    for (std::size_t i = 0; i < items_.size(); ++i) items_[i].index = static_cast<int>(i);
  }
  // Their order of the last time is nearly right this time.
  for (Item& item : items_) {
    const Point2& p = points[static_cast<std::size_t>(item.index)];
    item.x = p.x();
    item.y = p.y();
  }
  nodes_.clear();
  if (!items_.empty()) split(0, static_cast<int>(items_.size()));
}

void Nearest::split(int begin, int end) {
  const std::size_t node = nodes_.size();
  const auto first = items_.begin() + begin;
  const auto last = items_.begin() + end;
  Node box{first->x, first->y, first->x, first->y, begin, end};
  for (auto item = first + 1; item != last; ++item) {
    box.low_x = std::min(box.low_x, item->x);
    box.low_y = std::min(box.low_y, item->y);
    box.high_x = std::max(box.high_x, item->x);
    box.high_y = std::max(box.high_y, item->y);
  }
  nodes_.push_back(box);
  if (end - begin <= kLeaf) return;
  const int middle = begin + (end - begin) / 2;
  const auto half = items_.begin() + middle;
  if (box.high_x - box.low_x > box.high_y - box.low_y) {
    std::nth_element(first, half, last, [](const Item& a, const Item& b) { return a.x < b.x; });
  } else {
    std::nth_element(first, half, last, [](const Item& a, const Item& b) { return a.y < b.y; });
  }
  split(begin, middle);
  nodes_[node].right = static_cast<int>(nodes_.size());
  split(middle, end);
}

void Nearest::find(const Point2& point, int self, double range, std::size_t most,
                   std::vector<Near>& near) const {
  near.clear();
  if (most == 0 || nodes_.empty()) return;
  struct Open {
    double distance2;
    int node;
  };
  std::array<Open, kDepth> open;
  std::size_t count = 0;
  double limit2 = range * range;
  open[count++] = {nodes_[0].distance2(point.x(), point.y()), 0};
  while (count > 0) {
    const Open next = open[--count];
    if (next.distance2 > limit2) continue;
    const Node& node = nodes_[static_cast<std::size_t>(next.node)];
    if (node.right > 0) {  // the nearer child first
      Open left{nodes_[static_cast<std::size_t>(next.node) + 1].distance2(point.x(), point.y()),
                next.node + 1};
      Open right{nodes_[static_cast<std::size_t>(node.right)].distance2(point.x(), point.y()),
                 node.right};
      if (left.distance2 < right.distance2) std::swap(left, right);
      open[count++] = left;
      open[count++] = right;
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      const Item& item = items_[static_cast<std::size_t>(i)];
      const double dx = item.x - point.x();
      const double dy = item.y - point.y();
      const Near found{dx * dx + dy * dy, item.index};
      if (found.distance2 > limit2 || item.index == self) continue;
      if (near.size() == most) {
        if (!(found < near.back())) continue;
        near.pop_back();
      } else if (found.distance2 >= range * range) {
        continue;
      }
      near.insert(std::upper_bound(near.begin(), near.end(), found), found);
      if (near.size() == most) limit2 = near.back().distance2;
    }
  }
}

}  // namespace headland
