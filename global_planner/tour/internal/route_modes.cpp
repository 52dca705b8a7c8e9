// SPDX-License-Identifier: Apache-2.0
// Insertions that let all other visits of a route change their modes: putting one row between two
// others pays only if those behind it are then driven the other way (Vidal 2017, "Node, edge, arc
// routing and turn penalties").
#include <algorithm>

#include "global_planner/tour/internal/route_state.hpp"

namespace headland::tour {

// The best mode of the visit before a position, if the next site is `entry`; and the price of all
// up to there. -1: it is the start.
int RouteEvaluator::best_before(const RouteState& route, int position, int entry,
                                double& price) const {
  if (position == 0) {
    price = model_.price(model_.way(route.kind, model_.kind(route.kind).vehicle.start, entry));
    return -1;
  }
  const int task = route.visits[static_cast<std::size_t>(position - 1)].task;
  int best = 0;
  price = kNever;
  for (int m = 0; m < model_.modes(task); ++m) {
    const double value =
        route.until_mode[static_cast<std::size_t>((position - 1) * model_.most_modes() + m)] +
        model_.price(model_.way(route.kind, model_.mode({task, m}).exit, entry));
    if (value >= price) continue;
    price = value;
    best = m;
  }
  return best;
}

// The same for the visit at a position and all from there on, from the site `exit`.
int RouteEvaluator::best_behind(const RouteState& route, int position, int exit,
                                double& price) const {
  if (position == route.size()) {
    price = model_.price(model_.way(route.kind, exit, model_.kind(route.kind).vehicle.finish));
    return -1;
  }
  const int task = route.visits[static_cast<std::size_t>(position)].task;
  int best = 0;
  price = kNever;
  for (int m = 0; m < model_.modes(task); ++m) {
    const double value =
        route.from_mode[static_cast<std::size_t>(position * model_.most_modes() + m)] +
        model_.price(model_.way(route.kind, exit, model_.mode({task, m}).entry));
    if (value >= price) continue;
    price = value;
    best = m;
  }
  return best;
}

void RouteEvaluator::price_modes(RouteState& route) const {
  const int n = route.size();
  const auto modes = static_cast<std::size_t>(model_.most_modes());
  route.price = 0.0;
  route.until_mode.clear();
  route.from_mode.clear();
  int site = model_.kind(route.kind).vehicle.start;
  for (const Visit visit : route.visits) {
    route.price += model_.price(model_.way(route.kind, site, model_.mode(visit).entry)) +
                   model_.price(model_.work(route.kind, visit));
    site = model_.mode(visit).exit;
  }
  if (n > 0) {
    const int finish = model_.kind(route.kind).vehicle.finish;
    route.price += model_.price(model_.way(route.kind, site, finish));
  }
  if (modes == 1) return;
  route.until_mode.assign(route.visits.size() * modes, kNever);
  route.from_mode.assign(route.visits.size() * modes, kNever);
  const auto fill = [&](int i, bool until) {
    const int task = route.visits[static_cast<std::size_t>(i)].task;
    for (int m = 0; m < model_.modes(task); ++m) {
      const TourMode& mode = model_.mode({task, m});
      double rest = 0.0;
      until ? best_before(route, i, mode.entry, rest) : best_behind(route, i + 1, mode.exit, rest);
      auto& table = until ? route.until_mode : route.from_mode;
      table[static_cast<std::size_t>(i) * modes + static_cast<std::size_t>(m)] =
          rest + model_.price(model_.work(route.kind, {task, m}));
    }
  };
  for (int i = 0; i < n; ++i) fill(i, true);
  for (int i = n; i-- > 0;) fill(i, false);
}

double RouteEvaluator::price_of_insertion(const RouteState& route, int position,
                                          Visit visit) const {
  double before = 0.0;
  double behind = 0.0;
  best_before(route, position, model_.mode(visit).entry, before);
  best_behind(route, position, model_.mode(visit).exit, behind);
  return before + model_.price(model_.work(route.kind, visit)) + behind - route.price;
}

RouteEdit RouteEvaluator::insertion(const RouteState& route, int position, Visit visit,
                                    std::vector<Visit>& visits) const {
  int first = position;
  int last = position;
  visits.assign(route.visits.begin(), route.visits.end());
  visits.insert(visits.begin() + position, visit);
  double unused = 0.0;
  const auto set = [&](int i, int shift, int mode) {  // the mode of the route's visit i
    Visit& changed = visits[static_cast<std::size_t>(i + shift)];
    if (changed.mode == mode) return;
    changed.mode = mode;
    first = std::min(first, i);
    last = std::max(last, i + 1);
  };
  for (int i = position, entry = model_.mode(visit).entry; i > 0; --i) {
    set(i - 1, 0, best_before(route, i, entry, unused));
    entry = model_.mode(visits[static_cast<std::size_t>(i - 1)]).entry;
  }
  for (int i = position, exit = model_.mode(visit).exit; i < route.size(); ++i) {
    set(i, 1, best_behind(route, i, exit, unused));
    exit = model_.mode(visits[static_cast<std::size_t>(i + 1)]).exit;
  }
  visits.erase(visits.begin() + last + 1, visits.end());
  visits.erase(visits.begin(), visits.begin() + first);
  return {first, last, visits};
}

}  // namespace headland::tour
