// SPDX-License-Identifier: Apache-2.0
#include "control/receding_horizon/horizon_estimator.hpp"

#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "control/estimation/ekf_estimator.hpp"
#include "tests/control/estimation/sensed_vehicle.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

using testing::Estimated;
using testing::kEstimationCycle;
using testing::lagging_vehicle;
using testing::SensedDrive;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr NoiseBlocking kBlockings[] = {NoiseBlocking::kNone, NoiseBlocking::kUniform,
                                        NoiseBlocking::kStructured};
const Slip kSlip{0.1, deg_to_rad(3.0), deg_to_rad(2.0)};

HorizonEstimatorConfig with(NoiseBlocking blocking) {
  HorizonEstimatorConfig config;
  config.blocking = blocking;
  return config;
}

HorizonEstimator estimator_of(const Vehicle& vehicle, const HorizonEstimatorConfig& config = {}) {
  return HorizonEstimator(vehicle, {}, config, kEstimationCycle);
}

EstimateVector vector_of(const VehicleState& state, const Slip& slip) {
  EstimateVector v;
  v << state.pose.x, state.pose.y, state.pose.yaw, state.speed, state.steering + state.yaw_rate,
      slip.loss_ratio, slip.side_rad, slip.steering_offset_rad;
  return v;
}
EstimateVector vector_of(const Estimate& e) { return vector_of(e.vehicle.state, e.vehicle.slip); }

double off_place(const Estimated& now) {
  return (now.estimate.vehicle.state.pose.position() - now.truth.pose.position()).norm();
}

void expect_slip(const Slip& slip, const Slip& wanted) {
  EXPECT_NEAR(slip.loss_ratio, wanted.loss_ratio, 0.02);
  EXPECT_NEAR(slip.side_rad, wanted.side_rad, deg_to_rad(1.0));
  EXPECT_NEAR(slip.steering_offset_rad, wanted.steering_offset_rad, deg_to_rad(0.6));
}

TEST(HorizonEstimator, FindsTheSlipOfBothKindsInBothGearsWithEveryBlocking) {
  for (const NoiseBlocking blocking : kBlockings) {
    for (const Steering steering : {Steering::kAckermann, Steering::kDifferential}) {
      for (const double speed : {1.2, -1.2}) {
        SensedDrive drive{.vehicle = lagging_vehicle(steering), .speed = speed, .seconds = 12.0};
        drive.slip = [](double) { return kSlip; };
        HorizonEstimator rhe = estimator_of(drive.vehicle, with(blocking));
        const Estimated end = drive.run(rhe);
        EXPECT_EQ(end.estimate.status, EstimateStatus::kGood);
        expect_slip(end.estimate.vehicle.slip, kSlip);
        EXPECT_LT(off_place(end), 0.03);
        EXPECT_NEAR(end.estimate.vehicle.state.pose.yaw, end.truth.pose.yaw, deg_to_rad(0.6));
      }
    }
  }
}

TEST(HorizonEstimator, BlocksFillTheWindowAndGrowIntoThePast) {
  const auto lengths = [](const HorizonEstimatorConfig& config) {
    return HorizonEstimator({}, {}, config, kEstimationCycle).blocks();
  };
  HorizonEstimatorConfig config;
  config.period_s = 0.06;
  config.window_s = 2.04;  // 34 intervals
  config.blocking = NoiseBlocking::kNone;
  EXPECT_EQ(lengths(config), std::vector<int>(34, 1));
  config.blocking = NoiseBlocking::kUniform;
  EXPECT_EQ(lengths(config), (std::vector<int>{4, 5, 5, 5, 5, 5, 5}));  // 8 of 4.25, rounded up
  config.blocking = NoiseBlocking::kStructured;
  EXPECT_EQ(lengths(config), (std::vector<int>{1, 13, 8, 5, 3, 2, 1, 1}));
  RandomStream random(3, "configs");
  for (int trial = 0; trial < 200; ++trial) {
    config.blocking = kBlockings[trial % 3];
    config.window_s = random.uniform(0.1, 5.0);
    config.period_s = random.uniform(0.005, 1.0);
    config.blocks_count = 1 + random.index(40);
    const std::vector<int> blocks = lengths(config);
    const double stride = std::max(1.0, std::round(config.period_s / kEstimationCycle));
    const double intervals =
        std::max(1.0, std::round(config.window_s / (stride * kEstimationCycle)));
    EXPECT_EQ(std::accumulate(blocks.begin(), blocks.end(), 0), static_cast<int>(intervals));
    EXPECT_GE(*std::min_element(blocks.begin(), blocks.end()), 1);
  }
}

// Straight on at one speed, all is nearly linear. What remains is the place of the noise of speed
// and turn, which the filter adds after a cycle and the window spreads over it: it is made small
// here.
TEST(HorizonEstimator, GaussianAndUnblockedItIsTheKalmanFilterOnALinearDrive) {
  for (const Steering steering : {Steering::kAckermann, Steering::kDifferential}) {
    SensedDrive drive{.vehicle = lagging_vehicle(steering), .seconds = 8.0};
    drive.command = [](double) { return Command{1.0, 0.0, 0.0}; };
    drive.start.speed = 1.0;
    HorizonEstimatorConfig config = with(NoiseBlocking::kNone);
    config.tail_freedom_count = 0.0;
    config.period_s = kEstimationCycle;
    config.window_s = 1.0;
    EstimationConfig noise;
    noise.first_loss_ratio = 0.01;
    noise.first_side_deg = noise.first_offset_deg = 0.3;
    noise.speed_walk_mps = 0.01;
    noise.turn_walk_deg = 0.05;
    noise.yaw_rate_walk_radps = 0.005;
    HorizonEstimator rhe(drive.vehicle, noise, config, kEstimationCycle);
    EkfEstimator ekf(drive.vehicle, noise, kEstimationCycle);
    std::vector<Estimate> filtered;
    drive.run(ekf, [&](const Estimated& now, double) { filtered.push_back(now.estimate); });
    double apart = 0.0;
    double wider = 0.0;
    std::size_t tick = 0;
    drive.run(rhe, [&](const Estimated& now, double) {
      const Estimate& other = filtered[tick++];
      const EstimateVector off = vector_of(now.estimate) - vector_of(other);
      apart = std::max(apart, off.cwiseQuotient(other.deviation).cwiseAbs().maxCoeff());
      wider = std::max(
          wider,
          (now.estimate.deviation.cwiseQuotient(other.deviation).array() - 1.0).abs().maxCoeff());
    });
    EXPECT_LT(apart, 0.05);  // deviations
    EXPECT_LT(wider, 0.02);
  }
}

// Seconds after the step at 10 s until loss and side slip stay within a third of it.
double answer_time(Estimator& estimator, std::uint64_t seed) {
  const Slip after{0.25, deg_to_rad(8.0), 0.0};
  SensedDrive drive{.seconds = 16.0, .seed = seed};
  drive.slip = [&](double time) { return time < 10.0 ? Slip{} : after; };
  double last_off = 10.0;
  drive.run(estimator, [&](const Estimated& now, double time) {
    const Slip& slip = now.estimate.vehicle.slip;
    const bool near = std::abs(slip.loss_ratio - after.loss_ratio) < after.loss_ratio / 3.0 &&
                      std::abs(slip.side_rad - after.side_rad) < after.side_rad / 3.0;
    if (!near) last_off = time;
  });
  return last_off - 10.0;
}

TEST(HorizonEstimator, FollowsAStepSoonerThanTheKalmanFilterWithTheSameNoise) {
  double ours = 0.0;
  double filters = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Vehicle vehicle = lagging_vehicle(Steering::kAckermann);
    HorizonEstimator rhe = estimator_of(vehicle);
    EkfEstimator ekf(vehicle, {}, kEstimationCycle);
    ours += answer_time(rhe, seed) / 4.0;
    filters += answer_time(ekf, seed) / 4.0;
  }
  RecordProperty("ours_s", std::to_string(ours));
  RecordProperty("filters_s", std::to_string(filters));
  EXPECT_LT(ours, 1.0);  // 0.80 s, and 2.58 s
  EXPECT_GT(filters, 2.5 * ours);
}

TEST(HorizonEstimator, KeepsTheBoundsOfTheSlip) {
  const EstimationConfig bounds;
  for (const NoiseBlocking blocking : kBlockings) {
    SensedDrive drive{.seconds = 6.0};
    drive.slip = [](double) { return Slip{0.75, deg_to_rad(28.0), 0.0}; };
    HorizonEstimator rhe = estimator_of(drive.vehicle, with(blocking));
    const Estimated end = drive.run(rhe, [&](const Estimated& now, double) {
      const Slip& slip = now.estimate.vehicle.slip;
      EXPECT_LE(std::abs(slip.loss_ratio), bounds.most_loss_ratio + 1e-12);
      EXPECT_LE(std::abs(slip.side_rad), deg_to_rad(bounds.most_side_deg) + 1e-12);
      EXPECT_LE(std::abs(slip.steering_offset_rad), deg_to_rad(bounds.most_offset_deg) + 1e-12);
    });
    EXPECT_GT(end.estimate.vehicle.slip.loss_ratio, 0.55);
    EXPECT_LT(off_place(end), 0.3);
  }
}

TEST(HorizonEstimator, LateOnesEndNearlyTheSameAndDoNotLagOnTheWay) {
  SensedDrive drive{.seconds = 10.0};
  drive.slip = [](double) { return kSlip; };
  HorizonEstimator in_time = estimator_of(drive.vehicle);
  const EstimateVector wanted = vector_of(drive.run(in_time).estimate);
  for (const double delay : {0.2, 0.6}) {
    drive.deliver = testing::delayed(delay, 9.5);
    HorizonEstimator late = estimator_of(drive.vehicle);
    double largest = 0.0;
    const Estimated end = drive.run(late, [&](const Estimated& now, double time) {
      if (time > 3.0) largest = std::max(largest, off_place(now));
    });
    EXPECT_LT((vector_of(end.estimate) - wanted).cwiseAbs().maxCoeff(), 0.01) << delay;
    EXPECT_EQ(end.estimate.late_count, 0);
    EXPECT_LT(largest, 0.12) << delay;
  }
}

TEST(HorizonEstimator, BurstsOutOfOrderEqualSortedOnes) {
  SensedDrive drive{.seconds = 8.0};
  drive.deliver = testing::bursts(20, false);
  HorizonEstimator sorted = estimator_of(drive.vehicle);
  const EstimateVector one = vector_of(drive.run(sorted).estimate);
  drive.deliver = testing::bursts(20, true);
  HorizonEstimator reversed = estimator_of(drive.vehicle);
  EXPECT_EQ(vector_of(drive.run(reversed).estimate), one);
}

TEST(HorizonEstimator, ThreeSecondsWithoutPositionsAreBridged) {
  for (const NoiseBlocking blocking : kBlockings) {
    SensedDrive drive{.seconds = 14.0};
    drive.slip = [](double) { return kSlip; };
    drive.deliver = [](std::vector<Measurement> measured, double now) {
      if (now > 8.0 && now < 11.0) {
        std::erase_if(measured, [](const auto& m) { return m.kind == MeasurementKind::kPosition; });
      }
      return measured;
    };
    HorizonEstimator rhe = estimator_of(drive.vehicle, with(blocking));
    const Estimated end = drive.run(rhe, [](const Estimated& now, double time) {
      if (time < 5.0) return;
      EXPECT_LT(off_place(now), time > 8.0 && time < 11.1 ? 0.4 : 0.08) << time;
      const bool coasting = time > 10.05 && time < 10.99;
      if (coasting || time < 9.95 || time > 11.1) {
        EXPECT_EQ(now.estimate.status, coasting ? EstimateStatus::kCoasting : EstimateStatus::kGood)
            << time;
      }
    });
    expect_slip(end.estimate.vehicle.slip, kSlip);
  }
}

TEST(HorizonEstimator, SensorsThatAreMissingAltogetherLeaveAnEstimate) {
  for (int missing = 0; missing < 5; ++missing) {
    SensedDrive drive{.seconds = 8.0};
    drive.deliver = [missing](std::vector<Measurement> measured, double) {
      std::erase_if(measured, [&](const auto& m) { return static_cast<int>(m.kind) == missing; });
      return measured;
    };
    HorizonEstimator rhe = estimator_of(drive.vehicle);
    const Estimated end = drive.run(rhe);
    EXPECT_NE(end.estimate.status, EstimateStatus::kFailed);
    EXPECT_LT(off_place(end), missing == 0 ? 2.0 : 0.08) << missing;
  }
}

TEST(HorizonEstimator, WhatIsNoNumberOrFromTheFutureDoesNotPoisonIt) {
  SensedDrive drive{.seconds = 6.0};
  HorizonEstimator clean = estimator_of(drive.vehicle);
  const EstimateVector wanted = vector_of(drive.run(clean).estimate);
  drive.deliver = [](std::vector<Measurement> measured, double now) {
    measured.push_back({now, MeasurementKind::kPosition, {kNan, 1.0}, 0.01});
    measured.push_back({kNan, MeasurementKind::kHeading, {0.0, 0.0}, 0.01});
    measured.push_back({now, MeasurementKind::kSpeed, {9.0, 0.0}, 0.0});
    measured.push_back({now + 0.5, MeasurementKind::kPosition, {50.0, 50.0}, 0.01});
    return measured;
  };
  HorizonEstimator dirty = estimator_of(drive.vehicle);
  const Estimated end = drive.run(dirty);
  EXPECT_EQ(vector_of(end.estimate), wanted);
  EXPECT_EQ(end.estimate.refused_count, 4 * 300);
  const Estimate bad = dirty.update({}, {kNan, kNan, kNan}, 6.1);
  EXPECT_TRUE(vector_of(bad).allFinite());
  EXPECT_EQ(dirty.update({}, {}, kNan).status, EstimateStatus::kGood);
}

TEST(HorizonEstimator, SurvivesAnAbsurdMeasurement) {
  SensedDrive drive{.seconds = 14.0};
  drive.deliver = [](std::vector<Measurement> measured, double now) {
    if (now > 4.0 && now < 4.019) {
      measured.push_back({now, MeasurementKind::kPosition, {1e200, -1e200}, 1e-3});
    }
    return measured;
  };
  HorizonEstimator rhe = estimator_of(drive.vehicle);
  const Estimated end = drive.run(
      rhe, [](const Estimated& now, double) { EXPECT_TRUE(vector_of(now.estimate).allFinite()); });
  EXPECT_EQ(end.estimate.status, EstimateStatus::kGood);
  EXPECT_LT(off_place(end), 0.1);
}

TEST(HorizonEstimator, DoesNotAllocate) {
  for (const NoiseBlocking blocking : kBlockings) {
    const Vehicle vehicle = lagging_vehicle(Steering::kAckermann);
    HorizonEstimator rhe = estimator_of(vehicle, with(blocking));
    testing::SensedVehicle truth(vehicle, 1);
    rhe.reset({}, 0.0);
    for (int i = 0; i < 250; ++i) {
      const Command command = testing::weave(1.0, truth.time());
      const std::vector<Measurement> measured = truth.step(command, kSlip);
      const long before = testing::allocation_count();
      rhe.update(measured, command, truth.time());
      EXPECT_EQ(testing::allocation_count(), before);
    }
  }
}

TEST(HorizonEstimator, HeadingsGoRoundAndRound) {
  SensedDrive drive{.seconds = 40.0};
  drive.command = [](double) { return Command{1.0, 0.35, 0.0}; };
  HorizonEstimator rhe = estimator_of(drive.vehicle);
  drive.run(rhe, [](const Estimated& now, double time) {
    const double yaw = now.estimate.vehicle.state.pose.yaw;
    EXPECT_LT(std::abs(wrap_angle(yaw - now.truth.pose.yaw)), 0.03) << time;
    EXPECT_LE(std::abs(yaw), kPi);
    EXPECT_LT(off_place(now), 0.08) << time;
  });
}

TEST(HorizonEstimator, StandingForAMinuteForgetsNoSlip) {
  for (const NoiseBlocking blocking : kBlockings) {
    SensedDrive drive{.seconds = 70.0};
    drive.slip = [](double) { return kSlip; };
    drive.command = [](double time) { return time < 10.0 ? testing::weave(1.2, time) : Command{}; };
    HorizonEstimator rhe = estimator_of(drive.vehicle, with(blocking));
    Slip before;
    const Estimated end = drive.run(rhe, [&](const Estimated& now, double time) {
      if (time < 12.0) before = now.estimate.vehicle.slip;
    });
    EXPECT_EQ(end.estimate.status, EstimateStatus::kGood);
    expect_slip(end.estimate.vehicle.slip, kSlip);
    EXPECT_NEAR(end.estimate.vehicle.slip.loss_ratio, before.loss_ratio, 0.01);
    EXPECT_NEAR(end.estimate.vehicle.slip.side_rad, before.side_rad, deg_to_rad(0.5));
    EXPECT_LT(off_place(end), 0.02);
  }
}

TEST(HorizonEstimator, SameMeasurementsSameBytesAlsoAfterAReset) {
  const SensedDrive drive{.seconds = 5.0};
  HorizonEstimator one = estimator_of(drive.vehicle);
  HorizonEstimator other = estimator_of(drive.vehicle);
  const EstimateVector first = vector_of(drive.run(one).estimate);
  EXPECT_EQ(vector_of(drive.run(other).estimate), first);
  EXPECT_EQ(vector_of(drive.run(one).estimate), first);
}

}  // namespace
}  // namespace headland
