// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace headland::internal {

/// The last events of a filter with the state after each, so that one that comes late is put in its
/// place and all after it are done again. State and Event are values; Event has `time_s`.
/// Does not allocate after construction. O(events after the new one).
template <class State, class Event>
class Replay {
 public:
  /// Keeps events of the last `span_s` [s], and at most `most` of them.
  Replay(double span_s, int most) : span_s_(span_s), entries_(static_cast<std::size_t>(most)) {}

  void reset(const State& state) {
    before_ = state;
    count_ = 0;
  }

  /// The state after all events.
  const State& state() const { return count_ == 0 ? before_ : at(count_ - 1).after; }
  /// Whether an event of this time would still be taken.
  bool reaches(double time_s) const {
    return count_ == 0 || (time_s >= at(count_ - 1).event.time_s - span_s_ &&
                           (count_ < entries_.size() || time_s >= at(0).event.time_s));
  }

  /// Puts `event` in and does it and all after it: `apply(State&, const Event&)`. Returns what
  /// apply returned for this event; nullopt when it is older than what is kept.
  template <class Apply>
  auto add(const Event& event, Apply&& apply)
      -> std::optional<decltype(apply(std::declval<State&>(), event))> {
    if (!reaches(event.time_s)) return std::nullopt;
    if (count_ == entries_.size()) {
      before_ = at(0).after;
      first_ = (first_ + 1) % entries_.size();
      --count_;
    }
    std::size_t place = count_++;
    for (; place > 0 && at(place - 1).event.time_s > event.time_s; --place) {
      at(place).event = at(place - 1).event;
    }
    at(place).event = event;
    State current = place == 0 ? before_ : at(place - 1).after;
    const auto outcome = apply(current, event);
    at(place).after = current;
    for (std::size_t i = place + 1; i < count_; ++i) {
      apply(current, at(i).event);
      at(i).after = current;
    }
    return outcome;
  }

 private:
  struct Entry {
    Event event;
    State after;
  };
  Entry& at(std::size_t i) { return entries_[(first_ + i) % entries_.size()]; }
  const Entry& at(std::size_t i) const { return entries_[(first_ + i) % entries_.size()]; }

  double span_s_;
  State before_{};  // before the oldest event that is kept
  std::vector<Entry> entries_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace headland::internal
