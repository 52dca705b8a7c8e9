// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/internal/lane_graph.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/dubins.hpp"
#include "global_planner/coverage/internal/lanes.hpp"

namespace headland::coverage {
namespace {

constexpr double kRadius = 2.0;
const Footprint kOutline{1.5, 0.5, 1.2};

Farm yard_and_road() {
  Farm farm;
  farm.free_parcels.push_back({"yard", {{{0.0, 0.0}, {40.0, 0.0}, {40.0, 30.0}, {0.0, 30.0}}, {}}});
  farm.roads.push_back({"road", {{30.0, 15.0}, {80.0, 15.0}, {80.0, 60.0}}, 5.0});
  farm.keep_outs.push_back(
      {"barn", {{{15.0, 10.0}, {22.0, 10.0}, {22.0, 20.0}, {15.0, 20.0}}, {}}});
  return farm;
}

struct Net {
  explicit Net(const Farm& farm, bool reverses = false)
      : area(drivable_area(farm)),
        space(area, {}, kOutline, 0.1, 0.1),
        pricer(Vehicle{}, Ground(), Objective::kLength),
        graph(space, lane_poses(farm, area, {}, space, 0.9, kRadius), kRadius, reverses, pricer) {}
  std::vector<Connection> at(const Pose2& out, Travel travel) const {
    return graph.connect({{out, -1, 0.0}, travel}, false);
  }
  std::vector<Polygon> area;
  FreeSpace space;
  WayPricer pricer;
  LaneGraph graph;
};

TEST(LaneGraph, PathsAreAsLongAsTheSearchSaysAndLeadThere) {
  const Net net(yard_and_road());
  const Pose2 start{8.0, 5.0, 0.4};
  const Pose2 goal{80.0, 50.0, 0.5 * kPi};
  const auto from = net.at(start, Travel::kForth);
  const auto to = net.at(reversed(goal), Travel::kBack);
  LaneGraph::Search search(net.graph);
  search.run(from);
  const WayCost way = search.to(to);
  const Path path = search.path_to(start, from, to);
  EXPECT_NEAR(path.length(), way.drive.length_m, 1e-9);
  EXPECT_NEAR(way.cost, way.drive.length_m, 1e-9);
  EXPECT_NEAR((path.end_pose().position() - goal.position()).norm(), 0.0, 1e-6);
  EXPECT_NEAR(wrap_angle(path.end_pose().yaw - goal.yaw), 0.0, 1e-6);
  EXPECT_GE(way.drive.length_m, dubins_length(start, goal, kRadius) - 1e-9);
  EXPECT_LE(way.drive.length_m, 1.15 * (72.0 + 45.0));  // no great detour from along the road
}

TEST(LaneGraph, TheWayLookingBackIsAsLong) {
  const Net net(yard_and_road());
  for (int a = 0; a < net.graph.nodes(); a += 7) {
    LaneGraph::Search there(net.graph);
    there.run({{a, {}, {}}});
    for (int b = 0; b < net.graph.nodes(); b += 11) {
      LaneGraph::Search back(net.graph);
      back.run({{b ^ 1, {}, {}}});
      const double ab = there.to({{b ^ 1, {}, {}}}).cost;
      const double ba = back.to({{a, {}, {}}}).cost;
      if (std::isinf(ab)) {
        EXPECT_TRUE(std::isinf(ba));
      } else {
        EXPECT_NEAR(ab, ba, 1e-9);
      }
    }
  }
}

TEST(LaneGraph, APoseIsLeftLookingBackWhereThereIsRoomToTurnRound) {
  for (const bool reverses : {false, true}) {
    const Net net(yard_and_road(), reverses);
    int in_yard = 0;
    int turned = 0;
    for (int node = 0; node < net.graph.nodes(); ++node) {
      if (net.graph.pose(node).x > 28.0) continue;  // the road is a dead end
      ++in_yard;
      LaneGraph::Search search(net.graph);
      search.run({{node, {}, {}}});
      const std::vector<Connection> looking_back{
          {node, {}, {}}};  // entered from the node's reverse
      const WayCost way = search.to(looking_back);
      if (std::isinf(way.cost)) continue;
      ++turned;
      EXPECT_LE(way.drive.length_m, (reverses ? 1.0 : 7.0 / 3.0) * kPi * kRadius + 100.0);
      const Path path = search.path_to(net.graph.pose(node), {{node, {}, {}}}, looking_back);
      const Pose2 back = reversed(net.graph.pose(node));
      EXPECT_NEAR((path.end_pose().position() - back.position()).norm(), 0.0, 1e-6);
      EXPECT_NEAR(wrap_angle(path.end_pose().yaw - back.yaw), 0.0, 1e-6);
    }
    EXPECT_GT(in_yard, 50);
    EXPECT_GT(turned, 9 * in_yard / 10);  // all but those that look into a wall
  }
}

TEST(LaneGraph, ConnectionsFitAndDoNotLeadPastEachOther) {
  const Net net(yard_and_road());
  const Pose2 start{8.0, 5.0, 0.4};
  const auto found = net.at(start, Travel::kForth);
  ASSERT_GE(found.size(), 2U);
  for (const Connection& a : found) {
    EXPECT_TRUE(net.space.fits(start, a.turn.curve, Travel::kForth, {}));
    const EndError miss = end_error(a.turn.curve, start, net.graph.pose(a.node));
    EXPECT_LT(miss.position, 1e-6);
  }
}

TEST(LaneGraph, WhereNoLaneLeadsThereIsNoWay) {
  Farm farm = yard_and_road();
  farm.roads.clear();
  farm.free_parcels.push_back(
      {"island", {{{70.0, 0.0}, {90.0, 0.0}, {90.0, 20.0}, {70.0, 20.0}}, {}}});
  const Net net(farm);
  LaneGraph::Search search(net.graph);
  search.run(net.at({8.0, 5.0, 0.4}, Travel::kForth));
  EXPECT_TRUE(std::isinf(search.to(net.at({80.0, 10.0, 0.0}, Travel::kBack)).cost));
}

TEST(LanePoses, FitBothWaysAndLineARoadDenselyAtItsCorner) {
  const Farm farm = yard_and_road();
  const std::vector<Polygon> area = drivable_area(farm);
  const FreeSpace space(area, {}, kOutline, 0.1, 0.1);
  int at_corner = 0;
  for (const Pose2& pose : lane_poses(farm, area, {}, space, 0.9, kRadius)) {
    EXPECT_TRUE(space.fits(pose, Travel::kBoth, {}));
    at_corner += (pose.position() - Point2(80.0, 15.0)).norm() < 5.0 ? 1 : 0;
  }
  EXPECT_GE(at_corner, 6);
}

}  // namespace
}  // namespace headland::coverage
