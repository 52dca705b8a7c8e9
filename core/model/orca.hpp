// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/polygon.hpp"

namespace headland {

// Optimal reciprocal collision avoidance (van den Berg, Guy, Lin and Manocha 2011): velocities as
// half-planes and linear programs in them. Also a local planner's and a predictor's.

/// A border in the plane of velocities [m/s]; the velocities to the left of `direction` (a unit
/// vector), seen from `point`, are permitted.
struct VelocityLine {
  Point2 point{0.0, 0.0};
  Point2 direction{1.0, 0.0};
};

/// Another agent, as one agent sees it.
struct OrcaNeighbor {
  Point2 position{0.0, 0.0};
  Point2 velocity{0.0, 0.0};
  double reach_m = 1.0;  ///< centres stay this far apart: both radii, or what this pair keeps
  double share = 0.5;    ///< of the avoidance that is the one agent's own part, in (0, 1];
                         ///< whom it does not avoid at all is to be left out
};

/// The border of the velocities of an agent that is at `position` with `velocity` and avoids
/// `other` for `horizon_s` (overlapping: gets free within `step_s`), both > 0 (not checked).
VelocityLine orca_line(const Point2& position, const Point2& velocity, const OrcaNeighbor& other,
                       double horizon_s, double step_s);

/// The velocity nearest to `preferred` [m/s] within the disc of `max_speed` and left of all lines.
/// If there is none, the one that violates the lines behind the first `hard` (obstacles) least,
/// while those hold (if even those contradict each other, the one that violates them least).
/// In order, not randomised: deterministic. `scratch` is overwritten; no
/// allocation if its capacity is lines.size().
Point2 permitted_velocity(std::span<const VelocityLine> lines, std::size_t hard,
                          const Point2& preferred, double max_speed,
                          std::vector<VelocityLine>& scratch);

/// Static obstacles as ORCA sees them: rings of edges, seen from outside (counter-clockwise) or
/// from inside (clockwise, a fence); two points are a wall. An agent that got behind an edge does
/// not see it. Points that are not finite, and rings of less than two points, are left out.
class OrcaObstacles {
 public:
  OrcaObstacles() = default;
  explicit OrcaObstacles(const std::vector<Polyline>& rings);

  bool empty() const { return vertices_.empty(); }
  /// Appends the lines of all obstacles (the 64 nearest edges) that an agent of `radius` may reach
  /// in `horizon_s` at `max_speed`, nearest first; an agent takes all of that avoidance on itself.
  /// To stand still is always permitted. O(edges), about 3 ns each.
  void append_lines(const Point2& position, const Point2& velocity, double radius, double horizon_s,
                    double max_speed, std::vector<VelocityLine>& lines) const;

 private:
  struct Vertex {
    Point2 point{0.0, 0.0};
    Point2 direction{1.0, 0.0};  // to the next vertex
    std::size_t next = 0;
    std::size_t previous = 0;
    bool convex = true;
  };
  // The line of the edge that begins at a vertex; none if its neighbours' lines do.
  std::optional<VelocityLine> edge_line(const Vertex& begin, const Point2& position,
                                        const Point2& velocity, double radius,
                                        double horizon_s) const;

  std::vector<Vertex> vertices_;
};

}  // namespace headland
