// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "local_planner/local_planner.hpp"
#include "local_planner/mcts/internal/forecast.hpp"
#include "local_planner/mcts/internal/manoeuvres.hpp"

namespace headland::mcts {

/// What is searched for: the local goal and all that a step is judged by. Positions relative to the
/// forecast's origin.
struct Task {
  const Manoeuvres* moves = nullptr;
  const MctsConfig* config = nullptr;
  /// One; or one per cluster of the root's actions, if the agents react to the robot.
  const std::vector<Forecast>* forecasts = nullptr;
  const ClearanceMap* map = nullptr;
  double radius = 1.0;     ///< of the robot's disc [m]
  double centre = 0.0;     ///< of that disc, ahead of the base [m]
  Point2 goal{0.0, 0.0};   ///< the local goal
  double accuracy = 0.5;   ///< it is reached within this [m]
  bool final = false;      ///< it is the next place itself: time stops there
  double wanted = 1.0;     ///< speed [m/s]
  double scale = 5.0;      ///< differences of costs count as large from here on
  double detour = 2.0;     ///< what it costs to go around somebody [s]
  Point2 along{0.0, 0.0};  ///< the path's direction at the local goal; zero: there is none
};

/// Actions whose first steps are alike: the turns, and going slower.
constexpr int kClusters = Manoeuvres::kTurns + 1;
constexpr int cluster_of(int action) {
  return action % Manoeuvres::kSpeeds == 0 ? Manoeuvres::kTurns : action / Manoeuvres::kSpeeds;
}

/// The best plan of a tree: one state a step, from the root on.
struct Found {
  std::vector<Motion> states;
  std::vector<Action> actions;
  int first_action = 0;  ///< number of the root's action
  double cost = 0.0;
  bool braking = false;  ///< nothing is better than to brake at once
};

/// A tree of manoeuvres. Costs are along the whole plan: the way to a node, its rollout, then what
/// still remains. In a world of predictions a node is as good as the best plan through it, so the
/// best is handed up, not the mean (kSeed: the mean of the nodes' own costs, as in the paper).
class Tree {
 public:
  /// Starts anew at `root`.
  void reset(const Motion& root);
  /// Makes the root's child by `action` the root, at `root`: its subtree is kept as a guess that
  /// the search looks at first, and `keep` (gamma of Eq. 3) of its visits count. Returns the number
  /// of nodes kept; 0 if there is no such child (the tree is empty then: reset).
  int advance(int action, const Motion& root, double keep);
  /// Judges the root and braking; to be called once before expand.
  void begin(const Task& task);
  /// Looks at one node more.
  void expand(const Task& task);
  /// Writes the best plan so far; `found`'s buffers are reused.
  void best(const Task& task, Found& found) const;

  int size() const { return static_cast<int>(nodes_.size()); }

 private:
  enum class Rollout : std::uint8_t { kGo, kLeft, kRight, kBack, kBrake };

  struct Node {
    Motion motion;
    double cost = 0.0;    // from the root [s]
    double own = 0.0;     // of the plan that ends with this node's rollout
    double best = 0.0;    // of the plans through it
    double visits = 0.0;  // looks at it and below
    std::int32_t parent = -1;
    std::int32_t block = -1;  // of its children's numbers
    std::int8_t level = 0;
    std::int8_t action = 0;  // by which it was reached
    std::int8_t first = 0;   // the root's action that leads here
    std::int8_t guess = 0;   // the action that heads for the goal
    std::int8_t tried = 0;   // actions, nearest to `guess` first
    std::int8_t children = 0;
    Rollout rollout = Rollout::kGo;
    bool closed = false;  // contact or goal: no children
    bool fresh = false;   // judged since the last begin
  };

  struct Judged {
    double cost = 0.0;
    bool risky = false;
    bool blocked = false;  // by the map
    bool contact = false;
    bool arrived = false;
  };

  Node& node(int n) { return nodes_[static_cast<std::size_t>(n)]; }
  const Node& node(int n) const { return nodes_[static_cast<std::size_t>(n)]; }
  int child(const Node& n, int slot) const {
    return blocks_[static_cast<std::size_t>(n.block)][static_cast<std::size_t>(slot)];
  }
  int child_by(const Node& n, int action) const;
  Judged judge(const Task& task, int first, int level, const Motion& from, const Motion& to) const;
  struct Rolled {
    double cost = 0.0;
    bool clear = true;  // nobody came near
  };
  Rolled roll(const Task& task, int first, int level, Motion at, double cost, Rollout kind,
              Found* record) const;
  bool judge_node(const Task& task, int n);
  void close_with_rollout(const Task& task, Node& n) const;
  Action next_action(const Task& task, int first, const Motion& at, Rollout kind) const;
  bool add_child(const Task& task, int n);
  int select(const Task& task, int n) const;
  void hand_up(const Task& task, int n);

  std::vector<Node> nodes_;
  std::vector<std::array<std::int32_t, Manoeuvres::kCount>> blocks_;
  double brake_cost_ = 0.0;
};

}  // namespace headland::mcts
