// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/transitions.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/coverage_fields.hpp"
#include "tests/support/outline_checker.hpp"

namespace headland {
namespace {

using test::all_rows;
using test::FieldShape;
using test::make_field;
using test::OutlineChecker;
using test::tracked_robot;
using test::tractor;

// Its steering needs no clothoids.
Vehicle small_car(double radius) {
  Vehicle v;
  v.name = "car";
  v.steering_rate_radps = 100.0;
  v.min_turning_radius_m = radius;
  v.max_steering_deg = 80.0;
  v.footprint = {1.0, 0.5, 1.0};
  return v;
}

TransitionOptions shortest() {
  TransitionOptions options;
  options.objective = Objective::kLength;
  return options;
}

Transitions built(const Farm& farm, const std::vector<Site>& stops, const Vehicle& vehicle,
                  const TransitionOptions& options = {}) {
  Result<Transitions> result =
      Transitions::build(farm, Ground(), farm.all_rows(), stops, vehicle, options);
  if (!result) throw std::runtime_error(to_string(result.error()));
  return std::move(*result);
}

// Every way that exists: joined exactly to its sites, as long and as often reversing as its cost
// says, never tighter than the radius, and inside.
void expect_sound_paths(const Transitions& ways, const Farm& farm, const Vehicle& vehicle,
                        int stride = 1) {
  const std::vector<Row> rows = all_rows(farm);
  OutlineChecker checker(farm, rows, farm.row_parcels[0].row_spacing_m, vehicle.footprint);
  const int ends = 2 * static_cast<int>(rows.size());
  int count = 0;
  for (int from = 0; from < ways.sites(); ++from) {
    for (int to = 0; to < ways.sites(); ++to) {
      const DriveCost cost = ways.cost(from, to);
      if (!std::isfinite(cost.length_m) || ++count % stride != 0) continue;
      const Path path = ways.path(from, to);
      const std::string name = ways.site(from).name + " -> " + ways.site(to).name;
      ASSERT_FALSE(path.empty()) << name;
      EXPECT_NEAR(path.length(), cost.length_m, 1e-6) << name;
      // Rows and stops are left and entered forwards.
      const int cusps = static_cast<int>(path.segments().size()) - 1 +
                        (path.segments().front().gear == Gear::kReverse ? 1 : 0) +
                        (path.segments().back().gear == Gear::kReverse ? 1 : 0);
      const DriveCost again = drive_cost(vehicle, ways.kind(from, to), path.length(), cusps);
      // The steering may make a turn slow down; of other ways, two tracks that meet in reverse are
      // counted with a change of gear each.
      EXPECT_LE(again.duration_s, cost.duration_s + 1e-6) << name;
      if (ways.kind(from, to) == LegKind::kTurn) {
        EXPECT_LE(cost.duration_s, again.duration_s + 10.0) << name;
      }
      const Pose2 start = path.start_pose();
      const Pose2 end = path.end_pose();
      const Pose2 depart = ways.site(from).depart;
      const Pose2 arrive = ways.site(to).arrive;
      EXPECT_NEAR((start.position() - depart.position()).norm(), 0.0, 1e-6) << name;
      EXPECT_NEAR((end.position() - arrive.position()).norm(), 0.0, 1e-6) << name;
      EXPECT_NEAR(wrap_angle(start.yaw - depart.yaw), 0.0, 1e-6) << name;
      EXPECT_NEAR(wrap_angle(end.yaw - arrive.yaw), 0.0, 1e-6) << name;
      for (const PathPiece& piece : path.pieces()) {
        EXPECT_LE(std::abs(piece.curvature) * vehicle.turning_radius(), 1.0 + 1e-9) << name;
      }
      std::set<int> own;
      if (from < ends) own.insert(from / 2);
      if (to < ends) own.insert(to / 2);
      EXPECT_EQ(checker.complaint(path, own), "") << name;
    }
  }
  EXPECT_GT(count, 0);
}

void expect_all_row_ends_joined(const Transitions& ways, int rows) {
  for (int from = 0; from < 2 * rows; ++from) {
    for (int to = 0; to < 2 * rows; ++to) {
      if (from / 2 == to / 2) continue;
      EXPECT_TRUE(std::isfinite(ways.cost(from, to).length_m))
          << ways.site(from).name << " -> " << ways.site(to).name;
    }
  }
}

TEST(Transitions, ForwardTurnsHaveTheLengthsOfPiAndOmega) {
  for (const double radius : {1.7320508, 5.1961524}) {
    Vehicle car = small_car(radius);
    car.can_reverse = false;
    const Transitions ways = built(make_field({}), {}, car, shortest());
    for (int d = 1; d < 10; ++d) {
      const double apart = 2.5 * d;
      // reference/control_and_primitives.md, 1.4.
      const double expected =
          apart >= 2.0 * radius
              ? apart + (kPi - 2.0) * radius
              : radius * (3.0 * kPi - 4.0 * std::asin((2.0 * radius + apart) / (4.0 * radius)));
      EXPECT_NEAR(ways.cost(1, 1 + 2 * d).length_m, expected, 1e-6) << radius << " " << d;
      EXPECT_NEAR(ways.cost(2 * d, 0).length_m, expected, 1e-6) << radius << " " << d;
      EXPECT_EQ(ways.kind(1, 1 + 2 * d), LegKind::kTurn);
    }
  }
}

TEST(Transitions, ReversingTurnsHaveTheLengthsOfFishtailAndReedsShepp) {
  const double radius = 5.1961524;
  Vehicle car = small_car(radius);
  car.footprint = {0.3, 0.2, 0.6};  // no nose that must be straight before it enters a row
  TransitionOptions options = shortest();
  const Transitions all = built(make_field({}), {}, car, options);
  options.reeds_shepp = false;
  const Transitions fishtails = built(make_field({}), {}, car, options);
  for (int d = 1; d <= 4; ++d) {  // all nearer than 2 R
    EXPECT_NEAR(all.cost(1, 1 + 2 * d).length_m, kPi * radius, 1e-6);
    EXPECT_NEAR(fishtails.cost(1, 1 + 2 * d).length_m, (kPi + 2.0) * radius - 2.5 * d, 1e-6);
    EXPECT_EQ(all.path(1, 1 + 2 * d).segments().size(), 3U);
    EXPECT_EQ(fishtails.path(1, 1 + 2 * d).segments().size(), 3U);
  }
}

TEST(Transitions, ChangesOfGearAreWorthTheirTime) {
  TransitionOptions options;
  options.objective = Objective::kTime;
  Vehicle car = small_car(3.0);
  car.gear_change_s = 0.1;
  const Transitions quick = built(make_field({}), {}, car, options);
  EXPECT_NEAR(quick.cost(1, 3).length_m, kPi * 3.0, 1e-6);
  car.gear_change_s = 60.0;
  const Transitions slow = built(make_field({}), {}, car, options);
  EXPECT_NEAR(slow.cost(1, 3).length_m, 3.0 * (3.0 * kPi - 4.0 * std::asin((6.0 + 2.5) / 12.0)),
              1e-6);
  EXPECT_NEAR(slow.cost(1, 3).duration_s, slow.cost(1, 3).length_m / car.turn_speed_mps, 1e-9);
}

TEST(Transitions, TheMatrixHoldsTheObjective) {
  const Farm farm = make_field({});
  for (const Objective objective : {Objective::kEnergy, Objective::kTime, Objective::kLength}) {
    TransitionOptions options;
    options.objective = objective;
    const Transitions ways = built(farm, {}, tractor(), options);
    const Eigen::MatrixXd matrix = ways.matrix();
    ASSERT_EQ(matrix.rows(), 20);
    for (int i = 0; i < 20; ++i) {
      for (int j = 0; j < 20; ++j) EXPECT_EQ(matrix(i, j), ways.cost(i, j).value(objective));
    }
  }
}

TEST(Transitions, AVehicleAlikeInFrontAndBehindDrivesTurnsBackAsThere) {
  const Farm farm = make_field({10, 40.0, 2.4, 9.0, 8.0, 2.5});
  const Transitions ways = built(farm, {}, tracked_robot());
  int turns = 0;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      if (i / 2 == j / 2 || ways.kind(i, j) != LegKind::kTurn) continue;
      EXPECT_NEAR(ways.cost(i, j).energy_j, ways.cost(j, i).energy_j, 1e-6);
      ++turns;
    }
  }
  EXPECT_GT(turns, 60);
}

TEST(Transitions, LevelSkewedAndNarrowFieldsGetSoundPaths) {
  for (const FieldShape& shape :
       {FieldShape{8, 40.0, 2.5, 12.0, 8.0, 0.0}, FieldShape{8, 40.0, 2.4, 9.0, 8.0, 2.5},
        FieldShape{8, 40.0, 2.4, 9.0, 8.0, -2.5}, FieldShape{6, 30.0, 3.0, 6.0, 6.0, 0.8}}) {
    for (const Vehicle& vehicle : {tractor(), tracked_robot()}) {
      const Farm farm = make_field(shape);
      const Transitions ways = built(farm, {}, vehicle);
      expect_all_row_ends_joined(ways, shape.rows);
      expect_sound_paths(ways, farm, vehicle);
    }
  }
}

TEST(Transitions, TheSteeringFollowsEveryTurnWhereTheHeadlandHasRoom) {
  const Farm farm = make_field({10, 40.0, 2.5, 20.0, 20.0, 0.0});
  const Vehicle vehicle = tractor();
  const Transitions ways = built(farm, {}, vehicle);
  int turns = 0;
  for (int i = 0; i < ways.sites(); ++i) {
    for (int j = 0; j < ways.sites(); ++j) {
      if (i / 2 == j / 2 || ways.kind(i, j) != LegKind::kTurn) continue;
      const Path path = ways.path(i, j);
      ++turns;
      const PathPiece* before = nullptr;
      for (const PathPiece& piece : path.pieces()) {
        const bool inside = before != nullptr && before->gear == piece.gear;
        const double from = inside ? before->end_curvature() : piece.curvature;
        ASSERT_NEAR(piece.curvature, from, 1e-9) << ways.site(i).name << ways.site(j).name;
        before = &piece;
      }
      EXPECT_NEAR(path.pieces().front().curvature, 0.0, 1e-9);
      EXPECT_NEAR(path.pieces().back().end_curvature(), 0.0, 1e-9);
    }
  }
  EXPECT_GT(turns, 60);
}

TEST(Transitions, ASkewedTurnRunsOutPastTheNeighbour) {
  // Rows 2.4 m apart, each 2.5 m farther out: whoever leaves the lower end passes the next body.
  const FieldShape shape{8, 40.0, 2.4, 12.0, 8.0, 2.5};
  const Transitions ways = built(make_field(shape), {}, tracked_robot());
  const Path path = ways.path(1, 3);  // the upper ends of the first two rows
  EXPECT_EQ(path.pieces().front().curvature, 0.0);
  EXPECT_GE(path.pieces().front().length, 1.0);
}

TEST(Transitions, AHeadlandTooShortForAnOmegaIsTurnedInReversing) {
  const FieldShape shape{4, 40.0, 2.4, 7.0, 8.0, 0.0};
  Vehicle vehicle = tractor();
  const Transitions ways = built(make_field(shape), {}, vehicle);
  EXPECT_EQ(ways.kind(1, 3), LegKind::kTurn);
  EXPECT_GE(ways.path(1, 3).segments().size(), 2U);
}

TEST(Transitions, ATooNarrowHeadlandIsAnErrorThatSaysWhere) {
  const Farm farm = make_field({6, 40.0, 2.5, 3.5, 1.0, 0.0});
  Vehicle vehicle = tractor();
  vehicle.can_reverse = false;
  const Result<Transitions> result =
      Transitions::build(farm, Ground(), farm.all_rows(), {}, vehicle);
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::kTurnDoesNotFit);
  for (const char* part :
       {"row p/p.1, south end", "(1.3, 0.0)", "3.20 m", "3.8 x 1.5 m", "3.5 m"}) {
    EXPECT_NE(result.error().what.find(part), std::string::npos) << result.error().what;
  }
  EXPECT_NE(result.error().remedy.find("allow reversing"), std::string::npos);
}

TEST(Transitions, AVehicleWiderThanTheRowsIsAnError) {
  const Farm farm = make_field({6, 40.0, 1.4, 20.0, 5.0, 0.0});
  const Result<Transitions> result =
      Transitions::build(farm, Ground(), farm.all_rows(), {}, tractor());
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::kTurnDoesNotFit);
  EXPECT_NE(result.error().what.find("row p/p.1 is 1.40 m wide, the vehicle 1.50 m"),
            std::string::npos)
      << result.error().what;
}

TEST(Transitions, OppositeEndsAreJoinedThroughARowWhereNoLaneGoesAround) {
  const Farm farm = make_field({5, 40.0, 2.5, 14.0, 0.0, 0.0});
  const Transitions ways = built(farm, {}, tracked_robot());
  expect_all_row_ends_joined(ways, 5);
  expect_sound_paths(ways, farm, tracked_robot());
  EXPECT_GT(ways.cost(0, 3).length_m, 40.0);
  EXPECT_LT(ways.cost(0, 3).length_m, 70.0);
  EXPECT_EQ(ways.kind(0, 3), LegKind::kTransit);
}

TEST(Transitions, TurnsKeepOffAPondInTheHeadland) {
  Farm farm = make_field({8, 40.0, 2.5, 14.0, 8.0, 0.0});
  farm.keep_outs.push_back({"pond", {{{4.6, 40.6}, {5.4, 40.6}, {5.4, 44.0}, {4.6, 44.0}}, {}}});
  const Transitions ways = built(farm, {}, tracked_robot());
  expect_sound_paths(ways, farm, tracked_robot());
  const Transitions without =
      built(make_field({8, 40.0, 2.5, 14.0, 8.0, 0.0}), {}, tracked_robot());
  EXPECT_GT(ways.cost(1, 9).length_m, without.cost(1, 9).length_m + 0.5);
  EXPECT_NEAR(ways.cost(9, 15).length_m, without.cost(9, 15).length_m, 1e-9);
}

TEST(Transitions, StopsAreLeftAndEnteredInTheirHeading) {
  Farm farm = make_field({6, 40.0, 2.5, 12.0, 8.0, 0.0});
  farm.free_parcels.push_back(
      {"yard", {{{-30.0, -12.0}, {-7.0, -12.0}, {-7.0, 8.0}, {-30.0, 8.0}}, {}}});
  farm.chargers.push_back({"charger", {-20.0, -4.0, 0.3}, ChargeCurve(1e4), 1});
  farm.pois.push_back({"dock", "dock", {-14.0, 2.0, -1.2}});
  const std::vector<Site> stops{{farm.chargers[0].pose, farm.chargers[0].pose, "charger"},
                                {farm.pois[0].pose, farm.pois[0].pose, "dock"}};
  for (const Vehicle& vehicle : {tractor(), tracked_robot()}) {
    const Transitions ways = built(farm, stops, vehicle);
    ASSERT_EQ(ways.sites(), 14);
    for (int i = 0; i < 14; ++i) {
      for (int j = 12; j < 14; ++j) {
        if (i == j) continue;
        EXPECT_TRUE(std::isfinite(ways.cost(i, j).length_m)) << i << " " << j;
        EXPECT_TRUE(std::isfinite(ways.cost(j, i).length_m)) << i << " " << j;
        EXPECT_EQ(ways.kind(i, j), LegKind::kTransit);
      }
    }
    expect_sound_paths(ways, farm, vehicle);
  }
}

TEST(Transitions, StopsWithoutAnyRowAreJoinedToo) {
  Farm farm;
  farm.free_parcels.push_back({"yard", {{{0.0, 0.0}, {60.0, 0.0}, {60.0, 40.0}, {0.0, 40.0}}, {}}});
  farm.keep_outs.push_back({"barn", {{{25.0, 0.0}, {35.0, 0.0}, {35.0, 25.0}, {25.0, 25.0}}, {}}});
  const Pose2 west{10.0, 10.0, 1.0};
  const Pose2 east{50.0, 8.0, 0.0};
  const Result<Transitions> ways = Transitions::build(
      farm, Ground(), {}, {{west, west, "west"}, {east, east, "east"}}, tractor());
  ASSERT_TRUE(ways.has_value());
  OutlineChecker checker(farm, {}, 0.0, tractor().footprint);
  for (const auto& [from, to] : {std::pair(0, 1), std::pair(1, 0)}) {
    EXPECT_GT(ways->cost(from, to).length_m, 55.0);  // around the barn
    EXPECT_LT(ways->cost(from, to).length_m, 120.0);
    EXPECT_EQ(checker.complaint(ways->path(from, to), {}), "");
  }
}

TEST(Transitions, RowsThatBendAreLeftAlongTheirEnds) {
  Farm farm = make_field({6, 40.0, 3.0, 14.0, 14.0, 0.0});
  for (Row& row : farm.row_parcels[0].rows) {
    const double x = row.line[0].x();
    row.line = {{x, 0.0}, {x, 20.0}, {x + 5.0, 40.0}};
  }
  for (const Vehicle& vehicle : {tractor(), tracked_robot()}) {
    const Transitions ways = built(farm, {}, vehicle);
    expect_all_row_ends_joined(ways, 6);
    for (int i = 1; i < 12; i += 2) {
      EXPECT_NEAR(ways.site(i).depart.yaw, std::atan2(20.0, 5.0), 1e-9);
      for (int j = 1; j < 12; j += 2) {
        if (i == j) continue;
        const Path path = ways.path(i, j);
        EXPECT_NEAR((path.end_pose().position() - ways.site(j).arrive.position()).norm(), 0.0,
                    1e-6);
      }
    }
  }
}

TEST(Transitions, AWayIsNeverShorterThanTheStraightLine) {
  const Farm farm = make_field({8, 40.0, 2.5, 12.0, 8.0, 0.0});
  const Transitions ways = built(farm, {}, tractor());
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 16; ++j) {
      const double apart = (ways.site(i).depart.position() - ways.site(j).arrive.position()).norm();
      EXPECT_GE(ways.cost(i, j).length_m, apart - 1e-9);
    }
  }
}

TEST(Transitions, TwoBuildsAreEqualToTheLastBit) {
  const Farm farm = make_field({12, 40.0, 2.4, 10.0, 8.0, 1.5});
  const Transitions a = built(farm, {}, tractor());
  const Transitions b = built(farm, {}, tractor());
  EXPECT_EQ(a.matrix(), b.matrix());
  for (int i = 0; i < a.sites(); ++i) {
    for (int j = 0; j < a.sites(); ++j) {
      const std::vector<PathPiece> pa = a.path(i, j).pieces();
      const std::vector<PathPiece> pb = b.path(i, j).pieces();
      ASSERT_EQ(pa.size(), pb.size());
      for (std::size_t k = 0; k < pa.size(); ++k) {
        EXPECT_EQ(pa[k].length, pb[k].length);
        EXPECT_EQ(pa[k].curvature, pb[k].curvature);
        EXPECT_EQ(pa[k].start.x, pb[k].start.x);
      }
    }
  }
}

TEST(Transitions, RowsLeftOutOfTheTaskAreStillInTheWay) {
  const Farm farm = make_field({9, 40.0, 2.5, 12.0, 8.0, 0.0});
  const std::vector<Row> all = all_rows(farm);
  const Result<Transitions> ways =
      Transitions::build(farm, Ground(), {{0, 0}, {0, 8}}, {}, tracked_robot());
  ASSERT_TRUE(ways.has_value());
  OutlineChecker checker(farm, all, 2.5, tracked_robot().footprint);
  EXPECT_EQ(checker.complaint(ways->path(0, 2), {0, 8}), "");
  EXPECT_EQ(checker.complaint(ways->path(0, 3), {0, 8}), "");
}

}  // namespace
}  // namespace headland
