// SPDX-License-Identifier: Apache-2.0
#include "sim/crowd/neighbors.hpp"

#include <algorithm>

namespace headland {
namespace {
constexpr int kLeaf = 16;

// From a box to a point or to another box, squared.
double gap2(double dx, double dy) {
  dx = std::max(dx, 0.0);
  dy = std::max(dy, 0.0);
  return dx * dx + dy * dy;
}
}  // namespace

void Neighbors::update(std::span<const Point2> points, double range, std::size_t most) {
  if (items_.size() != points.size() || most_ != most) {
    most_ = most;
    items_.resize(points.size());
    for (std::size_t i = 0; i < items_.size(); ++i) items_[i].index = static_cast<int>(i);
    neighbors_.resize(points.size() * most);
    counts_.assign(points.size(), 0);
    found_.resize(2 * most + 2 * static_cast<std::size_t>(kLeaf));
    bounds2_.resize(static_cast<std::size_t>(kLeaf));
  }
  if (items_.empty() || most == 0) return;
  range2_ = range * range;
  for (Item& item : items_) {  // in their order of the last time, which is nearly right this time
    const Point2& p = points[static_cast<std::size_t>(item.index)];
    item.x = p.x();
    item.y = p.y();
  }
  nodes_.clear();
  split(0, static_cast<int>(items_.size()));
  around_.reserve(nodes_.size());
  for (const Node& leaf : nodes_) {
    if (leaf.right > 0) continue;
    double reach2 = 0.0;
    for (int i = leaf.begin; i < leaf.end; ++i) {
      const Item& item = items_[static_cast<std::size_t>(i)];
      double& bound = bounds2_[static_cast<std::size_t>(i - leaf.begin)];
      bound = bound2(points, static_cast<std::size_t>(item.index));
      reach2 = std::max(reach2, bound);
    }
    around_.clear();
    gather(leaf, reach2, 0);
    for (int i = leaf.begin; i < leaf.end; ++i) {
      search(items_[static_cast<std::size_t>(i)],
             bounds2_[static_cast<std::size_t>(i - leaf.begin)]);
    }
  }
}

void Neighbors::split(int begin, int end) {
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

// As far as the farthest of its neighbours of the last time is now, no others need be looked for.
double Neighbors::bound2(std::span<const Point2> points, std::size_t point) const {
  if (counts_[point] < most_) return range2_;
  double farthest2 = 0.0;
  for (const Neighbor& neighbor : of(point)) {
    const Point2& p = points[static_cast<std::size_t>(neighbor.index)];
    farthest2 = std::max(farthest2, (p - points[point]).squaredNorm());
  }
  return std::min(farthest2, range2_);
}

// The leaves whose boxes are within reach of that of `leaf`.
void Neighbors::gather(const Node& leaf, double reach2, std::size_t index) {
  const Node& node = nodes_[index];
  const double away2 = gap2(std::max(node.low_x - leaf.high_x, leaf.low_x - node.high_x),
                            std::max(node.low_y - leaf.high_y, leaf.low_y - node.high_y));
  if (away2 > reach2) return;
  if (node.right == 0) {
    around_.push_back(&node);
    return;
  }
  gather(leaf, reach2, index + 1);
  gather(leaf, reach2, static_cast<std::size_t>(node.right));
}

void Neighbors::search(const Item& item, double limit2) {
  std::size_t count = 0;
  for (const Node* leaf : around_) {
    const double away2 = gap2(std::max(leaf->low_x - item.x, item.x - leaf->high_x),
                              std::max(leaf->low_y - item.y, item.y - leaf->high_y));
    if (away2 > limit2) continue;
    if (count + static_cast<std::size_t>(kLeaf) > found_.size()) {  // keep the nearest
      const auto last = found_.begin() + static_cast<std::ptrdiff_t>(most_) - 1;
      std::nth_element(found_.begin(), last, found_.begin() + static_cast<std::ptrdiff_t>(count));
      count = most_;
      limit2 = last->distance2;
    }
    for (int i = leaf->begin; i < leaf->end; ++i) {  // without a branch
      const Item& other = items_[static_cast<std::size_t>(i)];
      const double dx = other.x - item.x;
      const double dy = other.y - item.y;
      found_[count] = {dx * dx + dy * dy, other.index};
      count += static_cast<std::size_t>((found_[count].distance2 <= limit2) &
                                        (found_[count].distance2 < range2_) &
                                        (other.index != item.index));
    }
  }
  const auto self = static_cast<std::size_t>(item.index);
  counts_[self] = std::min(count, most_);
  const auto end = found_.begin() + static_cast<std::ptrdiff_t>(count);
  const auto last = found_.begin() + static_cast<std::ptrdiff_t>(counts_[self]);
  if (last != end) std::nth_element(found_.begin(), last, end);
  std::sort(found_.begin(), last);
  std::copy(found_.begin(), last, neighbors_.begin() + static_cast<std::ptrdiff_t>(self * most_));
}

}  // namespace headland
