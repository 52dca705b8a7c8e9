// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/world/farm.hpp"

namespace headland {

/// Who charges where, and who waits: first come, first served.
class ChargerSlots {
 public:
  explicit ChargerSlots(const Farm& farm) : farm_(farm), queues_(farm.chargers.size()) {}

  int find(const std::string& id) const {
    for (std::size_t c = 0; c < farm_.chargers.size(); ++c) {
      if (farm_.chargers[c].id == id) return static_cast<int>(c);
    }
    return -1;
  }
  const Charger& charger(int c) const { return farm_.chargers[static_cast<std::size_t>(c)]; }
  void enqueue(int c, int vehicle) { queue(c).push_back(vehicle); }
  /// The first in the queue hold the slots.
  bool holds_slot(int c, int vehicle) const {
    const auto& all = queues_[static_cast<std::size_t>(c)];
    const auto at = std::find(all.begin(), all.end(), vehicle);
    return at - all.begin() < charger(c).slots;
  }
  void leave(int c, int vehicle) {
    queue(c).erase(std::find(queue(c).begin(), queue(c).end(), vehicle));
  }

 private:
  std::vector<int>& queue(int c) { return queues_[static_cast<std::size_t>(c)]; }
  const Farm& farm_;
  std::vector<std::vector<int>> queues_;  // of vehicles, at each charger
};

}  // namespace headland
