// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/clothoid.hpp"

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/support/steering_curves.hpp"

namespace headland {
namespace {

// Poses a chord of that length apart, by their angles to it.
Pose2 leaving(double phi0) { return {0.0, 0.0, phi0}; }
Pose2 arriving(double phi1, double chord = 1.0) { return {chord, 0.0, phi1}; }

// Many short arcs, each with the curvature of its middle: an error of second order in their length.
Pose2 by_short_arcs(const Clothoid& clothoid, int count) {
  Pose2 pose = clothoid.start;
  const double step = clothoid.length / count;
  for (int i = 0; i < count; ++i) {
    pose = advance(pose, clothoid.curvature_at((i + 0.5) * step), step);
  }
  return pose;
}

double end_miss(const Clothoid& clothoid, const Pose2& to) {
  const Pose2 end = clothoid.pose_at(clothoid.length);
  return std::max((end.position() - to.position()).norm(), std::abs(wrap_angle(end.yaw - to.yaw)));
}

TEST(Clothoid, AgreesWithThePublishedAlgorithmOnItsTestVectors) {
  struct Vector {
    double phi0, phi1, a, length, curvature, sharpness;
  };
  const Vector vectors[] = {
      {0.2, 0.3, 1.498855829, 1.006683475, -1.389568682, 2.958039560},
      {0.0, 0.5 * kPi, 4.489132784, 1.170322169, -2.493618027, 6.555134150},
      {0.5 * kPi, 0.5 * kPi, 9.189758294, 1.274295230, -7.211639874, 11.318632767},
      {0.5 * kPi, -0.5 * kPi, 0.0, 0.5 * kPi, -2.0, 0.0},
  };
  for (const Vector& v : vectors) {
    const auto fit = fit_clothoid(leaving(v.phi0), arriving(v.phi1));
    ASSERT_TRUE(fit);
    const Clothoid& c = fit->curve;
    EXPECT_NEAR(0.5 * c.sharpness * c.length * c.length, v.a, 1e-9);
    EXPECT_NEAR(c.length, v.length, 1e-9);
    EXPECT_NEAR(c.curvature, v.curvature, 1e-8);
    EXPECT_NEAR(c.sharpness, v.sharpness, 1e-8);
  }
}

TEST(Clothoid, IsFoundForAllPairsOfAnglesInAsFewIterationsAsPublished) {
  RandomStream random(1, "clothoid");
  constexpr int kCount = 20000;
  int sum = 0;
  int most = 0;
  for (int i = 0; i < kCount; ++i) {
    const double phi0 = random.uniform(-kPi, kPi);
    const double phi1 = random.uniform(-kPi, kPi);
    const auto fit = fit_clothoid(leaving(phi0), arriving(phi1));
    ASSERT_TRUE(fit) << phi0 << " " << phi1;
    ASSERT_LT(end_miss(fit->curve, arriving(phi1)), 1e-9) << phi0 << " " << phi1;
    sum += fit->iterations;
    most = std::max(most, fit->iterations);
  }
  EXPECT_NEAR(static_cast<double>(sum) / kCount, 3.11, 0.02);
  EXPECT_EQ(most, 4);
}

TEST(Clothoid, JoinsPosesOfAFarmToANanometre) {
  RandomStream random(2, "clothoid");
  for (int i = 0; i < 5000; ++i) {
    const Pose2 from = test::random_pose(random, 1000.0);
    const Pose2 to = test::random_pose(random, 1000.0);
    const auto fit = fit_clothoid(from, to);
    ASSERT_TRUE(fit);
    // Near two headings straight away from each other the curve is far longer than the chord.
    ASSERT_LT(end_miss(fit->curve, to), 1e-9 * std::max(1.0, fit->curve.length / 1000.0)) << i;
  }
}

TEST(Clothoid, DrivesAsShortArcsOfItsCurvatureDo) {
  RandomStream random(3, "clothoid");
  for (int i = 0; i < 100; ++i) {
    const Clothoid c{test::random_pose(random, 100.0), random.uniform(-2.0, 2.0),
                     random.uniform(-0.5, 0.5), random.uniform(0.1, 30.0)};
    const Pose2 exact = c.pose_at(c.length);
    const Pose2 coarse = by_short_arcs(c, 5000);
    const Pose2 fine = by_short_arcs(c, 10000);
    // Richardson: the error of the fine one is a third of the difference.
    const Point2 limit = fine.position() + (fine.position() - coarse.position()) / 3.0;
    ASSERT_LT((exact.position() - limit).norm(), 1e-9) << i;
    ASSERT_NEAR(exact.yaw, fine.yaw, 1e-9);
  }
}

TEST(Clothoid, DrivenBackFromItsEndIsAtItsStart) {
  RandomStream random(4, "clothoid");
  for (int i = 0; i < 200; ++i) {
    const Pose2 from = test::random_pose(random, 10.0);
    const double curvature = random.uniform(-1.0, 1.0);
    const double sharpness = random.uniform(-0.2, 0.2);
    const double distance = random.uniform(0.1, 20.0);
    const Pose2 there = advance(from, curvature, sharpness, distance);
    const Pose2 back = advance(there, curvature + sharpness * distance, sharpness, -distance);
    ASSERT_LT((back.position() - from.position()).norm(), 1e-11);
    ASSERT_NEAR(back.yaw, from.yaw, 1e-12);
  }
}

TEST(Clothoid, OfMirroredPosesIsTheMirrorImage) {
  RandomStream random(5, "clothoid");
  for (int i = 0; i < 500; ++i) {
    const Pose2 from = test::random_pose(random, 20.0);
    const Pose2 to = test::random_pose(random, 20.0);
    const auto a = fit_clothoid(from, to);
    const auto b = fit_clothoid(test::mirrored(from), test::mirrored(to));
    ASSERT_TRUE(a && b);
    ASSERT_NEAR(a->curve.length, b->curve.length, 1e-8 * a->curve.length);
    ASSERT_NEAR(a->curve.curvature, -b->curve.curvature, 1e-7);
    ASSERT_NEAR(a->curve.sharpness, -b->curve.sharpness, 1e-7);
  }
}

TEST(Clothoid, OfThePosesLookingBackIsTheSameCurveDrivenTheOtherWay) {
  RandomStream random(6, "clothoid");
  for (int i = 0; i < 500; ++i) {
    const Pose2 from = test::random_pose(random, 20.0);
    const Pose2 to = test::random_pose(random, 20.0);
    const auto there = fit_clothoid(from, to);
    const auto back = fit_clothoid(reversed(to), reversed(from));
    ASSERT_TRUE(there && back);
    ASSERT_NEAR(there->curve.length, back->curve.length, 1e-8 * there->curve.length);
    ASSERT_NEAR(there->curve.curvature, -back->curve.curvature_at(back->curve.length), 1e-7);
    ASSERT_NEAR(there->curve.sharpness, back->curve.sharpness, 1e-7);
  }
}

TEST(Clothoid, IsAStraightOrAnArcWhereOneServes) {
  const auto line = fit_clothoid({1.0, 2.0, 0.3}, advance({1.0, 2.0, 0.3}, 0.0, 7.0));
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->curve.length, 7.0, 1e-12);
  EXPECT_NEAR(line->curve.max_abs_curvature(), 0.0, 1e-12);
  const auto arc = fit_clothoid({1.0, 2.0, 0.3}, advance({1.0, 2.0, 0.3}, -0.25, 9.0));
  ASSERT_TRUE(arc);
  EXPECT_NEAR(arc->curve.length, 9.0, 1e-9);
  EXPECT_NEAR(arc->curve.curvature, -0.25, 1e-9);
  EXPECT_NEAR(arc->curve.max_abs_curvature(), 0.25, 1e-9);
}

TEST(Clothoid, HasNoAnswerWhereThePosesShareTheirPlace) {
  EXPECT_FALSE(fit_clothoid({1.0, 1.0, 0.0}, {1.0, 1.0, 1.0}));
  EXPECT_FALSE(fit_clothoid({0.0, 0.0, std::nan("")}, {1.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace headland
