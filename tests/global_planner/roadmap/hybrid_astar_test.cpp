// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/hybrid_astar.hpp"

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "core/geometry/reeds_shepp.hpp"
#include "global_planner/roadmap/internal/drive_rules.hpp"
#include "tests/global_planner/roadmap/yards.hpp"

namespace headland {
namespace {

using test::box;
using test::complaint;
using test::small_tractor;
using test::yard;

Path found(const Region& area, const Vehicle& vehicle, const Pose2& from, const Pose2& to) {
  const Result<Path> path = HybridAstar(area, vehicle).plan(from, to);
  EXPECT_TRUE(path) << (path ? "" : to_string(path.error()));
  if (!path) return {};
  EXPECT_EQ(complaint(*path, from, to, area, vehicle), "");
  return *path;
}

Vehicle forward_only() {
  Vehicle vehicle = small_tractor();
  vehicle.can_reverse = false;
  return vehicle;
}

roadmap::DriveRules default_rules(const Vehicle& vehicle) {
  const HybridAstarOptions options;
  return {vehicle.turning_radius(), vehicle.can_reverse, options.reverse_weight,
          options.cusp_cost_m, options.steering_weight};
}

TEST(HybridAstar, OnOpenGroundCostsNoMoreThanReedsShepp) {
  const Region area = yard(60.0, {});
  const Vehicle vehicle = small_tractor();
  const roadmap::DriveRules rules = default_rules(vehicle);
  RandomStream random(1, "open ground");
  for (int i = 0; i < 12; ++i) {
    const Pose2 from{30.0, 30.0, random.uniform(-kPi, kPi)};
    const double reach = i < 6 ? 5.0 : 20.0;
    const Pose2 to{random.uniform(30.0 - reach, 30.0 + reach),
                   random.uniform(30.0 - reach, 30.0 + reach), random.uniform(-kPi, kPi)};
    const Path path = found(area, vehicle, from, to);
    const Curve shortest = shortest_reeds_shepp(from, to, rules.radius);
    EXPECT_LE(rules.cost(path), rules.cost(shortest) * (1.0 + 1e-9)) << "query " << i;
    EXPECT_GE(path.length(), shortest.length() - 1e-6) << "query " << i;
  }
}

TEST(HybridAstar, AlongAStraightWayDrivesStraight) {
  const Path path = found(yard(60.0, {}), small_tractor(), {10.0, 30.0, 0.0}, {45.0, 30.0, 0.0});
  ASSERT_EQ(path.pieces().size(), 1u);
  EXPECT_NEAR(path.length(), 35.0, 1e-9);
}

TEST(HybridAstar, ParksBetweenTwoObstacles) {
  // Gaps of 1.6 and of 1.4 times the vehicle's length.
  for (const double gap : {4.8, 4.2}) {
    const Region area = yard(40.0, {box(0.0, 0.0, 18.0, 2.2), box(18.0 + gap, 0.0, 40.0, 2.2)});
    const Path path = found(area, small_tractor(), {10.0, 4.0, 0.0}, {19.3, 1.1, 0.0});
    EXPECT_GE(path.segments().size(), 2u) << "there is no room to drive in forwards";
    EXPECT_LT(path.length(), 20.0);
  }
}

TEST(HybridAstar, DrivesThroughANarrowGate) {
  // Wider than the vehicle with its margins by 5 and by 20 cm on either side.
  for (const double width : {1.7, 2.0}) {
    const Region area =
        yard(60.0, {box(0.0, 29.0, 29.0, 31.0), box(29.0 + width, 29.0, 60.0, 31.0)});
    const Path path = found(area, small_tractor(), {10.0, 10.0, 0.0}, {50.0, 50.0, 3.0});
    EXPECT_LT(path.length(), 65.0);
  }
}

TEST(HybridAstar, DrivesOutOfAUShapedWallAndRoundIt) {
  const Region area = yard(60.0, {box(20.0, 20.0, 40.0, 22.0), box(38.0, 20.0, 40.0, 40.0),
                                  box(20.0, 38.0, 40.0, 40.0)});
  for (const Vehicle& vehicle : {small_tractor(), forward_only()}) {
    const Path path = found(area, vehicle, {30.0, 30.0, 0.0}, {50.0, 30.0, 0.0});
    EXPECT_LT(path.length(), 62.0);  // round a wall that reaches 10 m back and as far aside
  }
}

TEST(HybridAstar, AForwardVehicleNeverReverses) {
  // Behind it, looking the same way: one that may reverse would.
  const Region area = yard(60.0, {});
  const Pose2 from{30.0, 30.0, 0.0};
  const Pose2 to{24.0, 30.0, 0.0};
  EXPECT_EQ(found(area, small_tractor(), from, to).pieces().front().gear, Gear::kReverse);
  const Path forward = found(area, forward_only(), from, to);
  ASSERT_EQ(forward.segments().size(), 1u);
  EXPECT_EQ(forward.segments().front().gear, Gear::kForward);
}

TEST(HybridAstar, DearReverseIsAvoided) {
  const Region area = yard(60.0, {});
  HybridAstarOptions options;
  options.reverse_weight = 100.0;
  const Result<Path> path =
      HybridAstar(area, small_tractor(), options).plan({30.0, 30.0, 0.0}, {24.0, 30.0, 0.0});
  ASSERT_TRUE(path);
  EXPECT_EQ(path->segments().size(), 1u);
  EXPECT_EQ(path->segments().front().gear, Gear::kForward);
}

TEST(HybridAstar, GivesTheSamePathEveryTime) {
  const Region area = yard(60.0, {box(0.0, 29.0, 29.0, 31.0), box(33.0, 29.0, 60.0, 31.0)});
  const Path a = found(area, small_tractor(), {10.0, 10.0, 1.0}, {50.0, 40.0, -2.0});
  const Path b = found(area, small_tractor(), {10.0, 10.0, 1.0}, {50.0, 40.0, -2.0});
  ASSERT_EQ(a.pieces().size(), b.pieces().size());
  for (std::size_t i = 0; i < a.pieces().size(); ++i) {
    EXPECT_EQ(a.pieces()[i].length, b.pieces()[i].length);
    EXPECT_EQ(a.pieces()[i].curvature, b.pieces()[i].curvature);
    EXPECT_EQ(a.pieces()[i].start.x, b.pieces()[i].start.x);
  }
}

TEST(HybridAstar, FromAPoseToItselfThereIsNothingToDrive) {
  const Result<Path> path = HybridAstar(yard(20.0, {}), small_tractor())
                                .plan({10.0, 10.0, 1.0}, {10.0, 10.0, 1.0 + 2.0 * kPi});
  ASSERT_TRUE(path);
  EXPECT_TRUE(path->empty());
}

std::string refusal(const Region& area, const Vehicle& vehicle, const Pose2& from, const Pose2& to,
                    const HybridAstarOptions& options = {}) {
  const Result<Path> path = HybridAstar(area, vehicle, options).plan(from, to);
  EXPECT_FALSE(path);
  if (path) return {};
  EXPECT_EQ(path.error().code, ErrorCode::kNoPath);
  return to_string(path.error());
}

TEST(HybridAstar, SaysWhichPoseDoesNotFit) {
  const Region area = yard(20.0, {});
  const Pose2 good{10.0, 10.0, 0.0};
  const Pose2 bad{18.0, 10.0, 0.0};  // its nose is 0.2 m outside
  EXPECT_NE(refusal(area, small_tractor(), bad, good).find("at the start (18.00 m"),
            std::string::npos);
  EXPECT_NE(refusal(area, small_tractor(), good, bad).find("at the goal (18.00 m"),
            std::string::npos);
}

TEST(HybridAstar, SaysThatAWallHasNoGate) {
  const Region area = yard(60.0, {box(0.0, 29.0, 60.0, 31.0)});
  EXPECT_NE(refusal(area, small_tractor(), {10.0, 10.0, 0.0}, {50.0, 50.0, 0.0})
                .find("the search is exhausted after 0 expansions"),
            std::string::npos);
}

TEST(HybridAstar, SaysThatThereIsNoRoomToTurn) {
  // A lane as wide as the vehicle and a little: nothing turns round in it.
  const Region area({box(0.0, 0.0, 30.0, 2.0)});
  EXPECT_NE(refusal(area, small_tractor(), {10.0, 1.0, 0.0}, {20.0, 1.0, kPi}).find("exhausted"),
            std::string::npos);
}

TEST(HybridAstar, SaysSoonThatAGoalCannotBeEntered) {
  // Forwards only, and there is a wall right behind the goal.
  const Region area = yard(100.0, {box(50.0, 40.0, 52.0, 60.0)});
  HybridAstarOptions options;
  options.max_expansions = 10000;  // a hundredth of the yard's cells
  EXPECT_NE(refusal(area, forward_only(), {10.0, 10.0, 0.0}, {53.0, 50.0, 0.0}, options)
                .find("exhausted"),
            std::string::npos);
}

TEST(HybridAstar, KeepsToItsBudget) {
  const Region area = yard(60.0, {box(0.0, 29.0, 29.0, 31.0), box(30.5, 29.0, 60.0, 31.0)});
  HybridAstarOptions options;
  options.max_expansions = 1000;
  EXPECT_NE(refusal(area, small_tractor(), {10.0, 10.0, 0.0}, {50.0, 50.0, 0.0}, options)
                .find("out of its budget after 1000 expansions"),
            std::string::npos);
}

}  // namespace
}  // namespace headland
