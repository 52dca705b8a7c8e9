// SPDX-License-Identifier: Apache-2.0
#include "local_planner/fail_safe/sweep.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

// An edge that moves outwards more slowly than this does nobody harm [m/s].
constexpr double kHarmless = 0.04;

// Appends the part of an edge where `slope` * w + `constant` > kHarmless.
void add_edge(Station::Edge edge, double slope, double constant, Station& station) {
  if (slope != 0.0) {
    const double border = (kHarmless - constant) / slope;
    (slope > 0.0 ? edge.low : edge.high) =
        slope > 0.0 ? std::max(edge.low, border) : std::min(edge.high, border);
  } else if (constant <= kHarmless) {
    return;
  }
  if (edge.low <= edge.high) {
    station.edge[static_cast<std::size_t>(station.edges)] = edge;
    ++station.edges;
  }
}

// The outline's points (x, y) move at (speed - rate y, rate x).
void find_edges(const Footprint& outline, double speed, double rate, Station& station) {
  const double half = 0.5 * outline.width_m;
  add_edge({true, 1.0, outline.front_m, -half, half}, -rate, speed, station);
  add_edge({true, -1.0, outline.rear_m, -half, half}, rate, -speed, station);
  add_edge({false, 1.0, half, -outline.rear_m, outline.front_m}, rate, 0.0, station);
  add_edge({false, -1.0, half, -outline.rear_m, outline.front_m}, -rate, 0.0, station);
}

}  // namespace

double Station::way_to_touch(const Point2& p_map, double radius) const {
  const double dx = p_map.x() - pose.x;
  const double dy = p_map.y() - pose.y;
  const double x = cosine * dx + sine * dy;
  const double y = cosine * dy - sine * dx;
  double least = 1e9;
  for (int i = 0; i < edges; ++i) {
    const Edge& e = edge[static_cast<std::size_t>(i)];
    const double u = e.outward * (e.across ? x : y) - e.offset;
    const double w = e.across ? y : x;
    const double aside = std::max({e.low - w, w - e.high, 0.0});
    // From behind the edge's line it must first get level with it.
    const double way = u >= 0.0 ? std::max(0.0, std::sqrt(u * u + aside * aside) - radius)
                                : std::hypot(u, std::max(0.0, aside - radius));
    least = std::min(least, way);
  }
  return least;
}

bool Station::holds(const Point2& p_map, const Footprint& outline) const {
  const double dx = p_map.x() - pose.x;
  const double dy = p_map.y() - pose.y;
  const double x = cosine * dx + sine * dy;
  return x <= outline.front_m && x >= -outline.rear_m &&
         std::abs(cosine * dy - sine * dx) <= 0.5 * outline.width_m;
}

Sweep::Sweep(const Vehicle& vehicle, const VehicleState& state, const Turn& turn, double direction,
             double speed, const Stopping& stopping) {
  const double step = stopping.duration() / (kStations - 1);
  VehicleState now = state;
  double way = 0.0;
  for (int i = 0; i < kStations; ++i) {
    Station& station = stations_[static_cast<std::size_t>(i)];
    station.time = step * i;
    const double driven = stopping.way(station.time) - way;
    way += driven;
    const double dt = i == 0 ? 0.0 : step;
    if (turn.on_the_spot) {
      now.yaw_rate = std::copysign(speed, turn.rate);
      now.pose.yaw += std::copysign(driven, turn.rate);
    } else if (vehicle.steering == Steering::kAckermann) {
      now.steering = step_steering(vehicle, now.steering, turn.steering, dt);
      const double curvature = std::tan(now.steering) / vehicle.wheelbase_m;
      now.yaw_rate = direction * speed * curvature;
      now.pose = advance(now.pose, curvature, direction * driven);
    } else {
      const double rate = turn.curvature * direction * stopping.speed(station.time);
      if (i > 0) now.yaw_rate = step_yaw_rate(vehicle, now.yaw_rate, rate, dt);
      const double curvature = driven > 1e-9 ? now.yaw_rate * dt / (direction * driven) : 0.0;
      now.pose = advance(now.pose, curvature, direction * driven);
    }
    station.pose = now.pose;
    station.cosine = std::cos(now.pose.yaw);
    station.sine = std::sin(now.pose.yaw);
    find_edges(vehicle.footprint, turn.on_the_spot ? 0.0 : direction * speed, now.yaw_rate,
               station);
  }
}

}  // namespace headland
