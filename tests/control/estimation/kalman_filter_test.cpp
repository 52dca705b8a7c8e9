// SPDX-License-Identifier: Apache-2.0
#include "control/estimation/kalman_filter.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "core/geometry/angle.hpp"
#include "tests/control/estimation/sensed_vehicle.hpp"

namespace headland {
namespace {

using testing::lagging_vehicle;

constexpr Steering kBothKinds[] = {Steering::kAckermann, Steering::kDifferential};

EstimateVector random_state(RandomStream& random) {
  EstimateVector state;
  state << random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0), random.uniform(-2.0, 2.0),
      random.uniform(-2.0, 2.0), random.uniform(-0.5, 0.5), random.uniform(-0.2, 0.3),
      random.uniform(-0.2, 0.2), random.uniform(-0.1, 0.1);
  return state;
}

TEST(MeasurementModel, DerivativesAreThoseOfFiniteDifferences) {
  RandomStream random(1, "states");
  constexpr double kStep = 1e-6;
  for (const Steering steering : kBothKinds) {
    const MotionModel motion(steering, 1.5);
    for (int trial = 0; trial < 200; ++trial) {
      const EstimateVector at = random_state(random);
      const auto kind = static_cast<MeasurementKind>(trial % 5);
      const Measurement m{0.0, kind, {random.uniform(-1.0, 1.0), 0.3}, 0.1};
      const MeasurementModel model = model_measurement(motion, at, m);
      EXPECT_EQ(model.size, kind == MeasurementKind::kPosition ? 2 : 1);
      for (int i = 0; i < 8; ++i) {
        const EstimateVector step = kStep * EstimateVector::Unit(i);
        const Eigen::Vector2d slope = (model_measurement(motion, at + step, m).residual -
                                       model_measurement(motion, at - step, m).residual) /
                                      (2.0 * kStep);
        EXPECT_LT((slope + model.by_state.col(i)).norm(), 1e-8);
      }
    }
  }
}

TEST(MeasurementModel, HeadingsDifferByTheShorterWayRound) {
  const MotionModel motion(Steering::kAckermann, 1.5);
  EstimateVector at = EstimateVector::Zero();
  at(2) = kPi - 0.01;
  const Measurement m{0.0, MeasurementKind::kHeading, {-kPi + 0.02, 0.0}, 0.1};
  EXPECT_NEAR(model_measurement(motion, at, m).residual(0), 0.03, 1e-12);
}

// A covariance of rank one, v v', becomes F v (F v)' beside the noise.
TEST(KalmanFilter, PredictsTheStateAndItsDerivativesAsFiniteDifferencesDo) {
  RandomStream random(2, "states");
  constexpr double kStep = 1e-5;
  for (const Steering steering : kBothKinds) {
    const EstimationModel model(lagging_vehicle(steering), {});
    for (int trial = 0; trial < 300; ++trial) {
      const EstimateVector at = random_state(random);
      EstimateVector v;
      for (int i = 0; i < 8; ++i) v(i) = random.uniform(-1.0, 1.0);
      const Command acting{random.uniform(-2.0, 2.0), random.uniform(-0.6, 0.6),
                           random.uniform(-1.0, 1.0)};
      const double dt = random.uniform(0.005, 0.1);
      KalmanFilter filter(model);
      filter.reset(at, v * v.transpose());
      filter.predict(acting, dt);
      EXPECT_LT((filter.state() - model.coast(at, acting, dt)).norm(), 1e-12);
      const EstimateVector slope =
          (model.coast(at + kStep * v, acting, dt) - model.coast(at - kStep * v, acting, dt)) /
          (2.0 * kStep);
      EstimateMatrix expected = slope * slope.transpose();
      expected.diagonal() += model.noise(at, dt);
      EXPECT_LT((filter.covariance() - expected).cwiseAbs().maxCoeff(), 1e-6) << trial;
    }
  }
}

TEST(KalmanFilter, OfAVehicleThatStandsTheMeanOfThePositionsRemains) {
  const EstimationModel model(lagging_vehicle(Steering::kAckermann), {});
  KalmanFilter filter(model);
  filter.reset(
      EstimateVector::Zero(),
      EstimateMatrix(EstimateVector((EstimateVector() << 0.04, 0.04, 0, 0, 0, 0, 0, 0).finished())
                         .asDiagonal()));
  RandomStream random(3, "positions");
  double sum = 0.0;
  constexpr int kCount = 50;
  for (int i = 0; i < kCount; ++i) {
    const double x = 0.1 + 0.05 * random.normal();
    sum += x;
    filter.update({0.0, MeasurementKind::kPosition, {x, 0.0}, 0.05});
  }
  const double weight = kCount / (0.05 * 0.05);  // against 1 / 0.04 of "zero"
  EXPECT_NEAR(filter.state()(0), sum / kCount * weight / (weight + 25.0), 1e-12);
  EXPECT_NEAR(filter.covariance()(0, 0), 1.0 / (weight + 25.0), 1e-12);
}

EstimateVector drawn(RandomStream& random, const EstimateVector& variance) {
  EstimateVector noise;
  for (int i = 0; i < 8; ++i) noise(i) = std::sqrt(variance(i)) * random.normal();
  return noise;
}

// Truths that are drawn from the filter's own noise lie as far off as its covariance says: the
// squared distance in units of that has the mean 8.
TEST(KalmanFilter, IsConsistentWithItsOwnNoise) {
  RandomStream random(4, "truths");
  for (const Steering steering : kBothKinds) {
    EstimationConfig config;
    config.first_loss_ratio = 0.02;
    config.first_side_deg = config.first_offset_deg = 0.5;
    const EstimationModel model(lagging_vehicle(steering), config);
    double sum = 0.0;
    constexpr int kRuns = 300;
    for (int run = 0; run < kRuns; ++run) {
      EstimateVector start = EstimateVector::Zero();
      start(3) = 1.0;
      KalmanFilter filter(model);
      filter.reset(start, model.first_covariance());
      EstimateVector truth = start + drawn(random, model.first_covariance().diagonal());
      for (int i = 1; i <= 50; ++i) {
        const Command acting = testing::weave(1.0, 0.02 * i);
        const EstimateVector noise = drawn(random, model.noise(truth, 0.02));
        truth = model.coast(truth, acting, 0.02) + noise;
        filter.predict(acting, 0.02);
        filter.update(
            {0.0, MeasurementKind::kSpeed, {truth(3) + 0.01 * random.normal(), 0.0}, 0.01});
        if (i % 5 != 0) continue;
        filter.update({0.0,
                       MeasurementKind::kPosition,
                       {truth(0) + 0.01 * random.normal(), truth(1) + 0.01 * random.normal()},
                       0.01});
      }
      EstimateVector off = filter.state() - truth;
      sum += off.dot(EstimateMatrix(filter.covariance()).inverse() * off);
    }
    EXPECT_NEAR(sum / kRuns, 8.0, 0.9);  // its deviation is 0.23
  }
}

TEST(KalmanFilter, KeepsTheBoundsOfTheSlip) {
  const EstimationModel model(lagging_vehicle(Steering::kAckermann), {});
  KalmanFilter filter(model);
  EstimateVector start = EstimateVector::Zero();
  start(3) = 1.0;
  filter.reset(start, model.first_covariance());
  for (int i = 0; i < 100; ++i) {
    filter.predict({1.0, 0.0, 0.0}, 0.02);
    filter.update({0.0, MeasurementKind::kPosition, {-0.02 * i, -0.02 * i}, 0.001});
    EXPECT_TRUE((filter.state().tail<3>().array().abs() <= model.slip_bounds().array()).all());
  }
  EXPECT_TRUE(filter.finite());
}

}  // namespace
}  // namespace headland
