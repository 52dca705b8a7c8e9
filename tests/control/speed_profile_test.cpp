// SPDX-License-Identifier: Apache-2.0
#include "control/speed_profile.hpp"

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/support/allocation_counter.hpp"

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

// Legs of random lengths and speeds, some in reverse, and zones across their borders.
struct RandomRoute {
  Reference reference;
  std::vector<SpeedZone> zones;
};

RandomRoute random_route(int number) {
  RandomStream random(number, "speed profile");
  RandomRoute route;
  Path& path = route.reference.path;
  Gear gear = Gear::kForward;
  for (int leg = 0; leg < 12; ++leg) {
    if (leg > 0 && random.uniform(0.0, 1.0) < 0.25) {
      gear = gear == Gear::kForward ? Gear::kReverse : Gear::kForward;
    }
    const Pose2 from = path.empty() ? Pose2{} : path.end_pose();
    path.append({from, random.uniform(-0.3, 0.3), random.uniform(0.05, 8.0), gear, leg});
    route.reference.leg_speed.push_back(random.uniform(0.2, 3.0));
  }
  for (double s = 0.0; s < path.length(); s += random.uniform(0.2, 6.0)) {
    route.zones.push_back({s, s + random.uniform(0.1, 3.0), random.uniform(0.1, 2.0)});
  }
  return route;
}

struct Progress {
  SpeedProfile::State state;
  double seconds = 0.0;
};

// In small steps: the acceleration, and never above the limit. First order, error O(dt).
Progress integrate(const SpeedProfile& profile, const PathSegment& segment, int number,
                   double acceleration, double seconds, double dt) {
  Progress now{{segment.begin_s, 0.0}, 0.0};
  while (now.seconds < seconds - 0.5 * dt) {
    const double next =
        std::min(now.state.speed + acceleration * dt, profile.limit(now.state.s, number, dt));
    now.state = {now.state.s + 0.5 * (now.state.speed + next) * dt, next};
    now.seconds += dt;
  }
  return now;
}

TEST(SpeedProfileAdvance, IsTheFineIntegrationOfAccelerationAndLimit) {
  for (int number = 0; number < 6; ++number) {
    const RandomRoute route = random_route(number);
    SpeedProfile profile;
    profile.build(route.reference, 0.8, route.zones, 0.7);
    int segment = 0;
    for (const PathSegment& span : route.reference.path.segments()) {
      for (const double seconds : {0.5, 2.0, 5.0, 12.0, 30.0}) {
        const Progress fine = integrate(profile, span, segment, 0.8, seconds, 2e-4);
        const SpeedProfile::State exact = profile.advance(span.begin_s, 0.0, segment, seconds);
        ASSERT_NEAR(exact.s, fine.state.s, 5e-3) << number << " after " << seconds;
        ASSERT_NEAR(exact.speed, fine.state.speed, 2e-2) << number << " after " << seconds;
      }
      ++segment;
    }
  }
}

TEST(SpeedProfileAdvance, DoesNotDependOnTheStepAndStopsOnTheSpot) {
  for (int number = 0; number < 20; ++number) {
    const RandomRoute route = random_route(number);
    SpeedProfile profile;
    profile.build(route.reference, 0.8, route.zones);
    int segment = 0;
    for (const PathSegment& span : route.reference.path.segments()) {
      for (const double dt : {0.05, 0.01, 0.003}) {
        SpeedProfile::State now{span.begin_s, 0.0};
        for (int i = 1; i * dt < profile.duration() + 1.0; ++i) {
          const SpeedProfile::State next = profile.advance(now.s, now.speed, segment, dt);
          ASSERT_LE(next.speed, profile.limit(next.s, segment, 0.0) + 1e-6);
          ASSERT_LE(std::abs(next.speed - now.speed), 0.8 * dt + 1e-6) << " at " << now.s;
          ASSERT_GE(next.s, now.s);
          now = next;
          if (i % 500 != 0) continue;
          const SpeedProfile::State once = profile.advance(span.begin_s, 0.0, segment, i * dt);
          ASSERT_NEAR(now.s, once.s, 1e-6);
          ASSERT_NEAR(now.speed, once.speed, 1e-5);
        }
        ASSERT_NEAR(now.s, span.end_s, 1e-9);
        ASSERT_EQ(now.speed, 0.0);
      }
      ++segment;
    }
  }
}

TEST(SpeedProfileAdvance, CountsASpeedAboveTheLimitAsTheLimitAndKeepsTheFasterStart) {
  SpeedProfile profile;
  profile.build(forth_and_back(), kDeceleration);
  EXPECT_NEAR(profile.advance(0.0, 5.0, 0, 1.0).s, 2.0, 1e-12);
  EXPECT_NEAR(profile.advance(0.0, 1.5, 0, 0.5).s, 0.5 * 1.5 + 0.5 * 0.5 * 0.25, 1e-12);
  EXPECT_EQ(profile.advance(20.0, 1.0, 0, 1.0).s, 20.0);
  EXPECT_EQ(profile.advance(20.0, 1.0, 0, 1.0).speed, 0.0);
  EXPECT_EQ(profile.advance(21.0, 1.0, 0, 1.0).s, 20.0) << "past the end of its segment";
  EXPECT_EQ(profile.advance(3.0, 1.0, 7, 1.0).speed, 0.0) << "no such segment";
}

TEST(SpeedProfile, KnowsHowLongTheReferenceTakes) {
  Reference reference;
  reference.path.append_straight({}, 10.0, 0);
  reference.leg_speed = {1.0};
  SpeedProfile profile;
  // 2 s up, 8 m at 1 m/s and 2 s down; at half the braking 4 s down, over 2 m.
  profile.build(reference, 0.5);
  EXPECT_NEAR(profile.duration(), 12.0, 1e-9);
  profile.build(reference, 0.5, {}, 0.5);
  EXPECT_NEAR(profile.duration(), 2.0 + 7.0 + 4.0, 1e-9);
  // Too short for the speed: up to the middle and down again.
  reference.leg_speed = {10.0};
  profile.build(reference, 0.5);
  EXPECT_NEAR(profile.duration(), 2.0 * std::sqrt(10.0 / 0.5), 1e-9);
  reference.leg_speed = {};
  profile.build(reference, 0.5);
  EXPECT_TRUE(std::isinf(profile.duration()));
}

TEST(SpeedProfile, TakesAsLongAsItsOwnMotion) {
  for (int number = 0; number < 20; ++number) {
    const RandomRoute route = random_route(number);
    SpeedProfile profile;
    profile.build(route.reference, 0.8, route.zones, 0.6);
    double seconds = 0.0;
    int segment = 0;
    for (const PathSegment& span : route.reference.path.segments()) {
      SpeedProfile::State now{span.begin_s, 0.0};
      for (; now.s < span.end_s; seconds += 1e-3) {
        now = profile.advance(now.s, now.speed, segment, 1e-3);
      }
      ++segment;
    }
    EXPECT_NEAR(profile.duration(), seconds, 2e-3 * (segment + 1));
  }
}

TEST(SpeedProfile, BrakesWithItsShareOfTheDecelerationAlone) {
  SpeedProfile profile;
  profile.build(forth_and_back(), kDeceleration, {}, 0.4);
  EXPECT_NEAR(profile.limit(19.0, 0, 0.0), std::sqrt(2.0 * 0.4 * kDeceleration * 1.0), 1e-12);
  // A vehicle whose wheels slip by 60 % has just that deceleration over the ground.
  double s = 0.0;
  double ground_speed = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double wanted = profile.limit(s, 0, 0.01);
    ground_speed = std::max(wanted, ground_speed - 0.4 * kDeceleration * 0.01);
    s += ground_speed * 0.01;
    ASSERT_LE(s, 20.0 + 1e-6);
  }
}

TEST(SpeedProfile, DoesNotAllocateWhenAsked) {
  const RandomRoute route = random_route(1);
  SpeedProfile profile;
  profile.build(route.reference, 0.8, route.zones);
  const long before = testing::allocation_count();
  SpeedProfile::State now;
  for (int i = 0; i < 1000; ++i) {
    now = profile.advance(now.s, std::min(now.speed, profile.limit(now.s, 0, 0.05)), 0, 0.05);
  }
  EXPECT_EQ(testing::allocation_count(), before);
}

}  // namespace
}  // namespace headland
