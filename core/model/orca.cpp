// SPDX-License-Identifier: Apache-2.0
#include "core/model/orca.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

// Symbols as in van den Berg et al. 2011, "Reciprocal n-body collision avoidance":
//   velocity obstacle  the relative velocities that lead to contact within the horizon: a cone with
//                      its tip cut off by a disc (or by an edge with a disc at either end)
//   u                  the smallest change of relative velocity that leaves the velocity obstacle
//   t                  place along a line [m/s]

namespace headland {
namespace {

// Lines whose directions differ by less than this angle [rad] count as parallel.
constexpr double kParallel = 1e-9;
// An edge whose cut-off is forbidden by another line up to this [m/s] is covered by it.
constexpr double kCovered = 1e-5;
constexpr std::size_t kMaxEdges = 64;

double cross(const Point2& a, const Point2& b) { return a.x() * b.y() - a.y() * b.x(); }
Point2 left_of(const Point2& a) { return {-a.y(), a.x()}; }
Point2 right_of(const Point2& a) { return {a.y(), -a.x()}; }

// How far `v` lies beyond the line, on its forbidden side [m/s].
double violation(const VelocityLine& line, const Point2& v) {
  return cross(line.direction, line.point - v);
}

// From the origin along the tangent of a disc of `radius` around `center`, `distance2` > radius^2
// away: its left (side = 1) or right (-1) tangent. Unit vector.
Point2 tangent(const Point2& center, double distance2, double radius, double side) {
  const double length = std::sqrt(distance2 - radius * radius);
  return (length * center + side * radius * left_of(center)) / distance2;
}

// The border of a disc of the velocity obstacle where a velocity that is `w` from its centre leaves
// it; `otherwise` (unit vector) is the way out of the centre itself.
VelocityLine around_disc(const Point2& center, double radius, const Point2& w,
                         const Point2& otherwise) {
  const double length = w.norm();
  const Point2 out = length > 0.0 ? Point2(w / length) : otherwise;
  return {center + radius * out, right_of(out)};
}

// What velocities on a line are compared by: nearness to `wish`, or how far along it they are.
enum class Aim { kNearest, kFarthest };

// The best velocity on `line` within the disc and left of all `others`, if there is one: in their
// places along the line, they all are bounds of an interval (section 5.3 of the article).
bool solve_on_line(std::span<const VelocityLine> others, const VelocityLine& line,
                   const Point2& wish, double max_speed, Aim aim, Point2& velocity) {
  const double middle = -line.point.dot(line.direction);
  const double reach2 = middle * middle + max_speed * max_speed - line.point.squaredNorm();
  if (!(reach2 >= 0.0)) return false;
  const double reach = std::sqrt(reach2);
  double low = middle - reach;
  double high = middle + reach;
  for (const VelocityLine& other : others) {
    const double sine = cross(line.direction, other.direction);
    const double gap = cross(other.direction, line.point - other.point);
    if (std::abs(sine) <= kParallel) {
      if (gap < 0.0) return false;
      continue;
    }
    const double t = gap / sine;
    if (sine > 0.0) {
      high = std::min(high, t);
    } else {
      low = std::max(low, t);
    }
    if (low > high) return false;
  }
  double t = wish.dot(line.direction) > 0.0 ? high : low;
  if (aim == Aim::kNearest) t = std::clamp((wish - line.point).dot(line.direction), low, high);
  velocity = line.point + t * line.direction;
  return true;
}

// The best velocity within the disc and left of all lines, found line by line: where the best so
// far breaks the next line, the new best lies on it. Returns the number of lines held; if not all,
// `velocity` is the best of those. `wish` is a unit vector if the aim is the farthest.
std::size_t solve(std::span<const VelocityLine> lines, const Point2& wish, double max_speed,
                  Aim aim, Point2& velocity) {
  const double length2 = wish.squaredNorm();
  velocity = wish;
  if (aim == Aim::kFarthest) {
    velocity *= max_speed;
  } else if (length2 > max_speed * max_speed) {
    velocity *= max_speed / std::sqrt(length2);
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!(violation(lines[i], velocity) > 0.0)) continue;
    if (!solve_on_line(lines.first(i), lines[i], wish, max_speed, aim, velocity)) return i;
  }
  return lines.size();
}

// The line along which `a` and `b` are violated alike; where a is violated most, the velocities
// that violate b less are left of it. None if b is a shifted along itself.
std::optional<VelocityLine> equal_violation(const VelocityLine& a, const VelocityLine& b) {
  const double sine = cross(a.direction, b.direction);
  Point2 point = 0.5 * (a.point + b.point);
  if (std::abs(sine) > kParallel) {
    point = a.point + cross(b.direction, a.point - b.point) / sine * a.direction;
  } else if (a.direction.dot(b.direction) > 0.0) {
    return std::nullopt;
  }
  return VelocityLine{point, (b.direction - a.direction).normalized()};
}

// From the best velocity for the lines before `begin`, the one whose largest violation of the lines
// behind the first `hard` is least while those hold: a linear program in velocity and violation,
// again line by line.
void least_violation(std::span<const VelocityLine> lines, std::size_t hard, std::size_t begin,
                     double max_speed, std::vector<VelocityLine>& scratch, Point2& velocity) {
  double worst = 0.0;
  for (std::size_t i = begin; i < lines.size(); ++i) {
    if (!(violation(lines[i], velocity) > worst)) continue;
    scratch.assign(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(hard));
    for (std::size_t j = hard; j < i; ++j) {
      if (const auto line = equal_violation(lines[i], lines[j])) scratch.push_back(*line);
    }
    Point2 better;
    // There is one, up to rounding: the velocity at hand.
    if (solve(scratch, left_of(lines[i].direction), max_speed, Aim::kFarthest, better) ==
        scratch.size()) {
      velocity = better;
    }
    worst = violation(lines[i], velocity);
  }
}

}  // namespace

VelocityLine orca_line(const Point2& position, const Point2& velocity, const OrcaNeighbor& other,
                       double horizon_s, double step_s) {
  const Point2 offset = other.position - position;
  const Point2 relative = velocity - other.velocity;
  const double distance2 = offset.squaredNorm();
  const double reach2 = other.reach_m * other.reach_m;
  const bool apart = distance2 > reach2;
  const double rate = 1.0 / (apart ? horizon_s : step_s);
  const Point2 w = relative - rate * offset;
  const double along = w.dot(offset);
  VelocityLine border;  // of the relative velocities
  if (apart && !(along < 0.0 && along * along > reach2 * w.squaredNorm())) {
    const double side = cross(offset, w) > 0.0 ? 1.0 : -1.0;
    border.direction = side * tangent(offset, distance2, other.reach_m, side);
    border.point = relative.dot(border.direction) * border.direction;
  } else {
    const Point2 away = distance2 > 0.0 ? Point2(-offset / std::sqrt(distance2)) : Point2(1.0, 0.0);
    border = around_disc(rate * offset, rate * other.reach_m, w, away);
  }
  return {velocity + other.share * (border.point - relative), border.direction};
}

Point2 permitted_velocity(std::span<const VelocityLine> lines, std::size_t hard,
                          const Point2& preferred, double max_speed,
                          std::vector<VelocityLine>& scratch) {
  Point2 velocity;
  const std::size_t held = solve(lines, preferred, max_speed, Aim::kNearest, velocity);
  if (held == lines.size()) return velocity;
  if (held < hard) {  // the obstacles contradict each other: nobody else counts
    least_violation(lines.first(hard), 0, held, max_speed, scratch, velocity);
  } else {
    least_violation(lines, hard, held, max_speed, scratch, velocity);
  }
  return velocity;
}

// ---- Obstacles

OrcaObstacles::OrcaObstacles(const std::vector<Polyline>& rings) {
  for (const Polyline& ring : rings) {
    const std::size_t first = vertices_.size();
    for (const Point2& p : ring) {
      const bool repeated = vertices_.size() > first && p == vertices_.back().point;
      if (p.allFinite() && !repeated) vertices_.push_back({p});
    }
    if (vertices_.size() > first + 1 && vertices_.back().point == vertices_[first].point) {
      vertices_.pop_back();
    }
    const std::size_t count = vertices_.size() - first;
    if (count < 2) vertices_.resize(first);
    for (std::size_t i = first; i < vertices_.size(); ++i) {
      Vertex& vertex = vertices_[i];
      vertex.next = first + (i - first + 1) % count;
      vertex.previous = first + (i - first + count - 1) % count;
      const Point2 ahead = vertices_[vertex.next].point - vertex.point;
      vertex.direction = ahead.normalized();
      vertex.convex = cross(vertex.point - vertices_[vertex.previous].point, ahead) >= 0.0;
    }
  }
}

namespace {

// The velocity obstacle of an edge: two cut-off discs, what lies between, and a leg behind each.
struct EdgeCone {
  Point2 left;   // centre of the left cut-off disc [m/s]
  Point2 right;  // ... and the right one
  Point2 left_leg;
  Point2 right_leg;
  bool left_foreign = false;   // the leg is the neighbouring edge, which has its own line
  bool right_foreign = false;  // likewise
  bool single = false;         // both discs are the same: the edge is seen from its end
  Point2 direction;            // of the edge
};

struct Near {
  double distance;  // [m]
  std::size_t vertex;
};

// Where `velocity` leaves the cone; `radius` is that of the cut-off discs [m/s].
std::optional<VelocityLine> leave(const EdgeCone& cone, const Point2& velocity, double radius) {
  const Point2 from_left = velocity - cone.left;
  const Point2 from_right = velocity - cone.right;
  const Point2 across = cone.right - cone.left;
  const double t = cone.single ? 0.5 : from_left.dot(across) / across.squaredNorm();
  const double t_left = from_left.dot(cone.left_leg);
  const double t_right = from_right.dot(cone.right_leg);
  const Point2 away = right_of(cone.direction);
  if ((t < 0.0 && t_left < 0.0) || (cone.single && t_left < 0.0 && t_right < 0.0)) {
    return around_disc(cone.left, radius, from_left, away);
  }
  if (t > 1.0 && t_right < 0.0) return around_disc(cone.right, radius, from_right, away);

  constexpr double kNever = std::numeric_limits<double>::infinity();
  const bool facing = !cone.single && t >= 0.0 && t <= 1.0;
  const double edge2 = facing ? (from_left - t * across).squaredNorm() : kNever;
  const double left2 = t_left < 0.0 ? kNever : (from_left - t_left * cone.left_leg).squaredNorm();
  const double right2 =
      t_right < 0.0 ? kNever : (from_right - t_right * cone.right_leg).squaredNorm();
  if (edge2 <= left2 && edge2 <= right2) {
    return VelocityLine{cone.left + radius * away, -cone.direction};
  }
  if (left2 <= right2) {
    if (cone.left_foreign) return std::nullopt;
    return VelocityLine{cone.left + radius * left_of(cone.left_leg), cone.left_leg};
  }
  if (cone.right_foreign) return std::nullopt;
  return VelocityLine{cone.right + radius * right_of(cone.right_leg), -cone.right_leg};
}

}  // namespace

std::optional<VelocityLine> OrcaObstacles::edge_line(const Vertex& begin, const Point2& position,
                                                     const Point2& velocity, double radius,
                                                     double horizon_s) const {
  const Vertex* left = &begin;  // as seen from outside
  const Vertex* right = &vertices_[begin.next];
  const Point2 to_left = left->point - position;
  const Point2 to_right = right->point - position;
  const double left2 = to_left.squaredNorm();
  const double right2 = to_right.squaredNorm();
  const double radius2 = radius * radius;
  const double length = (right->point - left->point).norm();
  const double along = -to_left.dot(begin.direction);  // of the agent's foot on the edge
  const double across = cross(begin.direction, to_left);
  const bool before = along < 0.0;
  const bool behind = along > length;

  // Touching: no velocity towards it.
  if (before && left2 <= radius2) {
    if (!left->convex) return std::nullopt;
    return VelocityLine{Point2(0.0, 0.0), left_of(to_left).normalized()};
  }
  if (behind && right2 <= radius2) {
    if (!right->convex || cross(to_right, right->direction) < 0.0) return std::nullopt;
    return VelocityLine{Point2(0.0, 0.0), left_of(to_right).normalized()};
  }
  const bool in_line = across * across <= radius2;
  if (!before && !behind && in_line) return VelocityLine{Point2(0.0, 0.0), -begin.direction};

  // Seen in line, one vertex hides all else.
  if (before && in_line) right = left;
  if (behind && in_line) left = right;
  EdgeCone cone;
  cone.single = left == right;
  if (cone.single && !left->convex) return std::nullopt;
  cone.direction = begin.direction;
  cone.left = (left->point - position) / horizon_s;
  cone.right = (right->point - position) / horizon_s;
  // A leg is the tangent at a convex vertex and goes on as the edge at one that is not.
  cone.left_leg = -begin.direction;
  cone.right_leg = begin.direction;
  if (left->convex) {
    const bool at_right = left != &begin;
    cone.left_leg = tangent(at_right ? to_right : to_left, at_right ? right2 : left2, radius, 1.0);
  }
  if (right->convex) {
    const bool at_left = right == &begin;
    cone.right_leg = tangent(at_left ? to_left : to_right, at_left ? left2 : right2, radius, -1.0);
  }
  // No leg runs into the neighbouring edge.
  const Point2 next_left = -vertices_[left->previous].direction;
  if (left->convex && cross(cone.left_leg, next_left) >= 0.0) {
    cone.left_leg = next_left;
    cone.left_foreign = true;
  }
  if (right->convex && cross(cone.right_leg, right->direction) <= 0.0) {
    cone.right_leg = right->direction;
    cone.right_foreign = true;
  }
  return leave(cone, velocity, radius / horizon_s);
}

void OrcaObstacles::append_lines(const Point2& position, const Point2& velocity, double radius,
                                 double horizon_s, double max_speed,
                                 std::vector<VelocityLine>& lines) const {
  const double range = horizon_s * max_speed + radius;
  std::array<Near, kMaxEdges> near;  // sorted
  std::size_t count = 0;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const Vertex& vertex = vertices_[i];
    const Point2& end = vertices_[vertex.next].point;
    if (!(cross(vertex.direction, position - vertex.point) < 0.0)) continue;  // its back
    const double distance = distance_to_segment(position, vertex.point, end);
    if (!(distance < range)) continue;
    if (count == kMaxEdges && !(distance < near.back().distance)) continue;
    count = std::min(count + 1, kMaxEdges);
    std::size_t k = count - 1;
    for (; k > 0 && near[k - 1].distance > distance; --k) near[k] = near[k - 1];
    near[k] = {distance, i};
  }

  const std::size_t first = lines.size();
  const double reach = radius / horizon_s;
  for (std::size_t k = 0; k < count; ++k) {
    const Vertex& vertex = vertices_[near[k].vertex];
    const Point2 a = (vertex.point - position) / horizon_s;
    const Point2 b = (vertices_[vertex.next].point - position) / horizon_s;
    // An edge whose whole cut-off is forbidden already adds nothing.
    const bool covered = std::any_of(lines.begin() + static_cast<std::ptrdiff_t>(first),
                                     lines.end(), [&](const VelocityLine& line) {
                                       return violation(line, a) >= reach - kCovered &&
                                              violation(line, b) >= reach - kCovered;
                                     });
    if (covered) continue;
    if (const auto line = edge_line(vertex, position, velocity, radius, horizon_s)) {
      lines.push_back(*line);
    }
  }
}

}  // namespace headland
