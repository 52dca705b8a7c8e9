// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/ebs221/field.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/dubins.hpp"
#include "core/geometry/fishtail.hpp"

namespace headland {
namespace {

// Points of a row as (002) spaces them, the first left out.
void add_row_points(const FieldLink& link, std::vector<Point2>& points) {
  const Point2 from = link.from.position();
  const Point2 along = link.to.position() - from;
  const int count = static_cast<int>(std::ceil(along.norm() / kSeedRowSpacing));
  for (int i = 1; i < count; ++i) points.push_back(from + i * along / (count - 1.0));
}

// Points of a turn every kSeedTurnSpacing from its start, which is left out.
void add_turn_points(const FieldLink& link, double radius, std::vector<Point2>& points) {
  Path turn;
  turn.append(shortest_dubins(link.from, link.to, radius), link.from, 0);
  for (double s = kSeedTurnSpacing; s < turn.length(); s += kSeedTurnSpacing) {
    points.push_back(turn.at(s).pose.position());
  }
}

// A row's guided point is its middle; a turn's is its lowest or highest point, whichever end of the
// rows it is at. (002) Alg. 3
Point2 guided_point(const std::vector<Point2>& points, std::size_t first, bool turn,
                    double middle_y) {
  if (!turn) return 0.5 * (points[first] + points.back());
  double mean = 0.0;
  for (std::size_t i = first; i < points.size(); ++i) mean += points[i].y();
  mean /= static_cast<double>(points.size() - first);
  const double outwards = mean < middle_y ? -1.0 : 1.0;
  std::size_t best = first;
  for (std::size_t i = first; i < points.size(); ++i) {
    if (outwards * points[i].y() > outwards * points[best].y()) best = i;
  }
  return points[best];
}

}  // namespace

double Ebs221Field::radius(double max_steering_deg) const {
  return planning_wheelbase_m / std::tan(deg_to_rad(max_steering_deg));
}

RowOrder alternating_order(const std::vector<int>& rows, bool first_from_top) {
  RowOrder order;
  bool from_top = first_from_top;
  for (const int row : rows) {
    order.push_back({row - 1, from_top ? 1 : 0});
    from_top = !from_top;
  }
  return order;
}

std::vector<FieldLink> field_links(const Ebs221Field& field, const RowOrder& order) {
  std::vector<FieldLink> links;
  Pose2 at = field.depot();
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool down = order[i].entry == 1;
    const double x = field.row_x(order[i].row);
    const double yaw = down ? -0.5 * kPi : 0.5 * kPi;
    const Pose2 entry{x, down ? field.row_length_m : 0.0, yaw};
    const Pose2 exit{x, down ? 0.0 : field.row_length_m, yaw};
    links.push_back({at, entry, i == 0 ? LegKind::kTransit : LegKind::kTurn});
    links.push_back({entry, exit, LegKind::kRow});
    at = exit;
  }
  links.push_back({at, reversed(field.depot()), LegKind::kTransit});
  return links;
}

FieldPath field_path(const std::vector<FieldLink>& links, double radius, TurnShape shape) {
  FieldPath result;
  for (const FieldLink& link : links) {
    const int leg = static_cast<int>(result.kinds.size());
    result.kinds.push_back(link.kind);
    if (link.kind == LegKind::kRow) {
      result.path.append_straight(link.from, (link.to.position() - link.from.position()).norm(),
                                  leg);
      continue;
    }
    Curve turn = shortest_dubins(link.from, link.to, radius);
    if (shape == TurnShape::kFishtail && link.kind == LegKind::kTurn) {
      const auto switch_back = fishtail(link.from, link.to, radius);
      if (switch_back && switch_back->length() < turn.length()) turn = *switch_back;
    }
    result.path.append(turn, link.from, leg);
  }
  return result;
}

bool seed_fishtails(const FieldLink& link, double radius) {
  return link.kind == LegKind::kTurn && std::abs(link.to.x - link.from.x) < 2.0 * radius;
}

std::vector<Point2> seed_fishtail_points(const FieldLink& link, double radius) {
  const double side = link.from.yaw < 0.0 ? 1.0 : -1.0;
  const int steps = static_cast<int>(std::ceil(0.5 * kPi * radius / kSeedTurnSpacing));
  const double bend = kSeedTurnSpacing / radius;
  const struct {
    double gear;
    double turn;
  } arcs[] = {{1.0, side}, {-1.0, -side}, {-1.0, side}, {1.0, -side}};
  std::vector<Point2> points;
  Pose2 at = link.from;
  for (const auto& arc : arcs) {
    for (int i = 0; i < steps; ++i) {
      at.yaw += arc.turn * bend;
      const double middle = at.yaw - 0.5 * arc.turn * bend;
      at.x += arc.gear * kSeedTurnSpacing * std::cos(middle);
      at.y += arc.gear * kSeedTurnSpacing * std::sin(middle);
      points.push_back(at.position());
    }
  }
  const auto most = static_cast<std::size_t>(std::ceil(2.0 * kPi * radius / kSeedTurnSpacing));
  points.resize(std::min(points.size(), most));
  points.back() = link.to.position();
  return points;
}

SeedRoute seed_route(const std::vector<FieldLink>& links, double radius, double middle_y,
                     TurnShape shape) {
  SeedRoute route;
  for (const FieldLink& link : links) {
    const bool turn = link.kind != LegKind::kRow;
    const std::size_t first = route.points.size();
    if (shape == TurnShape::kFishtail && seed_fishtails(link, radius)) {
      const std::vector<Point2> points = seed_fishtail_points(link, radius);
      route.points.insert(route.points.end(), points.begin(), points.end());
    } else if (turn) {
      add_turn_points(link, radius, route.points);
    } else {
      add_row_points(link, route.points);
    }
    route.link.resize(route.points.size(), route.links());
    route.is_turn.push_back(turn);
    route.guided.push_back(guided_point(route.points, first, turn, middle_y));
  }
  return route;
}

std::vector<LegKind> seed_kinds(const SeedRoute& route) {
  std::vector<LegKind> kinds;
  for (const bool turn : route.is_turn) kinds.push_back(turn ? LegKind::kTurn : LegKind::kRow);
  return kinds;
}

}  // namespace headland
