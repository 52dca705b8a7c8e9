// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/prediction/crowd_windows.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "sim/crowd/crowd.hpp"
#include "sim/lab/prediction/wandering_robot.hpp"

namespace headland {
namespace {

constexpr double kDt = 0.1;         // of the simulation [s]
constexpr double kWarmUp = 4.0;     // before the first window [s]
constexpr double kBetween = 1.2;    // windows of an episode [s]
constexpr double kDuration = 40.0;  // of an episode [s]
constexpr double kCrossingTime = 16.0;
constexpr double kOfInterest = 6.0;       // a window needs an agent this near to the robot [m]
constexpr double kCrossingMargin = 0.11;  // what people keep beside their radius, MCTS-GRNN [m]

// What differs from episode to episode.
struct Episode {
  Crowd crowd;
  WanderingRobot robot;
  double margin = 0.0;  // in the crowd's radii, not in those seen [m]
  double duration = kDuration;
};

Point2 within(RandomStream& random, double half_side) {
  const double x = random.uniform(-half_side, half_side);
  return {x, random.uniform(-half_side, half_side)};
}

struct Draw {
  double area = 10.0;  // per agent [m2]
  double radius = 0.5;
  double robot_radius = 1.5;
  double half_side = 20.0;
};

// Agents with goals in a square; a new goal at each arrival.
Episode wandering(const Draw& draw, RandomStream& random, std::uint64_t seed) {
  const double side = 2.0 * draw.half_side;
  const int count = std::max(2, static_cast<int>(std::lround(side * side / draw.area)));
  std::vector<CrowdAgent> agents(static_cast<std::size_t>(count));
  for (CrowdAgent& agent : agents) {
    agent.position = within(random, draw.half_side);
    agent.goal = within(random, draw.half_side);
    agent.radius_m = draw.radius;
    agent.speed_mps = random.uniform(0.1, 1.5);
  }
  const GoalRule goals = [half = draw.half_side](const CrowdAgent&, RandomStream& stream) {
    return std::optional<Point2>(within(stream, half));
  };
  return {Crowd({}, std::move(agents), {}, seed, goals),
          WanderingRobot(0.7 * draw.half_side, draw.robot_radius, seed)};
}

// (MCTS-GRNN) people on opposite sides of a circle or of a square.
Episode crossing(RandomStream& random, std::uint64_t seed) {
  constexpr double kCircle = 7.5;  // [m]
  constexpr double kSquare = 8.0;  // half its side [m]
  CrowdConfig config;
  config.horizon_s = 5.0;
  std::vector<CrowdAgent> agents(static_cast<std::size_t>(2 + random.index(10)));
  for (CrowdAgent& agent : agents) {
    if (random.uniform() < 0.3) {
      const double angle = random.uniform(-kPi, kPi);
      agent.position = kCircle * Point2(std::cos(angle), std::sin(angle)) + within(random, 0.5);
      agent.goal = -agent.position;
    } else {
      const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
      agent.position = {side * random.uniform(0.0, kSquare), random.uniform(-kSquare, kSquare)};
      agent.goal = {-side * random.uniform(0.0, kSquare), random.uniform(-kSquare, kSquare)};
    }
    agent.radius_m = 0.3 + kCrossingMargin;
    agent.speed_mps = 1.0;
    agent.max_speed_mps = 1.0;
  }
  return {Crowd(config, std::move(agents), {}, seed),
          WanderingRobot(6.0, 0.3 + kCrossingMargin, seed), kCrossingMargin, kCrossingTime};
}

Episode make_episode(CrowdScene scene, RandomStream& random, std::uint64_t seed) {
  switch (scene) {
    case CrowdScene::kDense:
      return wandering({}, random, seed);
    case CrowdScene::kSparse:
      return wandering({50.0, 0.5, 1.5, 30.0}, random, seed);
    case CrowdScene::kCrossing:
      return crossing(random, seed);
    case CrowdScene::kMixed:
      break;
  }
  Draw draw;
  draw.area = random.uniform(8.0, 60.0);
  draw.radius = random.uniform(0.25, 0.6);
  draw.robot_radius = random.uniform(0.3, 2.0);
  draw.half_side = random.uniform(12.0, 25.0);
  return wandering(draw, random, seed);
}

// Everyone at each step of the simulation.
struct Recording {
  std::vector<Point2> robot;
  std::vector<std::vector<Agent>> agents;
};

Recording drive(Episode& episode) {
  Recording recording;
  for (double t = 0.0; t < episode.duration; t += kDt) {
    recording.robot.push_back(episode.robot.position());
    recording.agents.emplace_back(episode.crowd.agents().begin(), episode.crowd.agents().end());
    const CrowdRobot body = episode.robot.body();
    episode.robot.step(kDt, recording.agents.back());
    episode.crowd.step(kDt, {&body, 1});
  }
  return recording;
}

std::vector<std::size_t> nearest_agents(const std::vector<Agent>& agents, const Point2& robot,
                                        const WindowShape& shape) {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < agents.size(); ++i) {
    const double distance = (agents[i].position - robot).norm();
    if (distance < shape.within_m) near.emplace_back(distance, i);
  }
  std::sort(near.begin(), near.end());
  if (near.empty() || near.front().first > kOfInterest) return {};
  std::vector<std::size_t> chosen;
  for (const auto& [distance, i] : near) {
    if (static_cast<int>(chosen.size()) < shape.most_agents) chosen.push_back(i);
  }
  return chosen;
}

void cut_windows(const Recording& recording, const WindowShape& shape, const CrowdWindow& blank,
                 double margin, std::vector<CrowdWindow>& windows) {
  const auto stride = static_cast<std::size_t>(std::lround(shape.step_s / kDt));
  const auto past = static_cast<std::size_t>(shape.past_steps) * stride;
  const auto future = static_cast<std::size_t>(shape.future_steps) * stride;
  const auto between = static_cast<std::size_t>(std::lround(kBetween / kDt));
  for (auto now = std::max(past, static_cast<std::size_t>(std::lround(kWarmUp / kDt)));
       now + future < recording.robot.size(); now += between) {
    const auto chosen = nearest_agents(recording.agents[now], recording.robot[now], shape);
    if (chosen.empty()) continue;
    CrowdWindow window = blank;
    for (std::size_t k = now - past; k <= now + future; k += stride) {
      window.robot.push_back(recording.robot[k]);
    }
    for (const std::size_t i : chosen) {
      window.radius_m.push_back(recording.agents[now][i].radius_m - margin);
      for (std::size_t k = now - past; k <= now + future; k += stride) {
        window.position.push_back(recording.agents[k][i].position);
        window.velocity.push_back(recording.agents[k][i].velocity);
      }
    }
    windows.push_back(std::move(window));
  }
}

}  // namespace

std::vector<CrowdWindow> record_windows(CrowdScene scene, const WindowShape& shape, int episodes,
                                        std::uint64_t seed) {
  const std::string name(config::enum_name(scene));
  std::vector<CrowdWindow> windows;
  for (int e = 0; e < episodes; ++e) {
    const std::string stream = name + "/" + std::to_string(e) + "/" + std::to_string(seed);
    RandomStream random(seed, stream);
    Episode episode = make_episode(scene, random, fnv1a(stream));
    CrowdWindow blank;
    blank.scene = scene;
    blank.robot_radius_m = episode.robot.body().radius_m - episode.margin;
    cut_windows(drive(episode), shape, blank, episode.margin, windows);
  }
  return windows;
}

}  // namespace headland
