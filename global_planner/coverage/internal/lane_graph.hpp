// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "global_planner/coverage/internal/turn.hpp"
#include "global_planner/coverage/internal/way_pricer.hpp"

namespace headland::coverage {

/// An end of ways, seen outwards: they leave it (kForth), or enter it (kBack; as tracks, these too
/// are laid from the port outwards).
struct Port {
  TurnEnd end;
  Travel travel = Travel::kForth;
};

/// What a way costs and is.
struct WayCost {
  double cost = 0.0;  ///< in the objective's unit
  DriveCost drive;
  int cusps = 0;

  friend WayCost operator+(const WayCost& a, const WayCost& b) {
    return {a.cost + b.cost, a.drive + b.drive, a.cusps + b.cusps};
  }
};

/// A track from a port out to a node of the lane graph.
struct Connection {
  int node = 0;
  WayCost
      way;  ///< of the turn, driven as the port's ways are: out of it (kForth) or into it (kBack)
  Turn turn;
};

/// A row that may be driven through without work, in one direction.
struct Passage {
  Path path;
  std::vector<Connection> in;   ///< of the port where `path` begins
  std::vector<Connection> out;  ///< of the port where it ends
};

/// A roadmap of poses joined by Dubins curves along which the outline fits, closed under mirroring:
/// node 2 k + 1 is node 2 k looking back, and with every edge a -> b goes b^1 -> a^1 along the same
/// track. Thus the way from one port to another, mirrored, is the way back.
class LaneGraph {
 public:
  /// Joins the poses, also with their own reverse where there is room to turn round (a three-point
  /// turn if the vehicle `reverses`, else a loop). Of longer edges only those are kept that are
  /// notably shorter than two shorter ones (a greedy spanner).
  LaneGraph(const FreeSpace& space, std::vector<Pose2> poses, double radius, bool reverses,
            const WayPricer& pricer);

  int nodes() const { return 2 * static_cast<int>(poses_.size()); }
  Pose2 pose(int node) const;
  /// The cheapest tracks from a port to nodes around it, none of which leads past another.
  /// @param reversing By Reeds-Shepp curves, where there is too little room to turn in forwards.
  std::vector<Connection> connect(const Port& port, bool reversing) const;
  /// Adds rows to pass through. Once, before any query.
  void add_passages(std::vector<Passage> passages);

  /// Ways from one port to everywhere. An object of its own so that queries can share its memory.
  class Search {
   public:
    explicit Search(const LaneGraph& graph);
    void run(const std::vector<Connection>& from);
    /// The way on to a port: from there its mirrored connections lead in; infinite if none.
    WayCost to(const std::vector<Connection>& port) const;
    /// The way itself, from `out`, a pose at the port where the search began.
    Path path_to(const Pose2& out, const std::vector<Connection>& from,
                 const std::vector<Connection>& port) const;

   private:
    int best_entry(const std::vector<Connection>& port) const;

    // How a node is reached.
    struct Reached {
      WayCost way;
      double reduced = 0.0;  // its cost less the node's potential
      int last_step = -1;    // -1: none; below: -2 - index of the first connection
    };
    const LaneGraph& graph_;
    std::vector<Reached> reached_;  // of nodes
    std::vector<std::pair<double, int>> queue_;
  };

 private:
  enum class StepKind { kLane, kTurnRound, kIntoRow, kOutOfRow };
  // An edge in one direction.
  struct Step {
    int from = 0;
    int to = 0;
    WayCost way;
    StepKind kind = StepKind::kLane;
    double radius = 0.0;    // kLane: of the curve [m]
    bool mirrored = false;  // kLane: driven from the end of the curve to its start;
                            // kTurnRound: to the other hand
    int passage = -1;       // kIntoRow, kOutOfRow
    int connection = -1;
  };
  // Of a step, what Dijkstra's inner loop needs.
  struct Arc {
    double reduced;  // cost plus the potential that is lost: >= 0
    WayCost way;
    int to;
  };
  // A track from a port to a node.
  struct Option {
    double cost;  // a lower bound until the curve is known
    double lead;
    double radius;
    int node;
    bool known;
    Curve curve(const LaneGraph& graph, const Pose2& out, bool reversing) const;
  };
  struct Candidate {
    double length;
    int from;
    int to;
  };
  void index_poses();
  template <class Visit>
  void visit_near(const Point2& p, double distance, Visit visit) const;
  std::vector<Candidate> candidates() const;
  std::vector<Option> options(const TurnEnd& end) const;
  bool bypassed(const Candidate& edge) const;
  void join(const std::vector<Candidate>& candidates);
  Curve turn_round(bool other_hand) const;
  void join_reverses();
  double fitting_radius(const Candidate& edge) const;
  WayCost priced(const Path& path, int cusps = -1) const;
  double potential(const Pose2& pose) const { return pricer_.potential(pose.position()); }
  void price_steps();
  void sort_steps();
  Path step_path(const Step& step) const;

  const FreeSpace& space_;
  std::vector<Pose2> poses_;
  double radius_;
  bool reverses_;
  double reach_;  // longest distance of an edge [m]
  const WayPricer& pricer_;
  CostRate rate_;  // on flat ground, for the order in which tracks are tried
  std::vector<Passage> passages_;
  std::vector<Step> steps_;        // by their beginning
  std::vector<Arc> arcs_;          // of the steps, in their order
  std::vector<int> step_begin_;    // of node n: [step_begin_[n], step_begin_[n + 1])
  std::vector<double> potential_;  // of nodes, then passages
  std::vector<std::vector<std::pair<int, double>>> accepted_;  // while joining: to, length
  // Poses in a grid of cells `reach_` wide.
  Point2 corner_{0.0, 0.0};
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<int>> cells_;
};

}  // namespace headland::coverage
