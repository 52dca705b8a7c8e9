// SPDX-License-Identifier: Apache-2.0
#include "core/model/herd.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

Point2 unit(const Point2& v) {
  const double length = v.norm();
  return length > 0.0 && std::isfinite(length) ? Point2(v / length) : Point2(0.0, 0.0);
}

// Those of a herd, as one of them feels them.
struct Flock {
  Point2 repulsion{0.0, 0.0};  // sum of unit vectors away from those inside the spacing
  Point2 attraction{0.0, 0.0};
  Point2 heading{0.0, 0.0};  // mean of unit vectors
};

Flock feel(const HerdModel& model, const HerdBody& self, std::span<const HerdBody> neighbors) {
  // Below this an animal stands: it has no heading [m/s].
  constexpr double kStanding = 0.05;
  const auto most = static_cast<std::size_t>(std::max(0, model.neighbor_count));
  Flock flock;
  for (std::size_t i = 0; i < neighbors.size(); ++i) {
    const HerdBody& other = neighbors[i];
    const Point2 offset = other.position - self.position;
    const Point2 towards = unit(offset);
    if (offset.squaredNorm() < model.spacing_m * model.spacing_m) flock.repulsion -= towards;
    if (i >= most) continue;
    flock.attraction += towards;
    if (other.velocity.norm() > kStanding) flock.heading += unit(other.velocity);
  }
  const std::size_t count = std::min(most, neighbors.size());
  if (count > 0) flock.heading /= static_cast<double>(count);
  return flock;
}

}  // namespace

HerdModel cattle_herd() {
  HerdModel model;
  model.flight_m = 5.0;
  model.spacing_m = 3.0;
  model.response_s = 1.0;
  model.walk_mps = 1.0;
  return model;
}

Point2 herd_velocity(const HerdModel& model, const HerdBody& self,
                     std::span<const HerdBody> neighbors, std::span<const HerdThreat> threats,
                     const Point2& noise) {
  Point2 flight(0.0, 0.0);
  double pace = 0.0;
  bool flees = false;
  for (const HerdThreat& threat : threats) {
    const Point2 offset = self.position - threat.body.position;
    if (!(offset.squaredNorm() < threat.flight_m * threat.flight_m)) continue;
    const Point2 away = unit(offset);
    flight += away;
    pace = std::max(pace, threat.body.velocity.dot(away));
    flees = true;
  }
  const Flock flock = feel(model, self, neighbors);
  Point2 sum = model.repulsion_weight * unit(flock.repulsion) + model.noise_weight * noise;
  if (!flees) return model.graze_mps * unit(sum);
  // The articles align with one of the neighbours by chance, and take part of them for attraction:
  // this is what that is on average.
  sum += model.flight_weight * unit(flight) + model.attraction_weight * unit(flock.attraction) +
         model.alignment_weight * flock.heading;
  return std::max(model.walk_mps, std::min(pace, model.run_mps)) * unit(sum);
}

Point2 respond(const HerdModel& model, const Point2& velocity, const Point2& wanted, double dt) {
  return velocity - std::expm1(-dt / model.response_s) * (wanted - velocity);
}

Point2 turned_noise(const HerdModel& model, const Point2& noise, double dt, RandomStream& random) {
  const double angle = std::sqrt(2.0 * dt / model.noise_s) * random.normal();
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return unit({c * noise.x() - s * noise.y(), s * noise.x() + c * noise.y()});
}

}  // namespace headland
