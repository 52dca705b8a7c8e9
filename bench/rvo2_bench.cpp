// SPDX-License-Identifier: Apache-2.0
// Crowds beside RVO2, the library of ORCA's authors: velocities step by step from the same states,
// and times of the same scenes, turn by turn.
#include <algorithm>
#include <chrono>

#include <RVO.h>
#include <fmt/format.h>

#include "bench/crowd_scenes.hpp"

namespace headland::bench {
namespace {

// Single precision, unless its sources were changed.
using Real = decltype(RVO::Vector2().x());
Real real(double x) { return static_cast<Real>(x); }
RVO::Vector2 to_rvo(const Point2& p) { return {real(p.x()), real(p.y())}; }
Point2 from_rvo(const RVO::Vector2& v) { return {v.x(), v.y()}; }

// A simulator with a scene's agents.
struct Peer {
  explicit Peer(const Scene& scene) : scene_(scene) {
    const CrowdConfig& c = scene.config;
    simulator.setTimeStep(real(scene.step));
    for (const CrowdAgent& agent : scene.agents) {
      simulator.addAgent(to_rvo(agent.position), real(c.neighbor_distance_m),
                         static_cast<std::size_t>(c.max_neighbor_count), real(c.horizon_s),
                         real(c.obstacle_horizon_s), real(agent.radius_m),
                         real(agent.max_speed_mps));
    }
    for (const Polyline& wall : scene.walls) {
      std::vector<RVO::Vector2> ring;
      for (const Point2& p : wall) ring.push_back(to_rvo(p));
      simulator.addObstacle(ring);
    }
    simulator.processObstacles();
  }
  void step() {
    for (std::size_t i = 0; i < scene_.agents.size(); ++i) {
      const RVO::Vector2 way = to_rvo(scene_.agents[i].goal) - simulator.getAgentPosition(i);
      const Real length = RVO::abs(way);
      simulator.setAgentPrefVelocity(i, length > real(1.0) ? way / length : way);
    }
    simulator.doStep();
  }
  RVO::RVOSimulator simulator;

 private:
  const Scene& scene_;
};

struct Differences {
  long count = 0;
  long beyond = 0;  // 1e-4 m/s
  double worst = 0.0;
};

// The peer goes on; at each step a new crowd of ours begins in the peer's state.
Differences compare(const Scene& scene, int steps) {
  Peer peer(scene);
  std::vector<CrowdAgent> agents = scene.agents;
  Differences found;
  for (int k = 0; k < steps; ++k) {
    for (std::size_t i = 0; i < agents.size(); ++i) {
      agents[i].position = from_rvo(peer.simulator.getAgentPosition(i));
      agents[i].velocity = from_rvo(peer.simulator.getAgentVelocity(i));
    }
    Crowd crowd(scene.config, agents, OrcaObstacles(scene.walls));
    crowd.step(scene.step);
    peer.step();
    for (std::size_t i = 0; i < agents.size(); ++i) {
      const Point2 theirs = from_rvo(peer.simulator.getAgentVelocity(i));
      const double difference = (crowd.agents()[i].velocity - theirs).norm();
      ++found.count;
      if (difference > 1e-4) ++found.beyond;
      found.worst = std::max(found.worst, difference);
    }
  }
  return found;
}

template <class Run>
double seconds(Run run) {
  const auto begin = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void report(const char* name, const Scene& scene) {
  const Differences d = compare(scene, scene.steps);
  double ours = 1e300;
  double theirs = 1e300;
  for (int turn = 0; turn < 9; ++turn) {  // the shortest of each
    Crowd crowd(scene.config, scene.agents, OrcaObstacles(scene.walls));
    ours = std::min(ours, seconds([&] {
                      for (int i = 0; i < scene.steps; ++i) crowd.step(scene.step);
                    }));
    Peer peer(scene);
    theirs = std::min(theirs, seconds([&] {
                        for (int i = 0; i < scene.steps; ++i) peer.step();
                      }));
  }
  const double per_agent = 1e6 / (scene.steps * static_cast<double>(scene.agents.size()));
  fmt::print("{:<16} {:>8} {:>8} {:>10.2e} {:>10.3f} {:>10.3f} {:>7.2f}\n", name, d.count, d.beyond,
             d.worst, ours * per_agent, theirs * per_agent, ours / theirs);
}

// Until all are within `arrival` [m] of their goals, and how near two centres come on the way.
template <class Step, class Place>
void report_to_the_end(const char* name, const Scene& scene, double arrival, Step step,
                       Place place) {
  constexpr int kMost = 20000;
  const std::size_t count = scene.agents.size();
  std::vector<Point2> places(count);
  double least = 1e300;
  int steps = 0;
  for (bool arrived = false; !arrived && steps < kMost; ++steps) {
    step();
    arrived = true;
    for (std::size_t i = 0; i < count; ++i) {
      places[i] = place(i);
      if ((places[i] - scene.agents[i].goal).norm() > arrival) arrived = false;
      for (std::size_t j = 0; j < i; ++j) {
        least = std::min(least, (places[i] - places[j]).norm());
      }
    }
  }
  fmt::print("{:<24} {:>6} {:>10.3f} of {:.0f}\n", name, steps, least,
             2.0 * scene.agents.front().radius_m);
}

void report_to_the_end(const char* name, Scene scene, double arrival) {
  for (int seed = 0; seed < 4; ++seed) {
    scene.config.nudge_mps = seed > 0 ? 1e-4 : 0.0;
    Crowd crowd(scene.config, scene.agents, OrcaObstacles(scene.walls),
                static_cast<std::uint64_t>(seed));
    report_to_the_end(
        fmt::format("{}, seed {}", name, seed).c_str(), scene, arrival,
        [&] { crowd.step(scene.step); }, [&](std::size_t i) { return crowd.agents()[i].position; });
  }
  Peer peer(scene);
  report_to_the_end(
      fmt::format("{}, RVO2", name).c_str(), scene, arrival, [&] { peer.step(); },
      [&](std::size_t i) { return from_rvo(peer.simulator.getAgentPosition(i)); });
}

}  // namespace
}  // namespace headland::bench

int main() {
  using namespace headland::bench;
  fmt::print("{:<16} {:>8} {:>8} {:>10} {:>10} {:>10} {:>7}\n", "scene", "speeds", "> 1e-4",
             "worst m/s", "ours us", "RVO2 us", "ratio");
  report("circle of 250", circle());
  report("blocks of 100", blocks());
  report("hectare of 1000", field(1000));
  report("hectare of 200", field(200));
  fmt::print("\n{:<24} {:>6} {:>10}\n", "to the end", "steps", "least m");
  report_to_the_end("circle of 250", circle(), 1.5);
  report_to_the_end("blocks of 100", blocks(), 20.0);
  return 0;
}
