// SPDX-License-Identifier: Apache-2.0
#include "sim/crowd/tracks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace headland {
namespace {

namespace fs = std::filesystem;

std::string data_file(const std::string& name) {
  const char* given = std::getenv("HEADLAND_DATA");
  const fs::path root = given ? given : std::string(HEADLAND_SOURCE_DIR) + "/../shared/data";
  return (root / "trajectories" / name).string();
}

// A file of the running test with this text.
std::string write(const std::string& text) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const fs::path path = fs::temp_directory_path() / (std::string(test->name()) + ".txt");
  std::ofstream(path) << text;
  return path.string();
}

const char* const kObsmat =
    " 106 7 1.0 0 4.0 9 9 9\n"
    "  98 2 5.0 0 6.0 0 0 0\n"
    " 100 7 0.0 0 4.0 9 9 9\n"  // out of order
    "\n"
    " 118 7 2.0 0 6.0 9 9 9\r\n";

TEST(TracksFile, FramesBecomeSecondsThatBeginAtTheFirstSample) {
  const auto set = read_obsmat(write(kObsmat));
  ASSERT_TRUE(set) << to_string(set.error());
  ASSERT_EQ(set->tracks.size(), 2u);
  const Track& walker = set->tracks[0];
  EXPECT_EQ(walker.id, 7);
  ASSERT_EQ(walker.time_s.size(), 3u);
  EXPECT_NEAR(walker.time_s[0], 2.0 / 6.0 * 0.4, 1e-12);
  EXPECT_NEAR(walker.time_s[1], 8.0 / 6.0 * 0.4, 1e-12);
  EXPECT_NEAR(set->end_s(), 20.0 / 6.0 * 0.4, 1e-12);
  EXPECT_DOUBLE_EQ(set->step_s, 0.4);
}

TEST(TracksFile, FourColumnsAreFrameIdAndPlace) {
  const auto set = read_obsmat(write("0.0\t7.0\t1.5\t-2\n10.0\t7.0\t2.5\t-3\n"));
  ASSERT_TRUE(set) << to_string(set.error());
  ASSERT_EQ(set->tracks.size(), 1u);
  EXPECT_EQ(set->tracks[0].id, 7);
  EXPECT_EQ(set->tracks[0].position[1], Point2(2.5, -3.0));
  EXPECT_NEAR(set->end_s(), 0.4, 1e-12);
}

TEST(TracksFile, BetweenSamplesAnAgentMovesStraightAndAtASampleItHasThePastVelocity) {
  const auto set = read_obsmat(write(kObsmat));
  ASSERT_TRUE(set);
  const Track& walker = set->tracks[0];
  const auto between = walker.at(walker.time_s[0] + 0.1);
  ASSERT_TRUE(between);
  EXPECT_LT((between->position - Point2(0.25, 4.0)).norm(), 1e-12);
  EXPECT_LT((between->velocity - Point2(2.5, 0.0)).norm(), 1e-12);
  const auto sample = walker.at(walker.time_s[1]);
  ASSERT_TRUE(sample);
  EXPECT_LT((sample->position - Point2(1.0, 4.0)).norm(), 1e-12);
  EXPECT_LT((sample->velocity - Point2(2.5, 0.0)).norm(), 1e-12);
  const auto later = walker.at(walker.time_s[1] + 0.4);
  ASSERT_TRUE(later);
  EXPECT_LT((later->position - Point2(1.5, 5.0)).norm(), 1e-12);
  EXPECT_LT((later->velocity - Point2(1.25, 2.5)).norm(), 1e-12);
}

TEST(TracksFile, AgentsAreThereFromTheirFirstSampleToTheirLast) {
  const auto set = read_obsmat(write(kObsmat));
  ASSERT_TRUE(set);
  std::vector<Agent> agents;
  set->at(0.0, agents);
  ASSERT_EQ(agents.size(), 1u);
  EXPECT_EQ(agents[0].id, 2);
  EXPECT_EQ(agents[0].velocity, Point2(0.0, 0.0));
  set->at(0.3, agents);
  ASSERT_EQ(agents.size(), 1u);
  EXPECT_EQ(agents[0].id, 7);
  set->at(9.0, agents);
  EXPECT_TRUE(agents.empty());
  EXPECT_FALSE(set->tracks[0].at(std::nan("")));
}

TEST(TracksFile, ErrorsNameTheFileAndTheLine) {
  const std::string file = write(std::string(kObsmat) + "120 7 x 0 0 0 0 0\n");
  EXPECT_EQ(to_string(read_obsmat(file).error()).find(file + ":6: a frame"), 0u)
      << to_string(read_obsmat(file).error());
  EXPECT_EQ(read_obsmat(write("1 2 3\n")).error().where.line, 1);
  EXPECT_EQ(read_obsmat(write("1 2 3 0 4 0 0 0\n1 2 3 0 4 0 0 0\n")).error().code,
            ErrorCode::kSyntax);
  EXPECT_EQ(read_obsmat(write("")).error().code, ErrorCode::kSyntax);
  EXPECT_EQ(read_obsmat("/no/such/file").error().code, ErrorCode::kFileNotFound);
  EXPECT_EQ(read_sheep_dog(write("trial,drive,t_s,agent,role,x_m,y_m\n")).error().code,
            ErrorCode::kSyntax);
  const auto wolf =
      read_sheep_dog(write("trial,drive,t_s,agent,role,x_m,y_m\n1,1,0.0,1,wolf,1,2\n"));
  EXPECT_EQ(wolf.error().where.line, 2);
}

TEST(TracksFile, DrivesAreSetsOfTheirOwn) {
  const auto drives = read_sheep_dog(
      write("trial,drive,t_s,agent,role,x_m,y_m\n1,1,0.0,1,sheep,1,2\n1,1,0.1,1,sheep,1.2,2\n"
            "1,2,5.0,1,sheep,1,2\n1,2,5.0,9,dog,7,8\n1,2,5.1,1,sheep,1,2\n"));
  ASSERT_TRUE(drives) << to_string(drives.error());
  ASSERT_EQ(drives->size(), 2u);
  EXPECT_EQ((*drives)[1].name, "1/2");
  ASSERT_EQ((*drives)[1].tracks.size(), 2u);
  EXPECT_EQ((*drives)[1].tracks[1].kind, AgentKind::kDog);
  EXPECT_DOUBLE_EQ((*drives)[1].tracks[1].time_s[0], 0.0);
  EXPECT_DOUBLE_EQ((*drives)[0].step_s, 0.1);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The files have velocities too, which the reader does not use.
TEST(RecordedTracks, PedestriansWalkAsFastAsTheVelocitiesInTheFilesSay) {
  for (const auto& [scene, tracks] : {std::pair{"eth", 360u}, {"hotel", 390u}, {"zara01", 148u}}) {
    const std::string file = data_file(std::string(scene) + "/obsmat.txt");
    if (!fs::exists(file)) GTEST_SKIP() << "no " << file << "; set HEADLAND_DATA";
    const auto set = read_obsmat(file);
    ASSERT_TRUE(set) << to_string(set.error());
    EXPECT_EQ(set->tracks.size(), tracks);
    std::vector<double> read;
    for (const Track& track : set->tracks) {
      for (const double time : track.time_s) read.push_back(track.at(time)->velocity.norm());
    }
    std::vector<double> written;
    std::ifstream in(file);
    for (double f, id, x, z, y, vx, vz, vy; in >> f >> id >> x >> z >> y >> vx >> vz >> vy;) {
      written.push_back(std::hypot(vx, vy));
    }
    EXPECT_NEAR(median(read), median(written), 0.01 * median(written)) << scene;
  }
}

TEST(RecordedTracks, SheepDogAndShepherdAreReadDriveByDrive) {
  const std::string file = data_file("sheep_dog/sheep_dog_drives.csv");
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file << "; set HEADLAND_DATA";
  const auto drives = read_sheep_dog(file);
  ASSERT_TRUE(drives) << to_string(drives.error());
  ASSERT_EQ(drives->size(), 20u);
  double seconds = 0.0;
  for (const TrackSet& drive : *drives) {
    EXPECT_EQ(drive.tracks.size(), 16u);
    EXPECT_DOUBLE_EQ(drive.step_s, 0.1);
    seconds += drive.end_s();
  }
  EXPECT_NEAR(seconds, 415.9, 0.1);
}

}  // namespace
}  // namespace headland
