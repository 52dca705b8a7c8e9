// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gtest/gtest.h>

#include "global_planner/roadmap/internal/goal_links.hpp"
#include "global_planner/roadmap/internal/way_search.hpp"
#include "global_planner/roadmap/roadmap.hpp"
#include "tests/global_planner/roadmap/fields.hpp"

namespace headland {
namespace {

using namespace test;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

GoalGraph ways_between(const Field& field, const Vehicle& vehicle, const std::vector<Site>& goals,
                       const RoadmapOptions& options,
                       const CostWeights& objective = Objective::kEnergy) {
  return Roadmap::build(field.region, field.ground, vehicle, options)
      .value()
      .connect(goals, objective)
      .value();
}

// Alternating hills and hollows.
Terrain waves(double side, double height) {
  return terrain_of(side, 1.0, [height](double x, double y) {
    return height * std::sin(x / 15.0) * std::sin(y / 18.0);
  });
}

TEST(GoalGraph, HasDrivableWaysFromGoalToGoalThatCostWhatItSays) {
  const double side = 150.0;
  const Field field(side, strewn_boxes(side, 5, 10.0, 30.0), waves(side, 2.0));
  Vehicle vehicle = robot();
  vehicle.energy.recuperation_efficiency_ratio = 0.6;
  const std::vector<Site> goals = random_goals(field, vehicle, side, 6);
  RoadmapOptions options;
  options.samples = 150;
  const GoalGraph graph = ways_between(field, vehicle, goals, options);
  ASSERT_EQ(graph.goals(), 6);
  OutlineChecker checker(field.farm, {}, 0.0, vehicle.footprint);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const GoalGraph::Edge& edge = graph.edge(i, j);
      if (i == j) {
        EXPECT_TRUE(edge.path.empty());
        EXPECT_EQ(edge.cost.energy_j, 0.0);
        continue;
      }
      ASSERT_FALSE(edge.path.empty()) << i << " to " << j;
      const Pose2 start = edge.path.start_pose();
      const Pose2 end = edge.path.end_pose();
      const Pose2 depart = goals[static_cast<std::size_t>(i)].depart;
      const Pose2 arrive = goals[static_cast<std::size_t>(j)].arrive;
      EXPECT_LT((start.position() - depart.position()).norm(), 1e-8);
      EXPECT_LT((end.position() - arrive.position()).norm(), 1e-8);
      EXPECT_LT(std::abs(wrap_angle(start.yaw - depart.yaw)), 1e-8);
      EXPECT_LT(std::abs(wrap_angle(end.yaw - arrive.yaw)), 1e-8);
      EXPECT_EQ(drive_complaint(vehicle, field.ground, edge.path, 0.2), "");
      EXPECT_EQ(checker.complaint(edge.path, {}), "");
      const DriveCost again =
          path_cost(vehicle, field.ground, edge.path, LegKind::kTransit).value();
      EXPECT_NEAR(edge.cost.length_m, again.length_m, 1e-6);
      EXPECT_NEAR(edge.cost.duration_s, again.duration_s, 1e-6);
      EXPECT_NEAR(edge.cost.energy_j, again.energy_j, 1e-3);
      EXPECT_NEAR(edge.cost.peak_j, again.peak_j, 1e-3);
    }
  }
}

TEST(GoalGraph, OnFlatOpenGroundCostsLittleMoreThanStraightLines) {
  const double side = 500.0;
  const Field field(side, {});
  const Vehicle vehicle = robot();
  std::vector<Site> goals = random_goals(field, vehicle, side, 10);
  RoadmapOptions options;
  options.samples = 250;
  const GoalGraph graph = ways_between(field, vehicle, goals, options);
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      if (i == j) continue;
      const double straight = (goals[static_cast<std::size_t>(i)].depart.position() -
                               goals[static_cast<std::size_t>(j)].arrive.position())
                                  .norm();
      const double bound = drive_cost(vehicle, LegKind::kTransit, straight).energy_j;
      EXPECT_GE(graph.edge(i, j).cost.energy_j, bound * (1.0 - 1e-9));
      // Turning towards the other goal takes up to a full circle on top.
      const double circle =
          drive_cost(vehicle, LegKind::kTransit, 2.0 * kPi * vehicle.turning_radius()).energy_j;
      EXPECT_LE(graph.edge(i, j).cost.energy_j, 1.3 * bound + circle) << i << " to " << j;
    }
  }
}

// A steep hill in the middle of the straight way.
struct OverTheHill : ::testing::Test {
  double side = 200.0;
  Field field{side, {}, terrain_of(side, 1.0, [](double x, double y) {
                const double r2 = (x - 100.0) * (x - 100.0) + (y - 100.0) * (y - 100.0);
                return 8.0 * std::exp(-r2 / (2.0 * 27.0 * 27.0));
              })};
  std::vector<Site> goals = {{{15.0, 100.0, 0.0}, {15.0, 100.0, 0.0}, "west"},
                             {{185.0, 100.0, 0.0}, {185.0, 100.0, 0.0}, "east"}};

  GoalGraph::Edge way(const Vehicle& vehicle, Objective objective) const {
    RoadmapOptions options;
    options.samples = 250;
    return ways_between(field, vehicle, goals, options, objective).edge(0, 1);
  }
  double highest(const Path& path) const {
    double most = 0.0;
    for (const PathSample& s : path.sample(1.0)) {
      most = std::max(most, field.ground.sample(s.pose.position())->height);
    }
    return most;
  }
};

TEST_F(OverTheHill, TheLeastEnergyGoesRoundTheTopAndTheShortestWayOverIt) {
  const Vehicle vehicle = robot();
  const GoalGraph::Edge least = way(vehicle, Objective::kEnergy);
  const GoalGraph::Edge shortest = way(vehicle, Objective::kLength);
  const GoalGraph::Edge fastest = way(vehicle, Objective::kTime);
  EXPECT_NEAR(shortest.cost.length_m, 170.0, 0.5);
  EXPECT_EQ(fastest.cost.duration_s, shortest.cost.duration_s);
  EXPECT_GT(highest(shortest.path), 7.8);
  EXPECT_LT(highest(least.path), 4.0);
  EXPECT_LT(least.cost.energy_j, 0.97 * shortest.cost.energy_j);
  EXPECT_LT(least.cost.length_m, 1.25 * shortest.cost.length_m);
}

TEST_F(OverTheHill, GoesOverTheTopWhereTheWayDownGivesTheEnergyBack) {
  Vehicle vehicle = robot();
  vehicle.energy.recuperation_efficiency_ratio = 1.0;
  vehicle.energy.drive_efficiency_ratio = 1.0;
  EXPECT_LT(way(vehicle, Objective::kEnergy).cost.length_m, 172.0);
}

TEST(GoalGraph, HasNoWayToWhereNoneLeads) {
  // Two fields apart.
  const Region region({box(0.0, 0.0, 60.0, 60.0), box(80.0, 0.0, 140.0, 60.0)});
  const Vehicle vehicle = robot();
  RoadmapOptions options;
  options.samples = 100;
  const auto roadmap = Roadmap::build(region, Ground(), vehicle, options).value();
  const Pose2 west{30.0, 30.0, 0.0};
  const Pose2 south_west{20.0, 20.0, 1.0};
  const Pose2 east{110.0, 30.0, 0.0};
  const Pose2 outside{70.0, 30.0, 0.0};
  const GoalGraph graph = roadmap
                              .connect({{west, west, "west"},
                                        {south_west, south_west, "south-west"},
                                        {east, east, "east"},
                                        {outside, outside, "outside"}})
                              .value();
  EXPECT_FALSE(graph.edge(0, 1).path.empty());
  EXPECT_FALSE(graph.edge(1, 0).path.empty());
  for (const auto& [i, j] : {std::pair(0, 2), {2, 1}, {0, 3}, {3, 0}, {2, 3}}) {
    EXPECT_TRUE(graph.edge(i, j).path.empty());
    EXPECT_EQ(graph.edge(i, j).cost.energy_j, kInfinity);
    EXPECT_EQ(graph.edge(i, j).cost.length_m, kInfinity);
    EXPECT_EQ(graph.edge(i, j).cost.duration_s, kInfinity);
  }
}

TEST(GoalGraph, JoinsGoalsThatShareAPlaceOrLookAwayFromEachOther) {
  const Field field(100.0, {});
  const Vehicle vehicle = robot();
  RoadmapOptions options;
  options.samples = 100;
  const Pose2 here{50.0, 50.0, 0.0};
  const Pose2 behind{47.0, 50.0, kPi};
  const std::vector<Site> goals = {{here, here, "a"}, {here, here, "b"}, {behind, behind, "c"}};
  const GoalGraph graph = ways_between(field, vehicle, goals, options);
  EXPECT_EQ(graph.edge(0, 1).cost.length_m, 0.0);
  EXPECT_TRUE(graph.edge(0, 1).path.empty());
  for (const auto& [i, j] : {std::pair(0, 2), {2, 0}, {1, 2}}) {
    const GoalGraph::Edge& edge = graph.edge(i, j);
    ASSERT_FALSE(edge.path.empty());
    EXPECT_EQ(drive_complaint(vehicle, field.ground, edge.path, 0.2), "");
    EXPECT_LT(edge.cost.length_m, 60.0);
  }
}

// The search with its parts in the open.
struct Parts {
  Field field;
  Vehicle vehicle = robot();
  internal::TrackMaker tracks{field.region, field.ground, vehicle, EdgeCurve::kClothoid};
  internal::RoadGraph graph;
  std::vector<Site> goals;
  internal::GoalLinks links;

  Parts() : field(150.0, strewn_boxes(150.0, 4, 10.0, 30.0), waves(150.0, 3.0)) {
    vehicle.energy.recuperation_efficiency_ratio = 0.7;
    vehicle.energy.base_power_w = 20.0;
    internal::grow(graph, tracks, 120, 1, 0.1);
    goals = random_goals(field, vehicle, 150.0, 5);
    links = internal::link_goals(goals, graph, tracks, 0.1);
    links.direct.clear();  // all by the roadmap
  }
};

TEST(WaySearch, ReducedCostsAreNeverNegativeThoughEnergiesAre) {
  const Parts p;
  const internal::WaySearch search(p.graph, p.tracks, p.vehicle, Objective::kEnergy);
  double least = 0.0;
  for (const internal::RoadEdge& edge : p.graph.edges) {
    const Point2 from = p.graph.pose(edge.from).position();
    const Point2 to = p.graph.pose(edge.to).position();
    EXPECT_GE(search.reduced_cost(edge.forwards, from, to), -1e-6);
    EXPECT_GE(search.reduced_cost(edge.backwards, to, from), -1e-6);
    least = std::min({least, edge.forwards.energy_j, edge.backwards.energy_j});
  }
  EXPECT_LT(least, 0.0) << "the test's hills are too gentle";
}

TEST(WaySearch, FindsNoDearerWaysThanBellmanAndFord) {
  const Parts p;
  for (const Objective objective : {Objective::kEnergy, Objective::kTime, Objective::kLength}) {
    const internal::WaySearch search(p.graph, p.tracks, p.vehicle, objective);
    const GoalGraph found = search.ways(p.goals, p.links);
    for (int goal = 0; goal < 5; ++goal) {
      std::vector<double> cost(static_cast<std::size_t>(p.graph.headings()), kInfinity);
      const auto at = [&cost](internal::Heading h) -> double& {
        return cost[static_cast<std::size_t>(h)];
      };
      for (const internal::GoalLink& link : p.links.departures) {
        if (link.goal != goal) continue;
        at(link.heading) = std::min(at(link.heading), link.cost.value(objective));
      }
      for (bool changed = true; changed;) {
        changed = false;
        const auto relax = [&](internal::Heading from, internal::Heading to, double more) {
          if (!(at(from) + more < at(to) - 1e-9)) return;
          at(to) = at(from) + more;
          changed = true;
        };
        for (const internal::RoadEdge& e : p.graph.edges) {
          using internal::looking_back;
          if (e.open.forwards) relax(e.from, e.to, e.forwards.value(objective));
          if (e.open.backwards) {
            relax(looking_back(e.to), looking_back(e.from), e.backwards.value(objective));
          }
        }
      }
      std::vector<double> best(5, kInfinity);
      for (const internal::GoalLink& link : p.links.arrivals) {
        double& b = best[static_cast<std::size_t>(link.goal)];
        b = std::min(b, at(link.heading) + link.cost.value(objective));
      }
      for (int to = 0; to < 5; ++to) {
        if (to == goal) continue;
        ASSERT_LT(best[static_cast<std::size_t>(to)], kInfinity);
        EXPECT_NEAR(found.edge(goal, to).cost.value(objective), best[static_cast<std::size_t>(to)],
                    1e-6 * std::abs(best[static_cast<std::size_t>(to)]));
      }
    }
  }
}

}  // namespace
}  // namespace headland
