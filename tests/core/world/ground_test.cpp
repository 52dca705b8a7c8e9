// SPDX-License-Identifier: Apache-2.0
#include "core/world/ground.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

constexpr double kGravity = 9.80665;

Polygon box(double x, double y, double width, double height) {
  return {{{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}}, {}};
}

// 200 x 200 m around the origin, z = a x + b y.
Ground plane(double a, double b, const Farm& farm = {}) {
  std::vector<double> heights;
  for (int row = 0; row <= 100; ++row) {
    for (int column = 0; column <= 100; ++column) {
      heights.push_back(a * (2 * column - 100) + b * (2 * row - 100));
    }
  }
  return {farm, Terrain::from_grid({-100.0, -100.0}, 2.0, 101, 101, heights)};
}

Ground hills(double relief = 20.0) {
  return {Farm{}, Terrain::hills({3, relief, 80.0, 1.0}, {-150.0, -150.0}, {150.0, 150.0})};
}

Vehicle robot() {
  Vehicle v;
  v.name = "robot";
  v.work_speed_mps = 1.0;
  v.turn_speed_mps = 0.5;
  v.transit_speed_mps = 2.0;
  v.gear_change_s = 3.0;
  v.energy.mass_kg = 500.0;
  v.energy.drive_efficiency_ratio = 0.8;
  v.energy.recuperation_efficiency_ratio = 0.5;
  v.energy.base_power_w = 100.0;
  v.energy.implement_power_w = 200.0;
  return v;
}

Path line(const Pose2& from, double length) {
  Path path;
  path.append_straight(from, length, 0);
  return path;
}

// A drive of arcs, straights, clothoids and both gears that stays within 120 m of the origin.
Path wander(std::uint64_t seed) {
  RandomStream random(seed, "wander");
  Path path;
  Pose2 pose{random.uniform(-40.0, 40.0), random.uniform(-40.0, 40.0), random.uniform(0.0, 6.0)};
  for (int i = 0; i < 8; ++i) {
    const double length = random.uniform(0.3, 9.0);
    const Gear gear = random.uniform() < 0.3 ? Gear::kReverse : Gear::kForward;
    const double curvature = random.uniform() < 0.3 ? 0.0 : random.uniform(-0.3, 0.3);
    const double sharpness = random.uniform() < 0.3 ? random.uniform(-0.03, 0.03) : 0.0;
    path.append(PathPiece{pose, curvature, length, gear, 0, sharpness});
    pose = path.end_pose();
  }
  return path;
}

Path driven_back(const Path& path) {
  Path back;
  for (auto piece = path.pieces().rbegin(); piece != path.pieces().rend(); ++piece) {
    const Pose2 end = piece->pose_at(piece->length);
    const Gear gear = piece->gear == Gear::kForward ? Gear::kReverse : Gear::kForward;
    back.append(PathPiece{end, piece->end_curvature(), piece->length, gear, 0, -piece->sharpness});
  }
  return back;
}

double height(const Ground& ground, const Pose2& at) { return ground.at(at.position())->height; }

TEST(Ground, WithoutTerrainItIsFlatAndFirm) {
  const Ground ground;
  EXPECT_TRUE(ground.flat());
  EXPECT_TRUE(ground.uniform());
  EXPECT_EQ(ground.terrain(), nullptr);
  EXPECT_EQ(ground.at({1e6, -1e6})->height, 0.0);
  EXPECT_EQ(ground.sample({3.0, 4.0})->gradient.norm(), 0.0);
  EXPECT_EQ(ground.soil({1.0, 2.0}), SoilClass::kFirm);
}

TEST(Ground, LaterSoilsLieOnEarlierOnesAndAllOnRoads) {
  Farm farm;
  farm.roads.push_back({"road", {{-50.0, 0.0}, {50.0, 0.0}}, 4.0});
  farm.soils.push_back({"wet", SoilClass::kSoft, box(0.0, -10.0, 20.0, 20.0)});
  farm.soils.push_back({"dune", SoilClass::kSand, box(10.0, -10.0, 20.0, 20.0)});
  const Ground ground(farm, std::nullopt);
  EXPECT_TRUE(ground.flat());
  EXPECT_FALSE(ground.uniform());
  EXPECT_EQ(ground.soil({-20.0, 1.9}), SoilClass::kTrack);
  EXPECT_EQ(ground.soil({-20.0, 2.1}), SoilClass::kFirm);
  EXPECT_EQ(ground.soil({5.0, 0.0}), SoilClass::kSoft);
  EXPECT_EQ(ground.soil({15.0, 0.0}), SoilClass::kSand);
  EXPECT_EQ(ground.soil({25.0, 0.0}), SoilClass::kSand);
  EXPECT_EQ(ground.soil({35.0, 0.0}), SoilClass::kTrack);
}

TEST(Ground, ASecondTerrainFillsTheHolesOfTheFirst) {
  const auto flat = [](Point2 corner, double z) {
    return Terrain::from_grid(corner, 10.0, 2, 2, std::vector<double>(4, z));
  };
  const Ground ground(Farm{}, {flat({0.0, 0.0}, 1.0), flat({5.0, 0.0}, 2.0)});
  EXPECT_EQ(ground.at({7.0, 5.0})->height, 1.0);
  EXPECT_EQ(ground.at({12.0, 5.0})->height, 2.0);
  const auto beyond = ground.at({16.0, 5.0});
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().code, ErrorCode::kOffTerrain);
  EXPECT_THAT(beyond.error().what, ::testing::HasSubstr("(16.0, 5.0) m, [0.000144, 0.000045]"));
}

TEST(Ground, FingerprintsTellGroundsApart) {
  Farm farm;
  farm.soils.push_back({"wet", SoilClass::kSoft, box(0.0, 0.0, 20.0, 20.0)});
  const auto wet = Ground(farm, std::nullopt).fingerprint();
  EXPECT_EQ(wet, Ground(farm, std::nullopt).fingerprint());
  EXPECT_NE(wet, Ground().fingerprint());
  EXPECT_NE(plane(0.1, 0.0).fingerprint(), plane(0.0, 0.1).fingerprint());
  farm.soils[0].soil = SoilClass::kSand;
  EXPECT_NE(wet, Ground(farm, std::nullopt).fingerprint());
  farm.soils[0] = {"wet", SoilClass::kSoft, box(0.0, 0.0, 20.0, 21.0)};
  EXPECT_NE(wet, Ground(farm, std::nullopt).fingerprint());
}

TEST(Ground, HillsOfAFarmReachBeyondIt) {
  Farm farm;
  farm.free_parcels.push_back({"yard", box(0.0, 0.0, 100.0, 80.0)});
  farm.hills = HillSpec{};
  const auto ground = load_ground(farm);
  ASSERT_TRUE(ground) << to_string(ground.error());
  EXPECT_FALSE(ground->flat());
  EXPECT_TRUE(ground->at({-59.9, -59.9}));
  EXPECT_TRUE(ground->at({159.9, 139.9}));
  farm.hills->cell_m = 0.001;
  EXPECT_EQ(load_ground(farm).error().code, ErrorCode::kOutOfRange);
  farm.hills.reset();
  EXPECT_TRUE(load_ground(farm)->flat());
  farm.terrain_files = {"/no/such/dem.tif"};
  EXPECT_EQ(load_ground(farm).error().code, ErrorCode::kFileNotFound);
}

TEST(Attitude, PitchIsAlongTheHeadingAndRollLiftsTheLeft) {
  const TerrainSample east_rises{0.0, {0.1, 0.0}};
  EXPECT_NEAR(attitude(east_rises, 0.0).pitch, std::atan(0.1), 1e-15);
  EXPECT_NEAR(attitude(east_rises, 0.0).roll, 0.0, 1e-15);
  EXPECT_NEAR(attitude(east_rises, kPi).pitch, -std::atan(0.1), 1e-15);
  EXPECT_NEAR(attitude(east_rises, -kPi / 2).roll, std::atan(0.1), 1e-15);
  EXPECT_NEAR(attitude(east_rises, kPi / 2).roll, -std::atan(0.1), 1e-15);
}

TEST(PathCost, UniformGroundCostsWhatDriveCostSays) {
  for (const LegKind kind : {LegKind::kRow, LegKind::kTurn, LegKind::kTransit, LegKind::kTask}) {
    for (int seed = 0; seed < 10; ++seed) {
      const Path path = wander(static_cast<std::uint64_t>(seed));
      const int cusps = static_cast<int>(path.segments().size()) - 1;
      const auto cost = path_cost(robot(), Ground(), path, kind);
      const DriveCost expected = drive_cost(robot(), kind, path.length(), cusps);
      ASSERT_TRUE(cost);
      EXPECT_NEAR(cost->length_m, expected.length_m, 1e-9);
      EXPECT_NEAR(cost->duration_s, expected.duration_s, 1e-9);
      EXPECT_NEAR(cost->energy_j, expected.energy_j, 1e-9 * expected.energy_j);
      EXPECT_NEAR(cost->peak_j, expected.peak_j, 1e-9 * expected.peak_j);
    }
  }
  EXPECT_EQ(path_cost(robot(), Ground(), Path(), LegKind::kTurn)->energy_j, 0.0);
}

TEST(PathCost, ALevelTerrainCostsWhatUniformGroundDoes) {
  Vehicle vehicle = robot();
  vehicle.energy.turn_loss_ratio = 0.3;
  const Path path = wander(4);
  const auto level = path_cost(vehicle, plane(0.0, 0.0), path, LegKind::kTurn);
  const auto uniform = path_cost(vehicle, Ground(), path, LegKind::kTurn);
  // The same steps but for clothoids, whose curvature is taken in the middle of each.
  EXPECT_NEAR(level->energy_j, uniform->energy_j, 1e-4 * uniform->energy_j);
  EXPECT_NEAR(level->peak_j, uniform->peak_j, 1e-4 * uniform->peak_j);
}

TEST(PathCost, ClimbingAndDescendingAPlaneAreClosedForm) {
  const Ground ground = plane(0.1, 0.0);
  const double weight = 500.0 * kGravity;
  const auto up = path_cost(robot(), ground, line({-50.0, 3.0, 0.0}, 100.0), LegKind::kTransit);
  const double traction = 0.05 + 0.1;  // over the weight
  const double slip = soil_resistance(SoilClass::kFirm).slip_per_traction * traction;
  EXPECT_NEAR(up->energy_j, traction * weight * 100.0 / (1.0 - slip) / 0.8 + 100.0 * 50.0, 1e-3);
  EXPECT_NEAR(up->peak_j, up->energy_j, 1e-9);
  const auto down = path_cost(robot(), ground, line({50.0, 3.0, kPi}, 100.0), LegKind::kTransit);
  EXPECT_NEAR(down->energy_j, (0.05 - 0.1) * weight * 100.0 * 0.5 + 100.0 * 50.0, 1e-3);
  EXPECT_LT(down->energy_j, 0.0);
  EXPECT_EQ(down->peak_j, 0.0);
  const auto along = path_cost(robot(), ground, line({3.0, -50.0, kPi / 2}, 100.0), LegKind::kRow);
  EXPECT_NEAR(along->energy_j, drive_cost(robot(), LegKind::kRow, 100.0).energy_j, 1e-3);
}

TEST(PathCost, ALosslessVehiclePaysForHeightAlone) {
  Vehicle ideal = robot();
  ideal.energy.drive_efficiency_ratio = 1.0;
  ideal.energy.recuperation_efficiency_ratio = 1.0;
  ideal.energy.rolling_factor_ratio = 0.0;
  ideal.energy.base_power_w = 0.0;
  const Ground ground = hills(2.0);
  for (int seed = 0; seed < 20; ++seed) {
    const Path path = wander(static_cast<std::uint64_t>(seed));
    const double rise = height(ground, path.end_pose()) - height(ground, path.start_pose());
    const double there = path_cost(ideal, ground, path, LegKind::kTransit)->energy_j;
    const double back = path_cost(ideal, ground, driven_back(path), LegKind::kTransit)->energy_j;
    EXPECT_GE(there, 500.0 * kGravity * rise - 1e-6);
    EXPECT_GE(back, -500.0 * kGravity * rise - 1e-6);
    // Only slip is left: it grows with the square of the slope, and slopes stay below 0.2.
    const double climbed = 500.0 * kGravity * 0.2 * path.length();
    EXPECT_NEAR(there, 500.0 * kGravity * rise, 0.05 * climbed);
    EXPECT_NEAR(back, -500.0 * kGravity * rise, 0.05 * climbed);
  }
}

TEST(PathCost, DriveEnergyPlusRecoverablePotentialIsNeverNegative) {
  const Ground ground = hills();
  const Vehicle vehicle = robot();
  const double recoverable = vehicle.energy.recuperation_efficiency_ratio * 500.0 * kGravity;
  for (int seed = 0; seed < 200; ++seed) {
    const Path path = wander(static_cast<std::uint64_t>(seed));
    const double rise = height(ground, path.end_pose()) - height(ground, path.start_pose());
    const auto cost = path_cost(vehicle, ground, path, LegKind::kTransit);
    ASSERT_TRUE(cost) << to_string(cost.error());
    EXPECT_GE(cost->energy_j, recoverable * rise);
    EXPECT_GE(cost->peak_j, std::max(0.0, cost->energy_j));
  }
}

TEST(PathCost, ThePeakOfAHumpIsOnItsTop) {
  const Path up = line({-50.0, 0.0, 0.0}, 60.0);
  Path round = up;
  round.append(driven_back(up));
  Vehicle vehicle = robot();
  vehicle.energy.base_power_w = 0.0;
  const Ground ground = plane(0.15, 0.0);
  const auto there = path_cost(vehicle, ground, up, LegKind::kTransit);
  const auto both = path_cost(vehicle, ground, round, LegKind::kTransit);
  EXPECT_NEAR(both->peak_j, there->energy_j, 1e-6);
  EXPECT_LT(both->energy_j, there->energy_j);
  EXPECT_NEAR(both->duration_s, 2 * there->duration_s + vehicle.gear_change_s, 1e-9);
}

TEST(PathCost, PiecesAddUpToTheWhole) {
  const Ground ground = hills();
  const Path path = wander(11);
  DriveCost sum;
  for (const PathPiece& piece : path.pieces()) {
    Path single;
    single.append(piece);
    sum += *path_cost(robot(), ground, single, LegKind::kTurn);
  }
  const double standing = 3.0 * (static_cast<double>(path.segments().size()) - 1.0);
  const auto whole = path_cost(robot(), ground, path, LegKind::kTurn);
  EXPECT_NEAR(whole->energy_j, sum.energy_j + 100.0 * standing, 1e-6);
  EXPECT_NEAR(whole->duration_s, sum.duration_s + standing, 1e-9);
}

TEST(PathCost, SoilsCostBySharesOfTheWay) {
  Farm farm;
  farm.soils.push_back({"dune", SoilClass::kSand, box(-20.0, -10.0, 40.0, 20.0)});
  const Ground ground(farm, std::nullopt);
  const auto cost = path_cost(robot(), ground, line({-60.0, 0.0, 0.0}, 100.0), LegKind::kTransit);
  const double sand = drive_cost(robot(), LegKind::kTransit, 40.0, 0, SoilClass::kSand).energy_j;
  const double firm = drive_cost(robot(), LegKind::kTransit, 60.0).energy_j;
  EXPECT_NEAR(cost->energy_j, sand + firm, 0.03 * sand);  // to one step of 1 m
}

TEST(PathCost, TurnLossGoesWithCurvatureAndSpeed) {
  Vehicle vehicle = robot();
  Path circle;
  circle.append(PathPiece{{0.0, 0.0, 0.0}, 0.25, 20.0, Gear::kForward, 0});
  const double without = path_cost(vehicle, Ground(), circle, LegKind::kTurn)->energy_j;
  vehicle.energy.turn_loss_ratio = 0.4;
  const double with = path_cost(vehicle, Ground(), circle, LegKind::kTurn)->energy_j;
  const double work = 0.4 * 500.0 * 0.5 * 0.5 * 0.25 * 20.0;
  EXPECT_NEAR(with - without, work / 0.8, 0.05 * work);
  EXPECT_GT(with - without, work / 0.8);  // slip takes its share too
}

TEST(PathCost, LeavingTheTerrainNamesThePlace) {
  const auto cost =
      path_cost(robot(), plane(0.1, 0.0), line({80.0, 0.0, 0.0}, 50.0), LegKind::kTransit);
  ASSERT_FALSE(cost);
  EXPECT_EQ(cost.error().code, ErrorCode::kOffTerrain);
  EXPECT_THAT(cost.error().what, ::testing::HasSubstr("(101.0, 0.0) m"));
  const auto begin =
      path_cost(robot(), plane(0.1, 0.0), line({180.0, 0.0, kPi}, 150.0), LegKind::kTransit);
  ASSERT_FALSE(begin);
  EXPECT_THAT(begin.error().what, ::testing::HasSubstr("(180.0, 0.0) m"));
}

TEST(CheckSlopes, NamesThePlaceAndWhatTheVehicleMay) {
  const Vehicle vehicle = robot();  // 20 deg along, 15 deg across
  const Ground steep = plane(std::tan(deg_to_rad(17.0)), 0.0);
  EXPECT_FALSE(check_slopes(vehicle, steep, line({-50.0, 0.0, 0.0}, 60.0)));
  EXPECT_FALSE(check_slopes(vehicle, steep, line({50.0, 0.0, kPi}, 60.0)));
  const auto across = check_slopes(vehicle, steep, line({5.0, -30.0, kPi / 2}, 60.0));
  ASSERT_TRUE(across);
  EXPECT_EQ(to_string(*across),
            "17.0 deg across the path at (5.0, -30.0) m; vehicle 'robot' may drive 15 deg [E205]");
  const auto along =
      check_slopes(vehicle, plane(std::tan(deg_to_rad(21.0)), 0.0), line({50.0, 0.0, kPi}, 60.0));
  ASSERT_TRUE(along);
  EXPECT_THAT(along->what, ::testing::HasSubstr("21.0 deg along the path at (50.0, 0.0)"));
  const auto off = check_slopes(vehicle, plane(0.0, 0.0), line({50.0, 0.0, 0.0}, 60.0));
  ASSERT_TRUE(off);
  EXPECT_EQ(off->code, ErrorCode::kOffTerrain);
  EXPECT_FALSE(check_slopes(vehicle, Ground(), line({50.0, 0.0, 0.0}, 60.0)));
}

}  // namespace
}  // namespace headland
