// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace headland::tour {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-9;  // of the bound; far more than its sums can be off by

}  // namespace

Relaxation::Relaxation(const Cycle& cycle)
    : cycle_(cycle),
      rows_(cycle.rows() - 1),
      sets_of_(static_cast<std::size_t>(ends())),
      edges_of_(static_cast<std::size_t>(ends())),
      root_(static_cast<std::size_t>(rows_)) {
  multipliers.penalty.assign(static_cast<std::size_t>(ends()), 0.0);
}

void Relaxation::add_edge(int a, int b) {
  auto& partners = edges_of_[static_cast<std::size_t>(std::min(a, b))];
  const auto same = [&](int e) { return edges_[static_cast<std::size_t>(e)].b == std::max(a, b); };
  if (std::any_of(partners.begin(), partners.end(), same)) return;
  const int index = static_cast<int>(edges_.size());
  partners.push_back(index);
  edges_.push_back({std::min(a, b), std::max(a, b), cycle_.undirected(a, b)});
  weight_.push_back(0.0);
  order_.push_back({0.0, index});
  for (const int s : sets_of_[static_cast<std::size_t>(a)]) {
    const auto& ends = sets_[static_cast<std::size_t>(s)].ends;
    if (std::binary_search(ends.begin(), ends.end(), b)) {
      inside_[static_cast<std::size_t>(s)].push_back(index);
    }
  }
}

void Relaxation::add_set(OddSet set) {
  std::vector<int> inside;
  for (const int a : set.ends) {
    sets_of_[static_cast<std::size_t>(a)].push_back(static_cast<int>(sets_.size()));
    for (const int e : edges_of_[static_cast<std::size_t>(a)]) {
      const int b = edges_[static_cast<std::size_t>(e)].b;
      if (std::binary_search(set.ends.begin(), set.ends.end(), b)) inside.push_back(e);
    }
  }
  inside_.push_back(std::move(inside));
  sets_.push_back(std::move(set));
  multipliers.set.push_back(0.0);
}

void Relaxation::weigh(int a, std::vector<double>& w) const {
  const double* u = cycle_.undirected_row(a);
  w.resize(static_cast<std::size_t>(ends()));
  for (int b = 0; b < ends(); ++b) w[static_cast<std::size_t>(b)] = u[b] + penalty(a) + penalty(b);
  for (const int s : sets_of_[static_cast<std::size_t>(a)]) {
    const double multiplier = multipliers.set[static_cast<std::size_t>(s)];
    if (multiplier == 0.0) continue;
    for (const int b : sets_[static_cast<std::size_t>(s)].ends) {
      w[static_cast<std::size_t>(b)] += multiplier;
    }
  }
}

void Relaxation::weigh_edges() {
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    weight_[e] = edges_[e].u + penalty(edges_[e].a) + penalty(edges_[e].b);
  }
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    const double multiplier = multipliers.set[s];
    if (multiplier == 0.0) continue;
    for (const int e : inside_[s]) weight_[static_cast<std::size_t>(e)] += multiplier;
  }
}

Edge Relaxation::depot_edge(int depot_end) const {
  const double* u = cycle_.undirected_row(depot_end);
  int best = 0;
  for (int e = 1; e < ends(); ++e) {
    if (u[e] + penalty(e) < u[best] + penalty(best)) best = e;
  }
  return {depot_end, best, u[best]};
}

// Adds the depot's edges to a spanning tree of the rows that weighs `weight`.
void Relaxation::close(Tree& tree, double weight) const {
  tree.start = depot_edge(cycle_.start_end());
  tree.finish = depot_edge(cycle_.finish_end());
  tree.bound = weight;
  for (const Edge& e : {tree.start, tree.finish}) tree.bound += e.u + penalty(e.b);
  for (const double p : multipliers.penalty) tree.bound -= p;
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    tree.bound -= multipliers.set[s] * sets_[s].most();
  }
}

Tree Relaxation::dense_tree() const {
  struct Link {
    double w = kInfinity;
    int a = 0;
    int b = 0;
  };
  std::vector<Link> links(static_cast<std::size_t>(rows_));  // cheapest from the tree to each row
  std::vector<int> outside(static_cast<std::size_t>(rows_) - 1);
  std::iota(outside.begin(), outside.end(), 1);
  std::vector<double> w;
  Tree tree;
  double weight = 0.0;
  for (int row = 0; !outside.empty();) {
    for (int a = 2 * row; a < 2 * row + 2; ++a) {
      weigh(a, w);
      for (const int other : outside) {
        Link& link = links[static_cast<std::size_t>(other)];
        for (int b = 2 * other; b < 2 * other + 2; ++b) {
          if (w[static_cast<std::size_t>(b)] < link.w) {
            link = {w[static_cast<std::size_t>(b)], a, b};
          }
        }
      }
    }
    const auto nearest = std::min_element(outside.begin(), outside.end(), [&](int x, int y) {
      return links[static_cast<std::size_t>(x)].w < links[static_cast<std::size_t>(y)].w;
    });
    row = *nearest;
    *nearest = outside.back();
    outside.pop_back();
    const Link& link = links[static_cast<std::size_t>(row)];
    weight += link.w;
    tree.edges.push_back({link.a, link.b, cycle_.undirected(link.a, link.b)});
    tree.weights.push_back(link.w);
  }
  close(tree, weight);
  return tree;
}

Tree Relaxation::sparse_tree() {
  weigh_edges();
  for (Keyed& k : order_) k.w = weight_[static_cast<std::size_t>(k.edge)];
  std::sort(order_.begin(), order_.end(), [](const Keyed& x, const Keyed& y) {
    return x.w < y.w || (x.w == y.w && x.edge < y.edge);
  });
  std::iota(root_.begin(), root_.end(), 0);
  Tree tree;
  double weight = 0.0;
  for (const Keyed& k : order_) {
    const Edge& e = edges_[static_cast<std::size_t>(k.edge)];
    const int a = find(e.a / 2);
    const int b = find(e.b / 2);
    if (a == b) continue;
    root_[static_cast<std::size_t>(a)] = b;
    weight += k.w;
    tree.edges.push_back(e);
    tree.weights.push_back(k.w);
    tree.indices.push_back(k.edge);
    if (static_cast<int>(tree.edges.size()) == rows_ - 1) break;
  }
  close(tree, weight);
  return tree;
}

int Relaxation::find(int row) {
  while (root_[static_cast<std::size_t>(row)] != row) {
    int& up = root_[static_cast<std::size_t>(row)];
    up = root_[static_cast<std::size_t>(up)];
    row = up;
  }
  return row;
}

double Relaxation::rounded_down(double bound) const {
  double terms = std::abs(bound);
  for (const double p : multipliers.penalty) terms += 1e-3 * std::abs(p);
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    terms += 1e-3 * multipliers.set[s] * sets_[s].most();
  }
  return bound - kRounding * terms;
}

}  // namespace headland::tour
