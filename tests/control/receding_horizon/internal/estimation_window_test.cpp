// SPDX-License-Identifier: Apache-2.0
#include "control/receding_horizon/internal/estimation_window.hpp"

#include <optional>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/control/estimation/sensed_vehicle.hpp"

namespace headland::control::internal {
namespace {

using headland::testing::kEstimationCycle;

constexpr int kIntervals = 16;
const std::vector<int> kLengths{6, 4, 3, 2, 1};

// A window over a drive, with only one kind of measurement, or none, off its optimum.
struct Scene {
  Scene(Steering steering, const EstimationConfig& config, std::optional<MeasurementKind> kind,
        std::uint64_t seed)
      : vehicle(headland::testing::lagging_vehicle(steering)),
        model(vehicle, config),
        log(vehicle, kEstimationCycle, 1.0),
        prior(model),
        window(model, log, 2, kIntervals, kLengths),
        random(seed, "window") {
    headland::testing::SensedVehicle truth(vehicle, seed);
    truth.state.speed = random.uniform() < 0.5 ? 0.9 : -0.9;
    log.reset(0.0);
    const double speed = truth.state.speed;
    const EstimateVector start = model.vector_of(truth.state, {});
    for (int i = 0; i < 2 * kIntervals; ++i) {
      const Command command = headland::testing::weave(1.1 * speed, 2.0 + truth.time());
      std::vector<Measurement> used;
      for (Measurement m : truth.step(command, {0.1, 0.05, 0.03})) {
        if (m.kind != kind) continue;
        m.time -= 0.3 * kEstimationCycle;  // within an interval
        used.push_back(m);
      }
      log.take(used, command, truth.time());
    }
    prior.reset(start, model.first_covariance());
    window.begin_at(start);
    window.extend();
    for (int b = 0; b <= window.block_count(); ++b) {
      EstimateVector& state = window.grid(window.block(b).first);
      for (int i = 0; i < 8; ++i) state(i) += 0.02 * random.normal();
      for (int i = 0; i < 3; ++i) window.block(b).trust(i) = random.uniform(0.1, 2.0);
    }
  }

  double cost() {
    window.guess_answers();
    window.linearise(prior);
    return window.cost();
  }
  // By central differences of the cost, at the begin of block `b`.
  double slope(int b, int i) {
    constexpr double kStep = 1e-5;
    double& value = window.grid(window.block(b).first)(i);
    const double before = value;
    value = before + kStep;
    const double more = cost();
    value = before - kStep;
    const double less = cost();
    value = before;
    return (more - less) / (2.0 * kStep);
  }
  void expect_slopes(int first, int last) {
    cost();
    for (int b = 0; b <= window.block_count(); ++b) {
      const EstimateVector slopes = window.block(b).slope;
      for (int i = first; i <= last; ++i) {
        EXPECT_NEAR(slope(b, i), slopes(i), 1e-5 * (1.0 + slopes.cwiseAbs().maxCoeff()))
            << "block " << b << ", number " << i;
      }
      cost();
    }
  }

  Vehicle vehicle;
  EstimationModel model;
  EstimationLog log;
  KalmanFilter prior;
  EstimationWindow window;
  RandomStream random;
};

constexpr std::optional<MeasurementKind> kTerms[] = {std::nullopt,
                                                     MeasurementKind::kPosition,
                                                     MeasurementKind::kHeading,
                                                     MeasurementKind::kSpeed,
                                                     MeasurementKind::kTurn,
                                                     MeasurementKind::kYawRate};

// The noise's own size goes with the speed, which Gauss-Newton leaves out: here of all others.
TEST(EstimationWindow, SlopesOfEveryTermAreThoseOfFiniteDifferences) {
  for (const Steering steering : {Steering::kAckermann, Steering::kDifferential}) {
    for (const auto& kind : kTerms) {
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Scene scene(steering, {}, kind, seed);
        ASSERT_EQ(scene.window.block_count(), 5);
        scene.expect_slopes(0, 2);
        scene.expect_slopes(4, 7);
      }
    }
  }
}

// And of the speed, where the noise of pose and slip has no size of its own.
TEST(EstimationWindow, SlopesByTheSpeedAreThoseOfFiniteDifferences) {
  EstimationConfig config;
  config.position_drift_m = config.heading_drift_deg = 0.0;
  config.loss_walk_ratio = config.side_walk_deg = config.offset_walk_deg = 1e-9;
  for (const Steering steering : {Steering::kAckermann, Steering::kDifferential}) {
    for (const auto& kind : kTerms) {
      Scene scene(steering, config, kind, 7);
      scene.expect_slopes(3, 3);
    }
  }
}

TEST(EstimationWindow, SlopesBeyondTheBoundsOfTheSlipAreThoseOfFiniteDifferences) {
  Scene scene(Steering::kAckermann, {}, MeasurementKind::kPosition, 9);
  for (int b = 0; b <= scene.window.block_count(); ++b) {
    const int i = b % 3;
    scene.window.grid(scene.window.block(b).first)(5 + i) =
        (b % 2 == 0 ? 1.3 : -1.3) * scene.model.slip_bounds()(i);
  }
  scene.expect_slopes(0, 2);
  scene.expect_slopes(4, 7);
}

TEST(EstimationWindow, StepsEndWhereAllSlopesVanish) {
  for (const Steering steering : {Steering::kAckermann, Steering::kDifferential}) {
    Scene scene(steering, {}, MeasurementKind::kPosition, 11);
    const double first = scene.cost();
    for (int i = 0; i < 15; ++i) ASSERT_TRUE(scene.window.improve(scene.prior));
    const double last = scene.cost();
    EXPECT_LT(last, 0.5 * first);
    scene.cost();
    for (int b = 0; b <= scene.window.block_count(); ++b) {
      // In units of the deviation that the block's own Hessian gives.
      const NoiseBlock& block = scene.window.block(b);
      const EstimateVector size = block.own.diagonal().cwiseSqrt();
      EXPECT_LT(block.slope.cwiseQuotient(size).cwiseAbs().maxCoeff(), 1e-4);
    }
  }
}

}  // namespace
}  // namespace headland::control::internal
