// SPDX-License-Identifier: Apache-2.0
#include "control/estimation/ekf_estimator.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/control/estimation/sensed_vehicle.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

using testing::Estimated;
using testing::kEstimationCycle;
using testing::lagging_vehicle;
using testing::SensedDrive;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Slip kSlip{0.1, deg_to_rad(3.0), deg_to_rad(2.0)};

EkfEstimator estimator_of(const Vehicle& vehicle) {
  return EkfEstimator(vehicle, {}, kEstimationCycle);
}

EstimateVector vector_of(const Estimate& estimate) {
  EstimateVector v;
  v << estimate.vehicle.state.pose.x, estimate.vehicle.state.pose.y,
      estimate.vehicle.state.pose.yaw, estimate.vehicle.state.speed,
      estimate.vehicle.state.steering + estimate.vehicle.state.yaw_rate,
      estimate.vehicle.slip.loss_ratio, estimate.vehicle.slip.side_rad,
      estimate.vehicle.slip.steering_offset_rad;
  return v;
}

TEST(EkfEstimator, FindsTheSlipOfBothKindsInBothGears) {
  for (const Steering steering : {Steering::kAckermann, Steering::kDifferential}) {
    for (const double speed : {1.2, -1.2}) {
      SensedDrive drive{.vehicle = lagging_vehicle(steering), .speed = speed};
      drive.slip = [](double) { return kSlip; };
      EkfEstimator ekf = estimator_of(drive.vehicle);
      const Estimated end = drive.run(ekf);
      const Slip& slip = end.estimate.vehicle.slip;
      EXPECT_EQ(end.estimate.status, EstimateStatus::kGood);
      EXPECT_NEAR(slip.loss_ratio, kSlip.loss_ratio, 0.02);
      EXPECT_NEAR(slip.side_rad, kSlip.side_rad, deg_to_rad(0.8));
      EXPECT_NEAR(slip.steering_offset_rad, kSlip.steering_offset_rad, deg_to_rad(0.5));
      const VehicleState& state = end.estimate.vehicle.state;
      EXPECT_LT((state.pose.position() - end.truth.pose.position()).norm(), 0.02);
      EXPECT_NEAR(state.pose.yaw, end.truth.pose.yaw, deg_to_rad(0.5));
    }
  }
}

TEST(EkfEstimator, LateMeasurementsEndInTheSameEstimate) {
  SensedDrive drive{.seconds = 10.0};
  EkfEstimator ekf = estimator_of(drive.vehicle);
  const EstimateVector in_time = vector_of(drive.run(ekf).estimate);
  drive.deliver = testing::delayed(0.2, drive.seconds);
  double largest = 0.0;
  EkfEstimator late = estimator_of(drive.vehicle);
  const Estimated end = drive.run(late, [&](const Estimated& now, double) {
    largest = std::max(
        largest, (now.estimate.vehicle.state.pose.position() - now.truth.pose.position()).norm());
  });
  EXPECT_LT((vector_of(end.estimate) - in_time).norm(), 1e-9);
  EXPECT_EQ(end.estimate.late_count, 0);
  EXPECT_LT(largest, 0.1);  // and on the way it did not lag 0.2 s, 24 cm, behind
}

TEST(EkfEstimator, BurstsOutOfOrderEqualSortedOnes) {
  SensedDrive drive{.seconds = 10.0};
  EkfEstimator sorted = estimator_of(drive.vehicle);
  EkfEstimator reversed = estimator_of(drive.vehicle);
  drive.deliver = testing::bursts(20, false);
  const EstimateVector one = vector_of(drive.run(sorted).estimate);
  drive.deliver = testing::bursts(20, true);
  const EstimateVector other = vector_of(drive.run(reversed).estimate);
  EXPECT_EQ(one, other);
}

TEST(EkfEstimator, CountsTooLateAndRefusedOnesAndGoesOnWithoutThem) {
  SensedDrive drive{.seconds = 10.0};
  EkfEstimator clean = estimator_of(drive.vehicle);
  const EstimateVector wanted = vector_of(drive.run(clean).estimate);
  drive.deliver = [](std::vector<Measurement> measured, double now) {
    if (now < 1.0) return measured;
    measured.push_back({now - 0.6, MeasurementKind::kPosition, {50.0, 50.0}, 0.01});
    measured.push_back({now + 0.1, MeasurementKind::kPosition, {50.0, 50.0}, 0.01});
    measured.push_back({now, MeasurementKind::kPosition, {kNan, 50.0}, 0.01});
    return measured;
  };
  EkfEstimator dirty = estimator_of(drive.vehicle);
  const Estimate end = drive.run(dirty).estimate;
  EXPECT_EQ(vector_of(end), wanted);
  EXPECT_NEAR(end.late_count, 451, 1);
  EXPECT_NEAR(end.refused_count, 902, 2);
}

TEST(EkfEstimator, CoastsWithoutPositionsAndRecovers) {
  SensedDrive drive{.seconds = 15.0};
  drive.deliver = [](const std::vector<Measurement>& measured, double now) {
    std::vector<Measurement> out;
    for (const Measurement& m : measured) {
      const bool outage = now > 5.0 && now < 10.0;
      if (!outage || m.kind != MeasurementKind::kPosition) out.push_back(m);
    }
    return out;
  };
  EkfEstimator ekf = estimator_of(drive.vehicle);
  drive.run(ekf, [](const Estimated& now, double time) {
    const bool coasting = time > 7.05 && time < 9.95;
    const bool good = time < 6.95 || time > 10.15;
    if (coasting || good) {
      EXPECT_EQ(now.estimate.status, coasting ? EstimateStatus::kCoasting : EstimateStatus::kGood)
          << time;
    }
    const double off =
        (now.estimate.vehicle.state.pose.position() - now.truth.pose.position()).norm();
    EXPECT_LT(off, time > 5.0 && time < 10.2 ? 0.4 : 0.06) << time;
    EXPECT_LT(off, 4.0 * now.estimate.deviation.head<2>().norm() + 0.01) << time;
  });
}

TEST(EkfEstimator, DoesNotAllocate) {
  SensedDrive drive;
  EkfEstimator ekf = estimator_of(drive.vehicle);
  testing::SensedVehicle truth(drive.vehicle, 1);
  ekf.reset({}, 0.0);
  for (int i = 0; i < 300; ++i) {
    const Command command = testing::weave(1.0, truth.time());
    const std::vector<Measurement> measured = truth.step(command, kSlip);
    const long before = testing::allocation_count();
    ekf.update(measured, command, truth.time());
    EXPECT_EQ(testing::allocation_count(), before);
  }
}

TEST(EkfEstimator, HeadingsGoRoundAndRound) {
  SensedDrive drive{.seconds = 60.0};
  drive.command = [](double) { return Command{1.0, 0.3, 0.0}; };
  EkfEstimator ekf = estimator_of(drive.vehicle);
  drive.run(ekf, [](const Estimated& now, double time) {
    const double yaw = now.estimate.vehicle.state.pose.yaw;
    EXPECT_LT(std::abs(wrap_angle(yaw - now.truth.pose.yaw)), 0.03) << time;
    EXPECT_LE(std::abs(yaw), kPi);
  });
}

TEST(EkfEstimator, ACommandThatIsNoNumberDoesNotPoisonIt) {
  SensedDrive drive{.seconds = 5.0};
  EkfEstimator ekf = estimator_of(drive.vehicle);
  const Estimated before = drive.run(ekf);
  const Estimate bad = ekf.update({}, {kNan, kNan, kNan}, drive.seconds + kEstimationCycle);
  EXPECT_TRUE(vector_of(bad).allFinite());
  const Estimate after = ekf.update({}, {}, drive.seconds + 2.0 * kEstimationCycle);
  EXPECT_EQ(after.status, EstimateStatus::kGood);
  EXPECT_LT((vector_of(after) - vector_of(before.estimate)).norm(), 0.1);
}

TEST(EkfEstimator, SameMeasurementsSameBytes) {
  const SensedDrive drive{.seconds = 5.0};
  EkfEstimator one = estimator_of(drive.vehicle);
  EkfEstimator other = estimator_of(drive.vehicle);
  EXPECT_EQ(vector_of(drive.run(one).estimate), vector_of(drive.run(other).estimate));
  EXPECT_EQ(vector_of(drive.run(one).estimate), vector_of(drive.run(other).estimate));
}

}  // namespace
}  // namespace headland
