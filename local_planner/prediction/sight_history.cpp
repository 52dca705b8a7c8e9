// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/sight_history.hpp"

namespace headland {
namespace {

constexpr double kApart = 0.05;  // between kept sights [s]
constexpr double kSlack = 1e-9;  // of times that are sums of steps [s]

}  // namespace

void SightHistory::add(const Sight& sight) {
  // The newest is kept for good if it is far enough from the one before.
  const bool replace =
      size_ > 0 &&
      (sight.time_s - newest().time_s <= kSlack ||
       (size_ > 1 && newest().time_s - sights_[slot(size_ - 2)].time_s < kApart - kSlack));
  if (!replace) {
    if (size_ == kRoom) {
      first_ = slot(1);
    } else {
      ++size_;
    }
  }
  sights_[slot(size_ - 1)] = sight;
}

bool SightHistory::at(double time_s, Sight& sight) const {
  if (size_ == 0 || time_s < oldest().time_s - kSlack) return false;
  std::size_t after = size_;
  while (after > 0 && sights_[slot(after - 1)].time_s > time_s) --after;
  if (after == size_ || after == 0) {
    sight = after == 0 ? oldest() : newest();
    return true;
  }
  const Sight& a = sights_[slot(after - 1)];
  const Sight& b = sights_[slot(after)];
  const double ratio = (time_s - a.time_s) / (b.time_s - a.time_s);
  sight.time_s = time_s;
  sight.position = a.position + ratio * (b.position - a.position);
  sight.velocity = a.velocity + ratio * (b.velocity - a.velocity);
  return true;
}

}  // namespace headland
