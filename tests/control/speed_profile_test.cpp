// SPDX-License-Identifier: Apache-2.0
#include "control/speed_profile.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

constexpr double kDeceleration = 0.5;
constexpr double kDt = 0.05;

// 20 m forward in two legs, then 5 m back.
Reference forth_and_back() {
  Reference reference;
  reference.path.append_straight({0.0, 0.0, 0.0}, 12.0, 0);
  reference.path.append_straight({12.0, 0.0, 0.0}, 8.0, 1);
  reference.path.append({{20.0, 0.0, 0.0}, 0.0, 5.0, Gear::kReverse, 2});
  reference.leg_speed = {2.0, 1.0, 0.6};
  return reference;
}

TEST(SpeedProfile, KeepsToTheSpeedOfEachLeg) {
  SpeedProfile profile;
  profile.build(forth_and_back(), kDeceleration);
  EXPECT_DOUBLE_EQ(profile.limit(0.0, 0, kDt), 2.0);
  EXPECT_DOUBLE_EQ(profile.limit(13.0, 0, kDt), 1.0);
  EXPECT_DOUBLE_EQ(profile.limit(20.0, 1, kDt), 0.6);
  EXPECT_LE(profile.limit(11.9999, 0, kDt), 1.0 + 1e-2);
}

TEST(SpeedProfile, IsZeroAtTheEndOfASegmentAndNotBefore) {
  SpeedProfile profile;
  profile.build(forth_and_back(), kDeceleration);
  EXPECT_EQ(profile.limit(20.0, 0, kDt), 0.0);
  EXPECT_EQ(profile.limit(25.0, 1, kDt), 0.0);
  EXPECT_GT(profile.limit(19.99, 0, kDt), 0.0);
  EXPECT_GT(profile.limit(24.99, 1, kDt), 0.0);
}

TEST(SpeedProfile, DrivenCycleByCycleNeverAsksForHarderBrakingAndEndsOnTheSpot) {
  const Reference reference = forth_and_back();
  SpeedProfile profile;
  profile.build(reference, kDeceleration);
  for (const int segment : {0, 1}) {
    const PathSegment& span = reference.path.segments()[static_cast<std::size_t>(segment)];
    double s = span.begin_s;
    double speed = profile.limit(s, segment, kDt);
    for (int i = 0; i < 2000; ++i) {
      const double next = profile.limit(s, segment, kDt);
      ASSERT_GE(next, speed - kDeceleration * kDt - 1e-9) << "at " << s;
      speed = next;
      s += speed * kDt;
      ASSERT_LE(s, span.end_s + 1e-9);
    }
    EXPECT_NEAR(s, span.end_s, 1e-3);
  }
}

TEST(SpeedProfile, BrakesAheadOverLegsTooShortToBrakeIn) {
  Reference reference;
  for (int i = 0; i < 40; ++i) reference.path.append_straight({0.1 * i, 0.0, 0.0}, 0.1, i);
  reference.leg_speed.assign(40, 3.0);
  SpeedProfile profile;
  profile.build(reference, kDeceleration);
  for (double s = 0.0; s < 4.0; s += 0.01) {
    EXPECT_LE(profile.limit(s, 0, 0.0),
              std::sqrt(2.0 * kDeceleration * std::max(0.0, 4.0 - s)) + 1e-6);
  }
}

TEST(SpeedProfile, KeepsToTheSlowestOfOverlappingZonesAndBrakesInTimeForThem) {
  Reference reference;
  reference.path.append_straight({0.0, 0.0, 0.0}, 30.0, 0);
  reference.leg_speed = {2.0};
  const std::vector<SpeedZone> zones = {{10.0, 14.0, 0.8}, {11.0, 12.0, 0.5}, {13.0, 16.0, 1.0}};
  SpeedProfile profile;
  profile.build(reference, kDeceleration, zones);
  EXPECT_DOUBLE_EQ(profile.limit(2.0, 0, 0.0), 2.0);
  EXPECT_NEAR(profile.limit(9.0, 0, 0.0), std::sqrt(0.8 * 0.8 + 2.0 * kDeceleration), 1e-12);
  EXPECT_DOUBLE_EQ(profile.limit(11.5, 0, 0.0), 0.5);
  EXPECT_DOUBLE_EQ(profile.limit(12.5, 0, 0.0), 0.8);
  EXPECT_DOUBLE_EQ(profile.limit(13.5, 0, 0.0), 0.8);
  EXPECT_DOUBLE_EQ(profile.limit(15.0, 0, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(profile.limit(16.5, 0, 0.0), 2.0);
}

TEST(SpeedProfile, StandsStillOnALegWithoutASpeed) {
  Reference reference;
  reference.path.append_straight({0.0, 0.0, 0.0}, 1.0, 0);
  SpeedProfile profile;
  profile.build(reference, kDeceleration);
  EXPECT_EQ(profile.limit(0.5, 0, kDt), 0.0);
}

}  // namespace
}  // namespace headland
