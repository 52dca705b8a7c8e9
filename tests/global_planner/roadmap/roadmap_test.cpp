// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/roadmap.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/global_planner/roadmap/fields.hpp"

namespace headland {
namespace {

using namespace test;

constexpr double kSide = 150.0;

Field small_field() {
  HillSpec hills;
  hills.relief_m = 8.0;
  hills.wavelength_m = 100.0;
  hills.cell_m = 1.0;
  return {kSide, strewn_boxes(kSide, 6, 5.0, 25.0),
          Terrain::hills(hills, {-10.0, -10.0}, {kSide + 10.0, kSide + 10.0})};
}

RoadmapOptions few_samples(int samples, EdgeCurve curve = EdgeCurve::kClothoid) {
  RoadmapOptions options;
  options.samples = samples;
  options.curve = curve;
  return options;
}

Roadmap built(const Field& field, const Vehicle& vehicle, const RoadmapOptions& options) {
  auto roadmap = Roadmap::build(field.region, field.ground, vehicle, options);
  EXPECT_TRUE(roadmap) << to_string(roadmap.error());
  return *std::move(roadmap);
}

// All numbers of the roadmap's edges.
std::vector<double> numbers(const Roadmap& roadmap) {
  std::vector<double> all;
  for (const Path& path : roadmap.edge_paths()) {
    for (const PathPiece& p : path.pieces()) {
      all.insert(all.end(),
                 {p.start.x, p.start.y, p.start.yaw, p.curvature, p.sharpness, p.length});
    }
  }
  return all;
}

class RoadmapEdges : public ::testing::TestWithParam<EdgeCurve> {};

TEST_P(RoadmapEdges, AreDrivableInsideTheArea) {
  const Field field = small_field();
  const Vehicle vehicle = robot();
  const Roadmap roadmap = built(field, vehicle, few_samples(60, GetParam()));
  EXPECT_EQ(roadmap.nodes(), 60);
  const std::vector<Path> paths = roadmap.edge_paths();
  EXPECT_EQ(static_cast<int>(paths.size()), roadmap.edges());
  EXPECT_GT(paths.size(), 300U);
  OutlineChecker checker(field.farm, {}, 0.0, vehicle.footprint);
  for (std::size_t i = 0; i < paths.size(); i += 7) {
    ASSERT_EQ(checker.complaint(paths[i], {}), "") << i;
    ASSERT_EQ(drive_complaint(vehicle, field.ground, paths[i], 0.1), "") << i;
    ASSERT_FALSE(check_slopes(vehicle, field.ground, paths[i])) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(OfBothCurves, RoadmapEdges,
                         ::testing::Values(EdgeCurve::kClothoid, EdgeCurve::kDubins));

TEST(Roadmap, IsTheSameAgainAndAnotherByAnotherSeed) {
  const Field field = small_field();
  RoadmapOptions options = few_samples(80);
  const Roadmap first = built(field, robot(), options);
  const Roadmap second = built(field, robot(), options);
  EXPECT_EQ(numbers(first), numbers(second));
  options.seed = 2;
  EXPECT_NE(numbers(first), numbers(built(field, robot(), options)));
}

TEST(Roadmap, SaysSoWhereTheVehicleFitsNowhere) {
  const Field field(2.0, {});
  const auto none = Roadmap::build(field.region, field.ground, robot(), {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kNoPath);
  EXPECT_NE(to_string(none.error()).find("robot"), std::string::npos);
  const auto empty = Roadmap::build(Region(), Ground(), robot(), {});
  EXPECT_EQ(empty.error().code, ErrorCode::kNoPath);
}

TEST(Roadmap, ServesVehiclesForLevelGroundOnLevelGround) {
  Vehicle vehicle = robot();
  vehicle.max_pitch_deg = 0.1;
  vehicle.max_roll_deg = 0.1;
  const Field field(50.0, {});
  EXPECT_EQ(built(field, vehicle, few_samples(20)).nodes(), 20);
  EXPECT_FALSE(
      Roadmap::build(small_field().region, small_field().ground, vehicle, few_samples(20)));
}

TEST(Roadmap, KeepsOffSlopesThatAreTooSteep) {
  // A bank of 30 degrees across the field, with a gentle ramp at its eastern end.
  const auto bank = [](double x, double y) {
    const double steep = x > 110.0 ? 0.1 : std::tan(deg_to_rad(30.0));
    return std::clamp((y - 70.0) * steep, 0.0, 5.0);
  };
  const Field field(kSide, {}, terrain_of(kSide, 1.0, bank));
  const Vehicle vehicle = robot();
  const Roadmap roadmap = built(field, vehicle, few_samples(200));
  for (const Path& path : roadmap.edge_paths()) {
    ASSERT_EQ(drive_complaint(vehicle, field.ground, path, 0.25), "");
  }
  const Pose2 below{20.0, 30.0, 0.5 * kPi};
  const Pose2 above{20.0, 130.0, 0.5 * kPi};
  const auto ways = roadmap.connect({{below, below, "below"}, {above, above, "above"}});
  ASSERT_TRUE(ways);
  ASSERT_FALSE(ways->edge(0, 1).path.empty());
  EXPECT_GT(ways->edge(0, 1).cost.length_m, 180.0) << "by the ramp";
  EXPECT_EQ(drive_complaint(vehicle, field.ground, ways->edge(0, 1).path, 0.25), "");
}

class RoadmapCacheFile : public ::testing::Test {
 protected:
  RoadmapCacheFile() {
    options_.cache = std::filesystem::temp_directory_path() /
                     fmt::format("headland_roadmap_{}", ::getpid()) /
                     ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(options_.cache);
  }
  ~RoadmapCacheFile() override { std::filesystem::remove_all(options_.cache); }

  Roadmap build(int samples) {
    options_.samples = samples;
    return built(field_, vehicle_, options_);
  }
  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(options_.cache)) {
      found.push_back(entry.path());
    }
    return found;
  }

  Field field_ = small_field();
  Vehicle vehicle_ = robot();
  RoadmapOptions options_;
};

TEST_F(RoadmapCacheFile, GivesTheSameRoadmapAgain) {
  const Roadmap first = build(60);
  EXPECT_FALSE(first.from_cache());
  const Roadmap second = build(60);
  EXPECT_TRUE(second.from_cache());
  EXPECT_EQ(numbers(first), numbers(second));
  const auto goals = random_goals(field_, vehicle_, kSide, 4);
  const GoalGraph a = first.connect(goals).value();
  const GoalGraph b = second.connect(goals).value();
  for (int i = 0; i < 16; ++i) {
    EXPECT_EQ(a.edge(i / 4, i % 4).cost.energy_j, b.edge(i / 4, i % 4).cost.energy_j);
  }
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(RoadmapCacheFile, IsKeptForFewerSamplesAndExtendedForMore) {
  RoadmapOptions no_cache;
  const auto fresh = [&](int samples) {
    no_cache.samples = samples;
    return numbers(built(field_, vehicle_, no_cache));
  };
  build(50);
  const Roadmap fewer = build(30);
  EXPECT_TRUE(fewer.from_cache());
  EXPECT_EQ(fewer.nodes(), 30);
  EXPECT_EQ(numbers(fewer), fresh(30));
  const Roadmap more = build(80);
  EXPECT_FALSE(more.from_cache());
  EXPECT_EQ(numbers(more), fresh(80));
  EXPECT_TRUE(build(80).from_cache());
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(RoadmapCacheFile, ThatIsDamagedIsIgnoredAndWrittenAnew) {
  const std::vector<double> whole = numbers(build(40));
  const std::filesystem::path file = files().front();
  const auto size = std::filesystem::file_size(file);
  for (const auto place : {std::uintmax_t{0}, size / 3, size - 3}) {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(place));
    const char byte = static_cast<char>(stream.get() ^ 1);
    stream.seekp(static_cast<std::streamoff>(place));
    stream.put(byte);
    stream.close();
    const Roadmap again = build(40);
    EXPECT_FALSE(again.from_cache()) << place;
    EXPECT_EQ(numbers(again), whole);
    EXPECT_TRUE(build(40).from_cache());
  }
  for (const auto length : {std::uintmax_t{0}, std::uintmax_t{5}, size / 2, size - 1}) {
    std::filesystem::resize_file(file, length);
    EXPECT_EQ(numbers(build(40)), whole) << length;
    EXPECT_EQ(std::filesystem::file_size(file), size);
  }
}

TEST_F(RoadmapCacheFile, IsAnotherForAnotherVehicleSeedCurveMarginAreaOrGround) {
  build(20);
  vehicle_.footprint.width_m += 0.1;
  EXPECT_FALSE(build(20).from_cache());
  options_.seed = 7;
  EXPECT_FALSE(build(20).from_cache());
  options_.curve = EdgeCurve::kDubins;
  EXPECT_FALSE(build(20).from_cache());
  options_.margin_m = 0.2;
  EXPECT_FALSE(build(20).from_cache());
  field_.ground = Ground();
  EXPECT_FALSE(build(20).from_cache());
  field_.region = Region({box(0.0, 0.0, 100.0, 100.0)});
  EXPECT_FALSE(build(20).from_cache());
  EXPECT_EQ(files().size(), 7U);
}

TEST_F(RoadmapCacheFile, ThatCannotBeWrittenIsNone) {
  std::filesystem::create_directories(options_.cache.parent_path());
  std::ofstream(options_.cache) << "a file where the folder should be";
  EXPECT_EQ(build(20).nodes(), 20);
  EXPECT_FALSE(build(20).from_cache());
}

}  // namespace
}  // namespace headland
