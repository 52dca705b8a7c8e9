// SPDX-License-Identifier: Apache-2.0
#include "perception/rows/row_detector.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/row_scene.hpp"

namespace headland {
namespace {

using test::RowScene;

RowScene bare() {
  RowScene scene;
  scene.leaf_1pm = 0.1;
  return scene;
}

struct Drive {
  double worst_offset = 0.0;
  double worst_heading = 0.0;
  int scans = 0;
  int valid = 0;
};

// Through the lane about y = 0 from x = `from` on, wandering by 0.3 m and 4 degrees.
template <class See>
Drive drive(const RowScene& scene, RowDetector& detector, double from, double to, See see) {
  RandomStream random(5, "scene");
  Drive result;
  Pose2 last;
  for (double x = from; x < to; x += 0.3) {
    const Pose2 base{x, 0.3 * std::sin(x / 4.0), 0.075 * std::cos(x / 4.0)};
    const Pose2 moved = x == from ? Pose2{} : test::moved_between(last, base);
    last = base;
    const RowEstimate lane = detector.update(scene.scan(base, random), moved, x);
    ++result.scans;
    if (lane.valid) {
      ++result.valid;
      result.worst_offset = std::max(result.worst_offset, std::abs(lane.offset_m + base.y));
      result.worst_heading = std::max(result.worst_heading, std::abs(lane.heading_rad + base.yaw));
    }
    see(base, lane);
  }
  return result;
}

Drive drive(const RowScene& scene, RowDetector& detector, double from, double to) {
  return drive(scene, detector, from, to, [](const Pose2&, const RowEstimate&) {});
}

TEST(RowDetector, FollowsTheCentreLineOfABareOrchard) {
  RowDetector detector{RowDetectorConfig{}};
  const Drive seen = drive(bare(), detector, 3.0, 15.0);
  EXPECT_GE(seen.valid, seen.scans - 1);
  EXPECT_LT(seen.worst_offset, 0.04);
  EXPECT_LT(seen.worst_heading, deg_to_rad(0.7));
}

TEST(RowDetector, CanopyOnBothSidesDoesNotMoveTheCentreLine) {
  RowDetector detector{RowDetectorConfig{}};
  const Drive seen = drive(RowScene{}, detector, 3.0, 15.0);
  EXPECT_GE(seen.valid, seen.scans - 1);
  EXPECT_LT(seen.worst_offset, 0.05);
  EXPECT_LT(seen.worst_heading, deg_to_rad(0.7));
}

TEST(RowDetector, HalfATurnAndAnotherMountingHeightAreEnough) {
  RowScene scene;
  scene.half_turn_rad = 0.5 * kPi;
  scene.sensor_z_m = 1.8;  // 0.3 m above what the detector was told: base hangs below the ground
  RowDetector detector{RowDetectorConfig{}};
  RandomStream random(5, "scene");
  Pose2 last;
  for (double x = 5.0; x < 10.0; x += 0.5) {
    auto points = scene.scan({x, 0.2, 0.05}, random);
    for (LidarPoint& point : points) point.position.z() -= 0.3f;
    const Pose2 base{x, 0.2, 0.05};
    const Pose2 moved = x == 5.0 ? Pose2{} : test::moved_between(last, base);
    last = base;
    const RowEstimate lane = detector.update(points, moved, x);
    if (x == 5.0) continue;
    ASSERT_TRUE(lane.valid) << x;
    EXPECT_NEAR(lane.offset_m, -0.2, 0.06);
  }
}

TEST(RowDetector, TheEndOfTheRowIsSeenFromEightMetres) {
  RowScene scene;
  scene.end_m = 30.0;
  RowDetector detector{RowDetectorConfig{}};
  double first = 0.0;
  drive(scene, detector, 8.0, 29.0, [&](const Pose2& base, const RowEstimate& lane) {
    const double truth = scene.end_m - base.x;
    if (lane.row_end.seen && first == 0.0) first = truth;
    if (truth < 8.0) {
      ASSERT_TRUE(lane.row_end.seen) << truth;
      EXPECT_NEAR(lane.row_end.distance_m, truth, 0.3) << truth;
      EXPECT_GT(lane.row_end.deviation_m, 0.0);
    }
  });
  EXPECT_GE(first, 8.0);
}

TEST(RowDetector, TheNextBlockBehindTheHeadlandIsNotThisRow) {
  RowScene scene = bare();
  scene.end_m = 25.0;
  scene.next_begin_m = 30.0;
  scene.next_end_m = 60.0;
  RowDetector detector{RowDetectorConfig{}};
  drive(scene, detector, 12.0, 29.0, [&](const Pose2& base, const RowEstimate& lane) {
    const double truth = scene.end_m - base.x;
    if (truth > 0.5 && truth < 8.0) {
      ASSERT_TRUE(lane.row_end.seen) << truth;
      EXPECT_NEAR(lane.row_end.distance_m, truth, 0.3) << truth;
    }
    EXPECT_FALSE(truth < -1.0 && lane.valid) << truth;
  });
}

TEST(RowDetector, MissingPlantsAreNoEnd) {
  // A hole of three metres on the left.
  RowScene scene;
  scene.end_m = 60.0;
  RowDetector detector{RowDetectorConfig{}};
  RandomStream random(5, "scene");
  Pose2 last{5.0, 0.0, 0.0};
  for (double x = 5.0; x < 14.0; x += 0.3) {
    const Pose2 base{x, 0.0, 0.0};
    auto points = scene.scan(base, random);
    std::erase_if(points, [&](const LidarPoint& point) {
      const double along = x + point.position.x();
      return point.position.y() > 1.0f && along > 18.0 && along < 21.0 && point.position.z() > 0.2f;
    });
    const RowEstimate lane = detector.update(points, test::moved_between(last, base), x);
    last = base;
    EXPECT_FALSE(lane.row_end.seen) << x;
  }
}

TEST(RowDetector, NoRowsInTheHeadland) {
  RowScene scene;
  scene.begin_m = 10.0;
  RowDetector detector{RowDetectorConfig{}};
  RandomStream random(5, "scene");
  // Along the rows' ends, and facing them from four metres.
  Pose2 last;
  double time = 0.0;
  for (double y = -6.0; y < 6.0; y += 0.4) {
    for (const double yaw : {0.5 * kPi, 0.0}) {
      const Pose2 base{6.0, y, yaw};
      const Pose2 moved = time == 0.0 ? Pose2{} : test::moved_between(last, base);
      last = base;
      time += 1.0;
      const RowEstimate lane = detector.update(scene.scan(base, random), moved, time);
      EXPECT_FALSE(lane.valid) << y << " " << yaw;
      EXPECT_NE(lane.status, RowStatus::kValid);
    }
  }
}

TEST(RowDetector, OneRowIsEnoughToGoOnButNotToStart) {
  RowScene both;
  RowScene one;
  one.rows_m = {1.9};
  RowDetector detector{RowDetectorConfig{}};
  RandomStream random(5, "scene");
  Pose2 last{10.0, 0.0, 0.0};
  for (double x = 10.0; x < 13.0; x += 0.3) {
    const Pose2 base{x, 0.0, 0.0};
    detector.update(both.scan(base, random), test::moved_between(last, base), x);
    last = base;
  }
  for (double x = 13.0; x < 20.0; x += 0.3) {
    const Pose2 base{x, 0.0, 0.0};
    const RowEstimate lane =
        detector.update(one.scan(base, random), test::moved_between(last, base), x);
    last = base;
    ASSERT_TRUE(lane.valid) << x;
    EXPECT_EQ(lane.sides, RowSides::kLeft);
    EXPECT_NEAR(lane.offset_m, 0.0, 0.1);
  }
  detector.reset();
  const RowEstimate lane = detector.update(one.scan(last, random), Pose2{}, 20.0);
  EXPECT_FALSE(lane.valid);
  EXPECT_EQ(lane.status, RowStatus::kNoLane);
}

TEST(RowDetector, SaysThatOtherRowsAreNotOursByTheirWidth) {
  RowScene scene;
  scene.rows_m = {-1.25, 1.25};
  RowDetector detector{RowDetectorConfig{}};
  const Drive seen = drive(scene, detector, 3.0, 6.0);
  EXPECT_EQ(seen.valid, 0);
}

TEST(RowDetector, FindsTheLaneAgainAfterItLostIt) {
  RowScene scene;
  RowDetector detector{RowDetectorConfig{}};
  drive(scene, detector, 3.0, 6.0);
  for (int i = 0; i < 20; ++i) {
    const RowEstimate lane = detector.update({}, Pose2{0.2, 0.0, 0.0}, 6.0 + 0.2 * i);
    EXPECT_EQ(lane.valid, i < 5) << i;
  }
  const Drive seen = drive(scene, detector, 10.0, 13.0);
  EXPECT_GE(seen.valid, seen.scans - 2);
}

TEST(RowDetector, BadInputIsRefusedWithAReason) {
  RowScene scene;
  RandomStream random(5, "scene");
  const Pose2 base{10.0, 0.0, 0.0};
  const auto good = scene.scan(base, random);
  const auto status_of = [](const std::vector<LidarPoint>& points, double time) {
    RowDetector detector{RowDetectorConfig{}};
    const RowEstimate lane = detector.update(points, Pose2{}, time);
    EXPECT_FALSE(lane.valid);
    return lane.status;
  };
  EXPECT_EQ(status_of({}, 0.0), RowStatus::kNoPoints);
  EXPECT_EQ(status_of(good, std::numeric_limits<double>::quiet_NaN()), RowStatus::kTimeBackwards);
  auto broken = good;
  for (LidarPoint& point : broken) point.position.x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(status_of(broken, 0.0), RowStatus::kNoPoints);
  auto upside_down = good;
  for (LidarPoint& point : upside_down) point.position.z() = 3.0f - point.position.z();
  EXPECT_EQ(status_of(upside_down, 0.0), RowStatus::kNoGround);
  RowScene one_ring = scene;
  one_ring.lasers_count = 1;
  EXPECT_NE(status_of(one_ring.scan(base, random), 0.0), RowStatus::kValid);
}

TEST(RowDetector, SomeBrokenPointsChangeNothingMuch) {
  RowScene scene;
  RandomStream random(5, "scene");
  RowDetector detector{RowDetectorConfig{}};
  RowEstimate lane;
  for (int i = 0; i < 3; ++i) {
    auto points = scene.scan({10.0, 0.1, 0.0}, random);
    for (std::size_t k = 0; k < points.size(); k += 10) {
      points[k].position.y() = std::numeric_limits<float>::infinity();
    }
    lane = detector.update(points, Pose2{}, 0.1 * i);
  }
  ASSERT_TRUE(lane.valid);
  EXPECT_NEAR(lane.offset_m, -0.1, 0.05);
}

TEST(RowDetector, TimeBackwardsAndLostOdometryInventNothing) {
  RowScene scene;
  RandomStream random(5, "scene");
  RowDetector detector{RowDetectorConfig{}};
  const auto points = scene.scan({10.0, 0.0, 0.0}, random);
  detector.update(points, Pose2{}, 1.0);
  EXPECT_TRUE(detector.update(points, Pose2{}, 1.1).valid);
  const RowEstimate back = detector.update(points, Pose2{}, 0.5);
  EXPECT_FALSE(back.valid);
  EXPECT_EQ(back.status, RowStatus::kTimeBackwards);
  EXPECT_TRUE(detector.update(points, Pose2{}, 1.2).valid);
  const Pose2 nowhere{std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0};
  EXPECT_FALSE(detector.update(points, nowhere, 1.3).valid);
}

TEST(RowDetector, SameScansSameBytes) {
  RowDetector a{RowDetectorConfig{}};
  RowDetector b{RowDetectorConfig{}};
  std::vector<double> seen;
  drive(RowScene{}, a, 3.0, 5.0,
        [&](const Pose2&, const RowEstimate& lane) { seen.push_back(lane.offset_m); });
  std::size_t i = 0;
  drive(RowScene{}, b, 3.0, 5.0,
        [&](const Pose2&, const RowEstimate& lane) { EXPECT_EQ(lane.offset_m, seen[i++]); });
}

TEST(PublishedRows, FollowsABareOrchardAndGatesByWidth) {
  RowDetectorConfig config;
  config.mode = RowMode::kPublished;
  RowDetector detector(config);
  const Drive seen = drive(bare(), detector, 6.0, 12.0);
  EXPECT_GE(seen.valid, seen.scans / 2);
  EXPECT_LT(seen.worst_offset, 0.25);
  config.row_width_m = 6.0;
  RowDetector other(config);
  EXPECT_EQ(drive(bare(), other, 6.0, 9.0).valid, 0);
}

}  // namespace
}  // namespace headland
