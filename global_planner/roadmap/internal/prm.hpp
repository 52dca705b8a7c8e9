// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "global_planner/roadmap/internal/track.hpp"

namespace headland::internal {

/// One end of an edge: a node in one of its two headings. Numbered 2 * node, + 1 looking back.
using Heading = int;
inline Heading looking_back(Heading h) { return h ^ 1; }

/// A track between two nodes: forwards from `from` to `to`, backwards from `to` looking back to
/// `from` looking back.
struct RoadEdge {
  Heading from = 0;
  Heading to = 0;
  Track track;
  Ways open;
  DriveCost forwards;
  DriveCost backwards;
};

/// A roadmap of which each node stands for both headings along its direction. Growing it further
/// gives the same as growing it so far at once; a roadmap of fewer samples is the beginning of one
/// of more.
struct RoadGraph {
  std::vector<Pose2> nodes;
  std::vector<RoadEdge> edges;  ///< in the order of their later node
  std::int64_t draws = 0;       ///< samples drawn, those that did not fit included
  int samples = 0;              ///< asked for; more than nodes where there is no room

  Pose2 pose(Heading h) const {
    const Pose2& node = nodes[static_cast<std::size_t>(h / 2)];
    return h % 2 == 0 ? node : reversed(node);
  }
  int headings() const { return 2 * static_cast<int>(nodes.size()); }
  /// The roadmap of its first `count` nodes.
  void cut(int count);
};

/// Grows the roadmap to `samples` nodes by OMPL's PRM.
void grow(RoadGraph& graph, const TrackMaker& tracks, int samples, std::uint64_t seed,
          double margin);

}  // namespace headland::internal
