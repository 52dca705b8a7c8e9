// SPDX-License-Identifier: Apache-2.0
#include "perception/tracking/tracked_agent.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

Detection seen_at(const Point2& position, double noise) {
  Detection detection;
  detection.position = position;
  detection.covariance = noise * noise * Eigen::Matrix2d::Identity();
  return detection;
}

TEST(TrackedAgent, TwoSmallStepsPredictAsOneLarge) {
  TrackedAgent once = begin_track(seen_at({1.0, 2.0}, 0.1), {}, 1, 0.0);
  once.state.tail<2>() = Point2(0.5, -1.0);
  TrackedAgent twice = once;
  predict(once, 0.3, {});
  predict(twice, 0.1, {});
  predict(twice, 0.2, {});
  EXPECT_LT((once.state - twice.state).norm(), 1e-12);
  EXPECT_LT((once.covariance - twice.covariance).norm(), 1e-12);
}

TEST(TrackedAgent, ItsErrorsAreAsLargeAsItsCovarianceSays) {
  // Walkers that move as the filter expects: the normalised squared error has the mean 4.
  RandomStream random(3, "tracked_agent");
  const MotionConfig config;
  const double step = 0.1;
  double sum = 0.0;
  const int walkers = 400;
  for (int i = 0; i < walkers; ++i) {
    Eigen::Vector4d truth(0.0, 0.0, config.first_speed_mps * random.normal(),
                          config.first_speed_mps * random.normal());
    const auto measured = [&] {
      return seen_at(truth.head<2>() + 0.1 * Point2(random.normal(), random.normal()), 0.1);
    };
    TrackedAgent track = begin_track(measured(), config, 1, 0.0);
    const double q = config.variance(track.probability);
    for (int k = 0; k < 20; ++k) {
      for (int axis = 0; axis < 2; ++axis) {
        const double a = random.normal();
        const double b = random.normal();
        truth(axis) += step * truth(axis + 2) +
                       std::sqrt(q * step * step * step) * (a / 2.0 + b / std::sqrt(12.0));
        truth(axis + 2) += std::sqrt(q * step) * a;
      }
      predict(track, step, config);
      correct(track, measured());
    }
    const Eigen::Vector4d error = track.state - truth;
    sum += error.dot(track.covariance.inverse() * error);
  }
  EXPECT_NEAR(sum / walkers, 4.0, 0.5);
}

TEST(TrackedAgent, CovariancesStaySymmetricAndPositive) {
  TrackedAgent track = begin_track(seen_at({0.0, 0.0}, 0.01), {}, 1, 0.0);
  for (int k = 0; k < 2000; ++k) {
    predict(track, k % 7 == 0 ? 1e-4 : 0.5, {});
    correct(track, seen_at({0.01 * k, 0.0}, 0.01));
  }
  EXPECT_LT((track.covariance - track.covariance.transpose()).norm(), 1e-9);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(track.covariance);
  EXPECT_GT(solver.eigenvalues().minCoeff(), 0.0);
}

TEST(TrackedAgent, FitIsTheMahalanobisDistance) {
  const TrackedAgent track = begin_track(seen_at({0.0, 0.0}, 0.3), {}, 1, 0.0);
  const Fit fit = fit_of(track, seen_at({1.0, 0.0}, 0.4));
  EXPECT_NEAR(fit.distance2, 4.0, 1e-12);
  EXPECT_NEAR(fit.log_determinant, 2.0 * std::log(0.25), 1e-12);
}

TEST(Fuse, EvidenceAddsUpAndStaysAProbability) {
  ClassProbability belief = kUnknownClass;
  double before = belief[0];
  for (int i = 0; i < 20; ++i) {
    belief = fuse(belief, {0.6, 0.2, 0.1, 0.1}, 0.2);
    EXPECT_NEAR(std::accumulate(belief.begin(), belief.end(), 0.0), 1.0, 1e-12);
    EXPECT_GE(belief[0], before - 1e-12);
    before = belief[0];
  }
  EXPECT_EQ(most_probable(belief), ObjectClass::kPerson);
  // What is sure can still be turned.
  for (int i = 0; i < 40; ++i) belief = fuse(belief, {0.1, 0.7, 0.1, 0.1}, 0.2);
  EXPECT_EQ(most_probable(belief), ObjectClass::kLivestock);
}

TEST(Fuse, OrderDoesNotMatterAndNoEvidenceChangesNothing) {
  const ClassProbability a = {0.4, 0.3, 0.2, 0.1};
  const ClassProbability b = {0.2, 0.5, 0.2, 0.1};
  const ClassProbability ab = fuse(fuse(kUnknownClass, a), b);
  const ClassProbability ba = fuse(fuse(kUnknownClass, b), a);
  for (std::size_t i = 0; i < ab.size(); ++i) EXPECT_NEAR(ab[i], ba[i], 1e-12);
  EXPECT_EQ(fuse(a, {0.0, 0.0, 0.0, 0.0}), a);
  EXPECT_EQ(fuse(a, {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0, 0.0}), a);
  const ClassProbability same = fuse(a, kUnknownClass);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(same[i], a[i], 1e-12);
  EXPECT_EQ(most_probable(kUnknownClass), ObjectClass::kOther);
}

TEST(ToAgent, GivesTheKindByClassAndSize) {
  TrackedAgent track = begin_track(seen_at({3.0, 4.0}, 0.1), {}, 17, 0.0);
  track.state.tail<2>() = Point2(1.0, -1.0);
  EXPECT_EQ(to_agent(track).kind, AgentKind::kPerson);
  EXPECT_EQ(to_agent(track).id, 17);
  EXPECT_EQ(to_agent(track).position, Point2(3.0, 4.0));
  EXPECT_EQ(to_agent(track).velocity, Point2(1.0, -1.0));
  EXPECT_NEAR(to_agent(track).noise_m, 0.1, 1e-9);
  track.probability = {0.1, 0.7, 0.1, 0.1};
  track.height_m = 0.8;
  EXPECT_EQ(to_agent(track).kind, AgentKind::kSheep);
  track.height_m = 1.5;
  track.width_m = 2.0;
  EXPECT_EQ(to_agent(track).kind, AgentKind::kCattle);
  EXPECT_NEAR(to_agent(track).radius_m, 1.0, 1e-12);
  track.probability = {0.1, 0.1, 0.7, 0.1};
  EXPECT_EQ(to_agent(track).kind, AgentKind::kVehicle);
}

}  // namespace
}  // namespace headland
