// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/internal/agent_bodies.hpp"

#include <algorithm>
#include <cmath>

namespace headland::internal {
namespace {

constexpr double kPersonHeight = 1.7;
constexpr double kPersonRadius = 0.25;

// Back and belly of an animal or a hood over its legs, by the radius of the disc that holds it.
struct Build {
  double height = 1.0;       // of the back [m]
  double thickness = 0.4;    // of the trunk [m]
  double leg_radius = 0.04;  // [m]; 0: no legs
};

Build build_of(AgentKind kind) {
  switch (kind) {
    case AgentKind::kSheep:
      return {0.8, 0.45, 0.04};
    case AgentKind::kCattle:
      return {1.4, 0.75, 0.07};
    case AgentKind::kDog:
      return {0.55, 0.25, 0.03};
    default:
      return {1.4, 1.2, 0.0};
  }
}

Eigen::Vector3d raised(const Point2& p, double z) { return {p.x(), p.y(), z}; }

}  // namespace

double height_of(const Agent& agent) {
  return agent.kind == AgentKind::kPerson ? kPersonHeight : build_of(agent.kind).height;
}

std::vector<Body> bodies_of(const Agent& agent, int index) {
  if (!agent.position.allFinite() || !agent.velocity.allFinite() || !(agent.radius_m > 0.0) ||
      !std::isfinite(agent.radius_m)) {
    return {};
  }
  const Point2& p = agent.position;
  if (agent.kind == AgentKind::kPerson) {
    const double radius = std::min(kPersonRadius, agent.radius_m);
    return {{raised(p, radius), raised(p, kPersonHeight - radius), radius, Surface::kAgent, index}};
  }
  const Build build = build_of(agent.kind);
  const double radius = std::min(0.5 * build.thickness, agent.radius_m);
  const double speed = agent.velocity.norm();
  const Point2 ahead = speed > 0.05 ? Point2(agent.velocity / speed)
                                    : Point2(std::cos(agent.id), std::sin(agent.id));
  const Point2 half = (agent.radius_m - radius) * ahead;
  const double z = build.height - radius;
  std::vector<Body> bodies{
      {raised(p - half, z), raised(p + half, z), radius, Surface::kAgent, index}};
  if (build.leg_radius <= 0.0) return bodies;
  const Point2 left = 0.6 * radius * Point2(-ahead.y(), ahead.x());
  for (const double along : {-1.0, 1.0}) {
    for (const double across : {-1.0, 1.0}) {
      const Point2 foot = p + along * half + across * left;
      bodies.push_back(
          {raised(foot, 0.0), raised(foot, z), build.leg_radius, Surface::kAgent, index});
    }
  }
  return bodies;
}

}  // namespace headland::internal
