// SPDX-License-Identifier: Apache-2.0
#include "local_planner/mcts/internal/tree.hpp"

#include <algorithm>
#include <cmath>

#include "local_planner/cost_to_go.hpp"

namespace headland::mcts {
namespace {

constexpr double kDetourLook = 6.0;      // people farther ahead than this will have moved [m]
constexpr double kWayBack = 2.0;         // a plan that ends beside the path stays so long [s]
constexpr double kBlockedCost = 1000.0;  // of driving into a static obstacle [s]

Point2 centre_of(const Task& task, const Motion& at) {
  return {at.x + task.centre * at.c, at.y + task.centre * at.s};
}

const Forecast& forecast_of(const Task& task, int first) {
  const auto& all = *task.forecasts;
  return all[all.size() == 1 ? 0 : static_cast<std::size_t>(cluster_of(first))];
}

Point2 in_base(const Motion& at, const Point2& place) {
  const double dx = place.x() - at.x;
  const double dy = place.y() - at.y;
  return {at.c * dx + at.s * dy, -at.s * dx + at.c * dy};
}

// What a plan that ends at `at` still needs to a place: seconds, or the first term of (003) Eq. 1.
double remaining(const Task& task, const Motion& at, const Point2& to) {
  const Point2 goal = in_base(at, to);
  if (task.config->cost == MctsCost::kSeed) return goal.squaredNorm();
  const Manoeuvres& moves = *task.moves;
  const auto seconds = [&](const Point2& place, double speed, double pace) {
    const double distance = forward_distance(place, task.accuracy, moves.radius());
    const double turn = moves.ackermann() || distance == 0.0
                            ? 0.0
                            : std::abs(std::atan2(place.y(), place.x())) / moves.turn_limit();
    const double slower = std::max(0.0, task.wanted - speed);
    return pace * distance / task.wanted + turn +
           slower * slower / (2.0 * moves.acceleration() * task.wanted);
  };
  const double forwards = seconds(goal, at.speed, 1.0);
  if (!moves.reverses() || goal.x() >= 0.0) return forwards;
  return std::min(forwards, seconds({-goal.x(), goal.y()}, -at.speed, task.config->reverse_ratio));
}

// Who still stands in the way at the end has to be gone around: by the way past him on one side
// that the vehicle can drive, which is long from right before him.
double detour(const Task& task, int first, const Motion& at) {
  const Forecast& forecast = forecast_of(task, first);
  if (!forecast.anyone_lingers()) return 0.0;
  const Point2 from = centre_of(task, at);
  const Point2 way = task.goal - from;
  const double distance = way.norm();
  if (distance < 1e-6) return 0.0;
  const Point2 to = from + std::min(1.0, kDetourLook / distance) * way;
  const double obstruction = forecast.obstruction(from.x(), from.y(), to.x(), to.y());
  if (obstruction <= 0.0) return 0.0;
  const auto around = [&](double side) {
    const Point2 beside = forecast.beside(from, task.goal, side);
    return remaining(task, at, beside) + (task.goal - beside).norm() / task.wanted;
  };
  const double longer = std::min(around(1.0), around(-1.0)) - remaining(task, at, task.goal);
  return obstruction * (task.detour + std::max(0.0, longer));
}

// What a second beside the path costs: its distance, weighted.
double beside_path(const Task& task, const Motion& at) {
  const Point2 off = Point2(at.x, at.y) - task.goal;
  return task.config->return_per_m * std::abs(task.along.x() * off.y() - task.along.y() * off.x());
}

// Less the farther ahead, as the agents' own.
double contact_cost(const Task& task, int level) {
  const MctsConfig& config = *task.config;
  return config.contact_s * std::exp(-level * config.step_s / config.trust_s);
}

}  // namespace

void Tree::reset(const Motion& root) {
  nodes_.clear();
  blocks_.clear();
  nodes_.emplace_back();
  nodes_.front().motion = root;
}

// Its child by that action; -1: there is none.
int Tree::child_by(const Node& n, int action) const {
  for (int slot = 0; slot < n.children; ++slot) {
    if (node(child(n, slot)).action == action) return child(n, slot);
  }
  return -1;
}

int Tree::advance(int action, const Motion& root, double keep) {
  const int from = nodes_.empty() ? -1 : child_by(node(0), action);
  if (from < 0) return 0;
  std::vector<Node> kept{node(from)};
  std::vector<std::array<std::int32_t, Manoeuvres::kCount>> blocks;
  kept.front().parent = -1;
  kept.front().motion = root;
  for (std::size_t n = 0; n < kept.size(); ++n) {
    Node copy = kept[n];
    copy.visits *= keep;
    copy.level = static_cast<std::int8_t>(copy.level - 1);
    copy.fresh = false;
    if (copy.tried > copy.children) copy.tried = 0;  // what was refused may be possible now
    if (copy.parent == 0) copy.first = copy.action;
    if (copy.parent > 0) copy.first = kept[static_cast<std::size_t>(copy.parent)].first;
    if (copy.block >= 0) {
      auto block = blocks_[static_cast<std::size_t>(copy.block)];
      for (int slot = 0; slot < copy.children; ++slot) {
        auto& number = block[static_cast<std::size_t>(slot)];
        Node below = node(number);
        below.parent = static_cast<std::int32_t>(n);
        number = static_cast<std::int32_t>(kept.size());
        kept.push_back(below);
      }
      copy.block = static_cast<std::int32_t>(blocks.size());
      blocks.push_back(block);
    }
    kept[n] = copy;
  }
  nodes_ = std::move(kept);
  blocks_ = std::move(blocks);
  return size();
}

// One step: time, risk, steering; whether it is possible.
Tree::Judged Tree::judge(const Task& task, int first, int level, const Motion& from,
                         const Motion& to) const {
  const MctsConfig& config = *task.config;
  const Point2 a = centre_of(task, from);
  const Point2 b = centre_of(task, to);
  Judged judged;
  if (task.map != nullptr && !task.map->empty()) {
    const Point2 origin = forecast_of(task, first).origin();
    judged.blocked = !task.map->disc_passes(a + origin, b + origin, task.radius);
  }
  const double faster = std::max(std::abs(from.speed), std::abs(to.speed));
  const StepRisk risk = forecast_of(task, first).step(level, a.x(), a.y(), b.x(), b.y(), faster);
  judged.contact = risk.contact;
  judged.risky = risk.cost > 0.0;
  const double gear = to.speed < -1e-3 ? config.reverse_ratio : 1.0;
  const double steering = std::abs(to.turn - from.turn) / (2.0 * task.moves->turn_limit());
  const double pace = std::abs(to.speed - from.speed) / task.wanted;
  judged.cost = config.step_s * (gear + risk.cost) + config.steering_ratio * steering +
                config.pace_ratio * pace;
  // Of two plans that end alike, the one that gets on first.
  judged.cost +=
      config.step_s * config.progress_ratio * (Point2(to.x, to.y) - task.goal).norm() / task.wanted;
  judged.cost += config.step_s * beside_path(task, to);
  judged.arrived =
      task.final && (Point2(to.x, to.y) - task.goal).squaredNorm() <= task.accuracy * task.accuracy;
  return judged;
}

Action Tree::next_action(const Task& task, int first, const Motion& at, Rollout kind) const {
  const Manoeuvres& moves = *task.moves;
  Point2 goal = task.goal;
  switch (kind) {
    case Rollout::kBrake:
      return moves.braking(at);
    case Rollout::kBack:
      return moves.action(at, moves.backwards(at, goal.x(), goal.y()), task.wanted);
    case Rollout::kLeft:
    case Rollout::kRight:
      goal = forecast_of(task, first)
                 .beside(centre_of(task, at), goal, kind == Rollout::kLeft ? 1.0 : -1.0);
      break;
    case Rollout::kGo:
      break;
  }
  return moves.action(at, moves.towards(at, goal.x(), goal.y(), task.wanted), task.wanted);
}

// The cost of a plan that goes on from `at` by itself: heading for the goal, or braking. Writes its
// states and actions if there is a `record`.
Tree::Rolled Tree::roll(const Task& task, int first, int level, Motion at, double cost,
                        Rollout kind, Found* record) const {
  bool clear = true;
  for (; level < task.config->depth_count; ++level) {
    const Action action = next_action(task, first, at, kind);
    const Motion to = task.moves->drive(at, action);
    const Judged judged = judge(task, first, level, at, to);
    if (record != nullptr) {
      record->actions.push_back(action);
      record->states.push_back(to);
    }
    cost += judged.cost;
    clear = clear && !judged.risky;
    if (judged.arrived) return {cost, clear};
    if (judged.blocked) return {cost + kBlockedCost, false};
    if (judged.contact) {
      return {cost + contact_cost(task, level) + remaining(task, to, task.goal), false};
    }
    at = to;
  }
  const double around = detour(task, first, at);
  return {cost + remaining(task, at, task.goal) + around + kWayBack * beside_path(task, at),
          clear && around <= 0.0};
}

void Tree::close_with_rollout(const Task& task, Node& n) const {
  if (task.config->cost == MctsCost::kSeed) {
    const Point2 centre = centre_of(task, n.motion);
    n.own = remaining(task, n.motion, task.goal) +
            forecast_of(task, n.first).seed_cost(n.level, centre.x(), centre.y());
    return;
  }
  n.rollout = Rollout::kGo;
  const Rolled going = roll(task, n.first, n.level, n.motion, n.cost, Rollout::kGo, nullptr);
  n.own = going.cost;
  const auto offer = [&](Rollout other) {
    const Rolled rolled = roll(task, n.first, n.level, n.motion, n.cost, other, nullptr);
    if (rolled.cost >= n.own) return;
    n.own = rolled.cost;
    n.rollout = other;
  };
  if (!going.clear) offer(Rollout::kBrake);
  if (!going.clear && forecast_of(task, n.first).anyone_lingers()) {
    offer(Rollout::kLeft);
    offer(Rollout::kRight);
  }
  if (task.moves->reverses() && in_base(n.motion, task.goal).x() < 0.0) offer(Rollout::kBack);
}

// Finds the cost of a node anew from its parent's state. False if it is no step at all.
bool Tree::judge_node(const Task& task, int number) {
  Node& n = node(number);
  const Node& parent = node(n.parent);
  const Action action = task.moves->action(parent.motion, n.action, task.wanted);
  n.motion = task.moves->drive(parent.motion, action);
  const Judged judged = judge(task, n.first, parent.level, parent.motion, n.motion);
  n.cost = parent.cost + judged.cost;
  n.fresh = true;
  n.closed = judged.contact || judged.arrived || judged.blocked;
  n.rollout = Rollout::kGo;
  if (judged.blocked) {
    n.own = n.cost + kBlockedCost;
  } else if (judged.contact) {
    n.own = n.cost + contact_cost(task, parent.level) + remaining(task, n.motion, task.goal);
  } else if (judged.arrived) {
    n.own = task.config->cost == MctsCost::kSeed ? 0.0 : n.cost;
  } else {
    close_with_rollout(task, n);
  }
  n.best = n.own;
  // The paper's valid actions are those without a collision.
  const bool valid = task.config->cost != MctsCost::kSeed || !judged.contact;
  return valid && !judged.blocked;
}

void Tree::begin(const Task& task) {
  Node& root = node(0);
  root.level = 0;
  root.cost = 0.0;
  root.closed = false;
  root.fresh = true;
  const int guess = task.moves->towards(root.motion, task.goal.x(), task.goal.y(), task.wanted);
  if (root.tried == 0) root.guess = static_cast<std::int8_t>(guess);
  root.first = static_cast<std::int8_t>(guess);
  close_with_rollout(task, root);
  root.best = root.own;
  root.visits = std::max(root.visits, 1.0);
  constexpr int kHold = Manoeuvres::kTurns / 2 * Manoeuvres::kSpeeds;
  brake_cost_ = roll(task, kHold, 0, root.motion, 0.0, Rollout::kBrake, nullptr).cost;
}

bool Tree::add_child(const Task& task, int number) {
  if (node(number).block < 0) {
    node(number).block = static_cast<std::int32_t>(blocks_.size());
    blocks_.emplace_back();
  }
  Node& parent = node(number);
  if (parent.tried == 0 && parent.parent >= 0) {
    parent.guess = static_cast<std::int8_t>(
        task.moves->towards(parent.motion, task.goal.x(), task.goal.y(), task.wanted));
  }
  Node n;
  n.action = static_cast<std::int8_t>(Manoeuvres::nearest(parent.guess, parent.tried));
  ++parent.tried;
  if (child_by(parent, n.action) >= 0) return false;
  n.parent = static_cast<std::int32_t>(number);
  n.level = static_cast<std::int8_t>(parent.level + 1);
  n.first = parent.parent < 0 ? n.action : parent.first;
  const int added = size();
  nodes_.push_back(n);
  if (!judge_node(task, added)) {
    nodes_.pop_back();
    return false;
  }
  Node& again = node(number);
  blocks_[static_cast<std::size_t>(again.block)][static_cast<std::size_t>(again.children)] = added;
  ++again.children;
  return true;
}

// Upper confidence bound on trees, on costs: the smaller the better.
int Tree::select(const Task& task, int number) const {
  const Node& parent = node(number);
  const double log_visits = std::log(parent.visits + 1.0);
  int best = -1;
  double least = 0.0;
  for (int slot = 0; slot < parent.children; ++slot) {
    const int c = child(parent, slot);
    const Node& n = node(c);
    const double value = (n.best - node(0).best) / task.scale -
                         task.config->exploration_ratio * std::sqrt(log_visits / (n.visits + 1e-3));
    if (best < 0 || value < least) {
      best = c;
      least = value;
    }
  }
  return best;
}

void Tree::hand_up(const Task& task, int number) {
  const double own = node(number).own;
  const bool mean = task.config->cost == MctsCost::kSeed;
  for (int n = number; n >= 0; n = node(n).parent) {
    Node& at = node(n);
    at.visits += 1.0;
    at.best = mean ? at.best + (own - at.best) / at.visits : std::min(at.best, own);
  }
}

void Tree::expand(const Task& task) {
  const MctsConfig& config = *task.config;
  int n = 0;
  for (;;) {
    if (!node(n).fresh) {
      judge_node(task, n);
      return hand_up(task, n);
    }
    if (node(n).closed || node(n).level >= config.depth_count) return hand_up(task, n);
    const int allowed = static_cast<int>(config.widening_ratio *
                                         std::pow(node(n).visits, config.widening_exponent_ratio));
    bool added = false;
    while (!added && node(n).children < std::min(allowed, Manoeuvres::kCount) &&
           node(n).tried < Manoeuvres::kCount) {
      added = add_child(task, n);
    }
    if (added) return hand_up(task, size() - 1);
    if (node(n).children == 0) {
      node(n).closed = true;  // walled in
      return hand_up(task, n);
    }
    n = select(task, n);
  }
}

void Tree::best(const Task& task, Found& found) const {
  found.states.assign(1, node(0).motion);
  found.actions.clear();
  const bool mean = task.config->cost == MctsCost::kSeed;
  found.braking = mean ? node(0).children == 0 : brake_cost_ <= node(0).best;
  int n = 0;
  while (!found.braking) {
    int next = -1;
    for (int slot = 0; slot < node(n).children; ++slot) {
      const int c = child(node(n), slot);
      if (!node(c).fresh) continue;
      if (next < 0 || node(c).best < node(next).best) next = c;
    }
    if (next < 0 || (!mean && node(n).own <= node(next).best)) break;
    found.actions.push_back(task.moves->action(node(n).motion, node(next).action, task.wanted));
    found.states.push_back(node(next).motion);
    n = next;
  }
  constexpr int kHold = Manoeuvres::kTurns / 2 * Manoeuvres::kSpeeds;
  const Node& last = node(n);
  found.cost = found.braking ? brake_cost_ : node(0).best;
  if (found.braking || !last.closed) {
    roll(task, found.braking ? kHold : last.first, last.level, last.motion, last.cost,
         found.braking ? Rollout::kBrake : last.rollout, &found);
  }
  found.first_action = found.braking ? kHold : node(0).guess;
  if (n > 0) {
    int top = n;
    while (node(top).parent > 0) top = node(top).parent;
    found.first_action = node(top).action;
  } else if (!found.braking) {
    found.first_action = last.rollout == Rollout::kBrake ? kHold : node(0).first;
  }
}

}  // namespace headland::mcts
