// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim/crowd/crowd.hpp"

// Simulated sheep under the recorded dog and shepherd (Jadhav et al. 2024), beside the recorded
// sheep. The model is not to foretell each one but to move as they do.
namespace headland {
namespace {

struct Figures {
  std::vector<double> nearest;  // to each the nearest other [m]
  std::vector<double> speed;    // [m/s]
  std::vector<double> order;    // length of the mean heading
};

void add(std::span<const Agent> agents, Figures& figures) {
  Point2 heading(0.0, 0.0);
  double count = 0.0;
  for (const Agent& agent : agents) {
    if (agent.kind != AgentKind::kSheep) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Agent& other : agents) {
      if (other.kind != AgentKind::kSheep || other.id == agent.id) continue;
      nearest = std::min(nearest, (other.position - agent.position).norm());
    }
    figures.nearest.push_back(nearest);
    figures.speed.push_back(agent.velocity.norm());
    heading += agent.velocity.normalized();
    count += 1.0;
  }
  figures.order.push_back(heading.norm() / count);
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

// Positions over half a second, as velocities from sample to sample are noise.
Agent smoothed(const Track& track, double time) {
  Agent agent = *track.at(time);
  agent.velocity = (track.at(time + 0.25)->position - track.at(time - 0.25)->position) / 0.5;
  return agent;
}

// Sheep begin as recorded at `begin`; after 5 s both are looked at.
void compare(const TrackSet& drive, double begin, Figures& simulated, Figures& recorded) {
  constexpr double kWhile = 5.0;
  std::vector<CrowdAgent> sheep;
  TrackSet others{drive.name, drive.step_s, {}};
  std::vector<Agent> later;
  for (const Track& track : drive.tracks) {
    if (track.kind != AgentKind::kSheep) {
      others.tracks.push_back(track);
      continue;
    }
    const Agent seen = smoothed(track, begin);
    CrowdAgent agent;
    agent.kind = AgentKind::kSheep;
    agent.behaviour = Behaviour::kHerd;
    agent.position = seen.position;
    agent.velocity = seen.velocity;
    agent.radius_m = 0.2;
    sheep.push_back(agent);
    later.push_back(smoothed(track, begin + kWhile));
  }
  Crowd crowd({}, sheep, {}, 1);
  crowd.replay(others, {}, -begin);
  while (crowd.time_s() < kWhile) crowd.step(0.1);
  add(crowd.agents(), simulated);
  add(later, recorded);
}

TEST(HerdTracks, SheepUnderTheRecordedDogMoveAsTheRecordedDo) {
  const char* given = std::getenv("HEADLAND_DATA");
  const std::string root = given ? given : std::string(HEADLAND_SOURCE_DIR) + "/../shared/data";
  const std::string file = root + "/trajectories/sheep_dog/sheep_dog_drives.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file << "; set HEADLAND_DATA";
  const auto drives = read_sheep_dog(file);
  ASSERT_TRUE(drives) << to_string(drives.error());
  Figures simulated;
  Figures recorded;
  for (const TrackSet& drive : *drives) {
    for (double begin = 0.5; begin + 6.0 < drive.end_s(); begin += 1.0) {
      compare(drive, begin, simulated, recorded);
    }
  }
  const auto print = [](const char* who, const Figures& f) {
    std::printf("%s: nearest %.2f (95 %%: %.2f) m, speed %.2f (%.2f) m/s, order %.3f\n", who,
                quantile(f.nearest, 0.5), quantile(f.nearest, 0.95), quantile(f.speed, 0.5),
                quantile(f.speed, 0.95), quantile(f.order, 0.5));
  };
  print("recorded", recorded);
  print("simulated", simulated);
  const auto within = [](double share, const std::vector<double>& a, const std::vector<double>& b,
                         double factor) {
    const double ratio = quantile(a, share) / quantile(b, share);
    return ratio > 1.0 / factor && ratio < factor;
  };
  EXPECT_TRUE(within(0.5, simulated.nearest, recorded.nearest, 1.8));
  EXPECT_TRUE(within(0.95, simulated.nearest, recorded.nearest, 1.2));
  EXPECT_TRUE(within(0.5, simulated.speed, recorded.speed, 1.25));
  EXPECT_TRUE(within(0.95, simulated.speed, recorded.speed, 1.6));
  EXPECT_TRUE(within(0.5, simulated.order, recorded.order, 1.05));
}

}  // namespace
}  // namespace headland
