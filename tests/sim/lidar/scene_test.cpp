// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/scene.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Trunks alone, each where it is meant to be, on bare soil.
OrchardConfig trunks_alone() {
  OrchardConfig config;
  config.leaf_area_density_1pm = 0.0;
  config.branch_area_density_1pm = 0.0;
  config.grass_area_density_1pm = 0.0;
  config.wire_radius_m = 0.0;
  config.post_radius_m = 0.0;
  config.trunk_radius_m = 0.05;
  config.trunk_height_m = 2.0;
  config.missing_ratio = 0.0;
  config.pitch_jitter_m = 0.0;
  config.lateral_jitter_m = 0.0;
  return config;
}

RowLayout two_rows() {
  RowLayout layout;
  layout.rows_count = 2;
  layout.spacing_m = 3.0;
  layout.length_m = 20.0;
  return layout;
}

Ray ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& toward) {
  Ray question;
  question.origin = origin;
  question.direction = (toward - origin).normalized();
  return question;
}

Agent person(const Point2& position) {
  Agent agent;
  agent.position = position;
  return agent;
}

TEST(LidarScene, ARayDownMeetsTheGroundWhereItIs) {
  const LidarScene scene = LidarScene::rows(two_rows(), trunks_alone(), 1);
  const RayHit hit = scene.trace(ray({3.0, 0.0, 1.5}, {5.0, 0.0, 0.0}));
  EXPECT_EQ(hit.surface, Surface::kGround);
  EXPECT_NEAR(hit.range, 2.5, 1e-9);
  EXPECT_NEAR(hit.cosine, 1.5 / 2.5, 1e-9);
  EXPECT_EQ(scene.trace(ray({3.0, 0.0, 1.5}, {5.0, 0.0, 1.6})).surface, Surface::kNone);
}

TEST(LidarScene, TrunksStandOnTheRowsAtTheirPitch) {
  const LidarScene scene = LidarScene::rows(two_rows(), trunks_alone(), 1);
  ASSERT_EQ(scene.plants().size(), 40u);
  for (const Point2& plant : scene.plants()) {
    EXPECT_NEAR(std::abs(plant.y()), 1.5, 1e-9);
    const RayHit hit = scene.trace(ray({plant.x(), 0.0, 1.0}, {plant.x(), plant.y(), 1.0}));
    EXPECT_EQ(hit.surface, Surface::kTrunk);
    EXPECT_NEAR(hit.range, 1.45, 0.011);  // their radii differ by up to a fifth
    EXPECT_NEAR(hit.cosine, 1.0, 1e-9);
    const double between = plant.x() + 0.25;
    EXPECT_EQ(scene.trace(ray({between, 0.0, 1.0}, {between, plant.y(), 1.0})).surface,
              Surface::kNone);
  }
}

TEST(LidarScene, ARayIsAsLongFromEitherEnd) {
  const LidarScene scene = LidarScene::rows(two_rows(), trunks_alone(), 1);
  RandomStream random(3, "rays");
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d a(random.uniform(-5.0, 25.0), random.uniform(-8.0, -2.0), 0.7);
    const Eigen::Vector3d b(random.uniform(-5.0, 25.0), random.uniform(2.0, 8.0), 1.2);
    Ray there = ray(a, b);
    Ray back = ray(b, a);
    there.max_range = back.max_range = (b - a).norm();
    EXPECT_EQ(scene.trace(there).surface, scene.trace(back).surface) << i;
  }
}

TEST(LidarScene, LeavesLetThroughWhatTheirDensitySays) {
  OrchardConfig config = trunks_alone();
  config.trunk_radius_m = 0.0;
  config.leaf_area_density_1pm = 2.0;
  config.canopy_half_width_m = 0.5;
  config.crown_ratio = 0.0;
  RowLayout layout = two_rows();
  layout.length_m = 200.0;
  const LidarScene scene = LidarScene::rows(layout, config, 1);
  RandomStream random(3, "rays");
  int through = 0;
  constexpr int kRays = 20000;
  for (int i = 0; i < kRays; ++i) {
    const double x = random.uniform(2.0, 198.0);
    const double z = random.uniform(1.2, 1.5);
    Ray question = ray({x, 0.0, z}, {x, 3.0, z});
    question.max_range = 3.0;
    question.depth = -std::log(1.0 - random.uniform());
    if (scene.trace(question).surface == Surface::kNone) ++through;
    question.depth = std::numeric_limits<double>::infinity();
    EXPECT_EQ(scene.trace(question).surface, Surface::kNone);
  }
  // Beer and Lambert through 0.75 m on average (the outline varies from half to the full width);
  // clumps let through more than an even volume.
  const double even = std::exp(-0.5 * 2.0 * 0.75);
  EXPECT_GT(through, even * kRays);
  EXPECT_LT(through, 1.1 * even * kRays);
}

TEST(LidarScene, GrassHidesTheGroundFromFlatRaysOnly) {
  OrchardConfig config = trunks_alone();
  config.grass_area_density_1pm = 12.0;
  config.grass_low_m = config.grass_high_m = 0.1;
  const LidarScene scene = LidarScene::rows(two_rows(), config, 1);
  RandomStream random(3, "rays");
  int steep = 0;
  for (int i = 0; i < 1000; ++i) {
    Ray flat = ray({-10.0, 0.0, 1.5}, {random.uniform(10.0, 15.0), 0.0, 0.0});
    flat.depth = -std::log(1.0 - random.uniform());
    const RayHit hit = scene.trace(flat);
    EXPECT_EQ(hit.surface, Surface::kGrass);
    const double z = 1.5 + hit.range * flat.direction.z();
    EXPECT_LE(z, 0.1 + 1e-9);
    Ray down = ray({-10.0, 0.0, 1.5}, {-10.0 + random.uniform(), 0.0, 0.0});
    down.depth = -std::log(1.0 - random.uniform());
    if (scene.trace(down).surface == Surface::kGround) ++steep;
  }
  EXPECT_NEAR(steep, 1000.0 * std::exp(-0.5 * 12.0 * 0.1), 80.0);
}

TEST(LidarScene, AgentsStandWhereTheyAreAndGo) {
  LidarScene scene = LidarScene::rows(two_rows(), trunks_alone(), 1);
  const Ray along = ray({0.0, 0.0, 1.0}, {10.0, 0.0, 1.0});
  EXPECT_EQ(scene.trace(along).surface, Surface::kNone);
  Agent sheep = person({8.0, 0.0});
  sheep.kind = AgentKind::kSheep;
  sheep.radius_m = 0.6;
  const std::vector<Agent> agents{sheep, person({6.0, 0.0})};
  scene.set_agents(agents);
  const RayHit hit = scene.trace(along);
  EXPECT_EQ(hit.surface, Surface::kAgent);
  EXPECT_EQ(hit.agent, 1);
  EXPECT_NEAR(hit.range, 5.75, 1e-9);
  EXPECT_EQ(scene.trace(ray({7.0, 0.0, 0.6}, {8.0, 0.0, 0.6})).agent, 0);
  // Nobody stands higher than a person.
  EXPECT_EQ(scene.trace(ray({0.0, 0.0, 1.75}, {10.0, 0.0, 1.75})).surface, Surface::kNone);
  scene.set_agents({});
  EXPECT_EQ(scene.trace(along).surface, Surface::kNone);
}

TEST(LidarScene, AnAnimalLiesAlongItsWayWithinItsDisc) {
  LidarScene scene = LidarScene::rows(two_rows(), trunks_alone(), 1);
  Agent cow = person({6.0, 0.0});
  cow.kind = AgentKind::kCattle;
  cow.radius_m = 1.0;
  cow.velocity = {0.5, 0.0};
  scene.set_agents({&cow, 1});
  EXPECT_NEAR(scene.trace(ray({0.0, 0.0, 1.025}, {6.0, 0.0, 1.025})).range, 5.0, 1e-9);
  EXPECT_NEAR(scene.trace(ray({6.0, 1.4, 1.025}, {6.0, 0.0, 1.025})).range, 1.4 - 0.375, 1e-9);
}

TEST(LidarScene, MissingPlantsLeaveGaps) {
  RowLayout layout = two_rows();
  layout.length_m = 500.0;
  OrchardConfig config = trunks_alone();
  config.missing_ratio = 0.2;
  const LidarScene scene = LidarScene::rows(layout, config, 1);
  EXPECT_NEAR(static_cast<double>(scene.plants().size()), 800.0, 60.0);
}

TEST(LidarScene, CurvedRowsSwingAlike) {
  RowLayout layout = two_rows();
  OrchardConfig config = trunks_alone();
  config.curvature_amplitude_m = 0.5;
  config.curvature_wavelength_m = 20.0;
  const LidarScene scene = LidarScene::rows(layout, config, 1);
  ASSERT_EQ(scene.plant_lines().size(), 2u);
  const Polyline& right = scene.plant_lines()[0];
  const Polyline& left = scene.plant_lines()[1];
  EXPECT_NEAR(right[5].y(), -1.5 + 0.5, 1e-9);  // a quarter of the wave
  for (std::size_t i = 0; i < right.size(); ++i) EXPECT_NEAR((left[i] - right[i]).y(), 3.0, 1e-9);
}

TEST(LidarScene, TheNextBlockBeginsBehindTheHeadland) {
  RowLayout layout = two_rows();
  layout.next_block_m = 5.0;
  const LidarScene scene = LidarScene::rows(layout, trunks_alone(), 1);
  int inside = 0;
  for (const Point2& plant : scene.plants()) {
    EXPECT_FALSE(plant.x() > 20.0 && plant.x() < 25.0);
    if (plant.x() > 25.0) ++inside;
  }
  EXPECT_EQ(inside, 60);
}

TEST(LidarScene, SlopesTiltTheGroundAndTheVehicle) {
  RowLayout layout = two_rows();
  layout.slope_along_deg = 10.0;
  const LidarScene scene = LidarScene::rows(layout, trunks_alone(), 1);
  const double rise = std::tan(deg_to_rad(10.0));
  EXPECT_NEAR(scene.ground({7.0, 1.0}).height, 7.0 * rise, 1e-5);
  EXPECT_NEAR(scene.ground({7.0, 1.0}).gradient.x(), rise, 1e-5);
  const Eigen::Isometry3d up = scene.pose_on_ground({7.0, 0.0, 0.0});
  const Eigen::Isometry3d across = scene.pose_on_ground({7.0, 0.0, 0.5 * std::numbers::pi});
  EXPECT_NEAR(up.linear()(2, 0), std::sin(deg_to_rad(10.0)), 1e-5);       // nose up
  EXPECT_NEAR(across.linear()(2, 1), -std::sin(deg_to_rad(10.0)), 1e-5);  // left side down
  EXPECT_LT((up.linear() * up.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  // A ray along the vehicle's own plane stays above it, one to a point of the plane meets it.
  const Eigen::Vector3d sensor = up * Eigen::Vector3d(0.0, 0.0, 1.5);
  const RayHit hit = scene.trace(ray(sensor, up * Eigen::Vector3d(6.0, 0.0, 0.0)));
  EXPECT_EQ(hit.surface, Surface::kGround);
  EXPECT_NEAR(hit.range, std::hypot(1.5, 6.0), 1e-4);
  EXPECT_NEAR(hit.cosine, 1.5 / std::hypot(1.5, 6.0), 1e-4);
}

TEST(LidarScene, AFarmGetsALineOfPlantsBesideEachAlley) {
  Farm farm;
  RowParcel& parcel = farm.row_parcels.emplace_back();
  parcel.row_spacing_m = 4.0;
  for (int i = 0; i < 3; ++i) {
    parcel.rows.push_back({"r", {{0.0, 4.0 * i}, {30.0, 4.0 * i}}});
  }
  const LidarScene scene = LidarScene::orchard(farm, Ground(), trunks_alone(), 1);
  ASSERT_EQ(scene.plant_lines().size(), 4u);
  for (const Point2& plant : scene.plants()) {
    EXPECT_NEAR(std::remainder(plant.y() - 2.0, 4.0), 0.0, 1e-9);
  }
}

TEST(LidarScene, AFarmOnHillsHasTheirHeights) {
  Farm farm;
  RowParcel& parcel = farm.row_parcels.emplace_back();
  parcel.row_spacing_m = 4.0;
  parcel.rows.push_back({"r", {{0.0, 0.0}, {60.0, 0.0}}});
  const Ground ground(farm, Terrain::hills({}, {-70.0, -70.0}, {130.0, 70.0}));
  const LidarScene scene = LidarScene::orchard(farm, ground, trunks_alone(), 1);
  for (double x = 0.0; x < 60.0; x += 3.7) {
    EXPECT_NEAR(scene.ground({x, 1.0}).height, *ground.height({x, 1.0}), 0.05);
    const Eigen::Vector3d below(x, 1.0, *ground.height({x, 1.0}));
    EXPECT_NEAR(scene.trace(ray(below + Eigen::Vector3d(0, 0, 3), below)).range, 3.0, 0.05);
  }
}

TEST(LidarScene, TiledPlantsStandWhereTheScanHasPoints) {
  // A scan of two poles on a line that runs north.
  std::vector<Eigen::Vector3f> scan;
  for (int i = 0; i < 200; ++i) {
    const float z = 0.01f + 0.02f * static_cast<float>(i);
    for (const float y : {1.0f, 3.0f}) scan.emplace_back(5.0f, y, z);
    scan.emplace_back(9.0f, 2.0f, z);  // of another row
  }
  scan.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0f, 1.0f);
  const CanopyStrip strip = cut_strip(scan, 0.5 * std::numbers::pi, -5.0, 0.5);
  ASSERT_EQ(strip.size(), 2u * 190u);
  for (const Eigen::Vector3f& p : strip) {
    EXPECT_TRUE(std::abs(p.x()) < 1e-5f || std::abs(p.x() - 2.0f) < 1e-5f);
    EXPECT_NEAR(p.y(), 0.0f, 1e-5f);
  }
  OrchardConfig config = trunks_alone();
  const LidarScene scene = LidarScene::tiled(two_rows(), {&strip, 1}, config, 1);
  Ray through = ray({6.1, 0.0, 1.0}, {6.1, 3.0, 1.0});
  through.depth = 0.5;
  EXPECT_EQ(scene.trace(through).surface, Surface::kCanopy);
  EXPECT_NEAR(scene.trace(through).range, 1.5, 0.2);
  through.origin.x() = 5.0;
  EXPECT_EQ(scene.trace(through).surface, Surface::kNone);
}

TEST(LidarScene, SameSeedSameBytes) {
  const auto bytes = [](std::uint64_t seed) {
    return LidarScene::rows(two_rows(), vineyard(true), seed).fingerprint();
  };
  EXPECT_EQ(bytes(4), bytes(4));
  EXPECT_NE(bytes(4), bytes(5));
}

TEST(LidarScene, QuestionsThatMakeNoSenseMeetNothing) {
  LidarScene scene = LidarScene::rows(two_rows(), vineyard(true), 1);
  EXPECT_EQ(scene.trace(ray({0, 0, kNaN}, {1, 0, 0})).surface, Surface::kNone);
  EXPECT_EQ(scene.trace(ray({0, 0, -1}, {1, 0, -1})).surface, Surface::kNone);    // below ground
  EXPECT_EQ(scene.trace(ray({900, 0, 1}, {901, 0, 1})).surface, Surface::kNone);  // leads away
  EXPECT_EQ(scene.trace(ray({0, 0, 1}, {0, 0, 2})).surface, Surface::kNone);      // straight up
  EXPECT_EQ(scene.trace(ray({0, 0, 1}, {0, 0, 0})).surface, Surface::kGround);    // straight down
  std::vector<Agent> agents{person({kNaN, 0.0}), person({5.0, 0.0}), person({1e300, 0.0})};
  agents[1].radius_m = -1.0;
  scene.set_agents(agents);
  EXPECT_NE(scene.trace(ray({0.0, 0.0, 1.0}, {10.0, 0.0, 1.0})).surface, Surface::kAgent);
}

TEST(LidarScene, NoRowsIsAMeadow) {
  RowLayout layout;
  layout.rows_count = 0;
  const LidarScene scene = LidarScene::rows(layout, vineyard(true), 1);
  EXPECT_TRUE(scene.plants().empty());
  EXPECT_EQ(scene.trace(ray({0, 0, 1}, {1, 0, 0})).surface, Surface::kGround);
  EXPECT_EQ(LidarScene::orchard({}, Ground(), vineyard(true), 1).plant_lines().size(), 0u);
}

TEST(OrchardConfig, ContradictionsAreNamed) {
  OrchardConfig config;
  EXPECT_FALSE(config.check());
  config.canopy_low_m = 3.0;
  ASSERT_TRUE(config.check());
  EXPECT_EQ(config.check()->where.key, "canopy_low_m");
}

}  // namespace
}  // namespace headland
