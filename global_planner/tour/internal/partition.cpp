// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/partition.hpp"

#include <algorithm>

namespace headland::tour {
namespace {

// One more vehicle of a kind: what it is given, and what those before it did.
struct Layer {
  int kind = 0;
  RouteTable shares;
};

// Shares of every set, vehicle by vehicle. Where all are of one kind they are interchangeable: the
// last one in use may be taken to do the set's first task.
class Layers {
 public:
  Layers(const Model& model, const std::vector<RouteTable>& tables)
      : model_(model), tables_(tables), span_counts_(model.problem().span_weight > 0.0) {
    Layer nobody{-1, RouteTable(tables.front().size())};
    nobody.shares[0].push_back({0.0, -kNever, -1, 0, 0});
    layers_.push_back(std::move(nobody));
  }

  void build() {
    for (int kind = 0; kind < static_cast<int>(tables_.size()); ++kind) {
      add_kind(kind);
    }
  }

  std::optional<Partition> best() const {
    const auto& last = layers_.back().shares;
    Partition partition;
    unsigned best_mask = 0;
    int best_share = -1;
    for (unsigned mask = 0; mask < last.size(); ++mask) {
      for (int i = 0; i < static_cast<int>(last[mask].size()); ++i) {
        const Share& share = last[mask][static_cast<std::size_t>(i)];
        double cost = share.value + lost(mask);
        if (span_counts_) cost += model_.problem().span_weight * std::max(0.0, share.time_s);
        if (cost >= partition.cost) continue;
        partition.cost = cost;
        best_mask = mask;
        best_share = i;
      }
    }
    if (best_share < 0) return {};
    unsigned mask = best_mask;
    int index = best_share;
    for (std::size_t l = layers_.size() - 1; l > 0; --l) {
      const Share& share = layers_[l].shares[mask][static_cast<std::size_t>(index)];
      if (share.part != 0) partition.routes.push_back({layers_[l].kind, share.route});
      mask &= ~share.part;
      index = share.rest;
    }
    return partition;
  }

 private:
  double lost(unsigned mask) const {
    double sum = 0.0;
    for (int t = 0; t < model_.tasks(); ++t) {
      if (!(mask >> t & 1U)) sum += model_.task(t).reward;
    }
    return sum;
  }

  void add_kind(int kind) {
    const std::size_t members = model_.kind(kind).members.size();
    for (std::size_t vehicle = 0; vehicle < members; ++vehicle) {
      if (!add_vehicle(kind)) break;
    }
  }

  // False, and nothing added, if one more vehicle is of no use.
  bool add_vehicle(int kind) {
    const auto& routes = tables_[static_cast<std::size_t>(kind)];
    const auto& before = layers_.back().shares;
    const bool only_kind = tables_.size() == 1;
    Layer layer{kind, RouteTable(before.size())};
    bool useful = false;
    for (unsigned mask = 0; mask < before.size(); ++mask) {
      auto& shares = layer.shares[mask];
      for (int i = 0; i < static_cast<int>(before[mask].size()); ++i) {
        Share idle = before[mask][static_cast<std::size_t>(i)];
        idle.route = -1;
        idle.part = 0;
        idle.rest = i;
        add_share(shares, idle, span_counts_);
      }
      const unsigned first = only_kind ? mask & (~mask + 1U) : 0U;
      for (unsigned part = mask; part != 0; part = (part - 1U) & mask) {
        if ((part & first) != first) continue;
        useful = combine(routes[part], before[mask & ~part], part, shares) || useful;
      }
    }
    if (useful) layers_.push_back(std::move(layer));
    return useful;
  }

  bool combine(const std::vector<Share>& routes, const std::vector<Share>& rests, unsigned part,
               std::vector<Share>& shares) const {
    bool added = false;
    for (const Share& route : routes) {
      for (int i = 0; i < static_cast<int>(rests.size()); ++i) {
        const Share& rest = rests[static_cast<std::size_t>(i)];
        const Share both{route.value + rest.value, std::max(route.time_s, rest.time_s), route.route,
                         part, i};
        added = add_share(shares, both, span_counts_) || added;
      }
    }
    return added;
  }

  const Model& model_;
  const std::vector<RouteTable>& tables_;
  bool span_counts_;
  std::vector<Layer> layers_;
};

}  // namespace

bool add_share(std::vector<Share>& shares, const Share& share, bool span_counts) {
  for (const Share& other : shares) {
    if (other.value <= share.value && (!span_counts || other.time_s <= share.time_s)) {
      return false;
    }
  }
  std::erase_if(shares, [&](const Share& other) {
    return share.value <= other.value && (!span_counts || share.time_s <= other.time_s);
  });
  shares.push_back(share);
  return true;
}

std::optional<Partition> cheapest_partition(const Model& model,
                                            const std::vector<RouteTable>& tables) {
  Layers layers(model, tables);
  layers.build();
  return layers.best();
}

}  // namespace headland::tour
