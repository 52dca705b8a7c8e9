// SPDX-License-Identifier: Apache-2.0
#include "perception/localization/local_filter.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/perception/localization/driven_vehicle.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

using testing::DrivenVehicle;

const double kNan = std::numeric_limits<double>::quiet_NaN();

MotionIncrement scan_motion(double begin, double end, const Pose2& moved, double deviation) {
  MotionIncrement motion{begin, end, moved, Eigen::Matrix3d::Identity()};
  motion.covariance *= deviation * deviation;
  motion.covariance(2, 2) *= 0.01;
  return motion;
}

TEST(LocalFilter, DerivativesOfMotionAgreeWithDifferences) {
  LocalFilter::Vector state;
  state << 1.0, 2.0, 0.7, 1.3, 0.2, 0.01, 0.02, 0.05, 0.3, -0.2, 0.1;
  LocalFilter::Matrix by_state;
  LocalFilter::moved_on(state, 0.1, 1.0, by_state);
  for (int i = 0; i < LocalFilter::kSize; ++i) {
    LocalFilter::Matrix unused;
    LocalFilter::Vector step = LocalFilter::Vector::Zero();
    step(i) = 1e-6;
    const LocalFilter::Vector difference = (LocalFilter::moved_on(state + step, 0.1, 1.0, unused) -
                                            LocalFilter::moved_on(state - step, 0.1, 1.0, unused)) /
                                           2e-6;
    EXPECT_LT((difference - by_state.col(i)).norm(), 1e-8) << i;
  }
}

TEST(LocalFilter, DerivativesOfRelativePosesAgreeWithDifferences) {
  Eigen::Matrix<double, 6, 1> poses;
  poses << 1.0, -2.0, 0.4, 3.0, 1.0, 1.1;
  Eigen::Matrix<double, 3, 6> by_poses;
  LocalFilter::relative(poses.head<3>(), poses.tail<3>(), by_poses);
  for (int i = 0; i < 6; ++i) {
    Eigen::Matrix<double, 3, 6> unused;
    auto more = poses;
    auto less = poses;
    more(i) += 1e-6;
    less(i) -= 1e-6;
    const Eigen::Vector3d difference =
        (LocalFilter::relative(more.head<3>(), more.tail<3>(), unused) -
         LocalFilter::relative(less.head<3>(), less.tail<3>(), unused)) /
        2e-6;
    EXPECT_LT((difference - by_poses.col(i)).norm(), 1e-8) << i;
  }
}

TEST(LocalFilter, WheelsAndGyroscopeGiveTheMotion) {
  DrivenVehicle vehicle(1);
  vehicle.wheel_scale = 0.0;
  vehicle.gyro_bias = 0.0;
  LocalFilter filter(LocalFilterConfig{});
  const Pose2 start = vehicle.pose();
  for (int i = 0; i < 16000; ++i) {
    vehicle.step();
    filter.add_yaw_rate(vehicle.time(), vehicle.gyro(), vehicle.gyro_noise);
    if (vehicle.every(0.02)) filter.add_speed(vehicle.time(), vehicle.wheel(), vehicle.wheel_noise);
  }
  const Pose2 truth = inverse(start) * vehicle.pose();
  const LocalEstimate estimate = filter.estimate();
  EXPECT_LT((estimate.pose.position() - truth.position()).norm(), 0.01 * vehicle.driven());
  EXPECT_NEAR(estimate.speed, 1.0, 0.05);
  EXPECT_NEAR(estimate.time_s, vehicle.time(), 1e-9);
}

TEST(LocalFilter, ScanMotionsTellScaleAndBias) {
  DrivenVehicle vehicle(2);
  LocalFilter filter(LocalFilterConfig{});
  for (int i = 0; i < 12000; ++i) {
    vehicle.step();
    filter.add_yaw_rate(vehicle.time(), vehicle.gyro(), vehicle.gyro_noise);
    if (vehicle.every(0.02)) filter.add_speed(vehicle.time(), vehicle.wheel(), vehicle.wheel_noise);
    if (vehicle.every(0.1)) filter.add_scan_motion(vehicle.scan_motion());
  }
  const LocalEstimate estimate = filter.estimate();
  EXPECT_NEAR(estimate.wheel_scale, vehicle.wheel_scale, 0.004);
  EXPECT_NEAR(estimate.gyro_bias, vehicle.gyro_bias, 0.001);
}

TEST(LocalFilter, IncrementsAddUpToThePose) {
  DrivenVehicle vehicle(3);
  LocalFilter filter(LocalFilterConfig{});
  Pose2 sum;
  for (int i = 0; i < 3000; ++i) {
    vehicle.step();
    filter.add_yaw_rate(vehicle.time(), vehicle.gyro(), vehicle.gyro_noise);
    filter.add_speed(vehicle.time(), vehicle.wheel(), vehicle.wheel_noise);
    if (!vehicle.every(0.05)) continue;
    const MotionIncrement increment = filter.take_increment(vehicle.time());
    EXPECT_GE(increment.covariance.diagonal().minCoeff(), 0.0);
    sum = sum * increment.moved;
  }
  EXPECT_LT((sum.position() - filter.estimate().pose.position()).norm(), 1e-9);
  EXPECT_NEAR(sum.yaw, filter.estimate().pose.yaw, 1e-9);
}

TEST(LocalFilter, IncrementsNeverJump) {
  DrivenVehicle vehicle(4);
  LocalFilter filter(LocalFilterConfig{});
  for (int i = 0; i < 3000; ++i) {
    vehicle.step();
    filter.add_yaw_rate(vehicle.time(), vehicle.gyro(), vehicle.gyro_noise);
    const bool spins = i > 1000 && i < 1003;  // wheels that spin for three readings
    filter.add_speed(vehicle.time(), spins ? 4.0 : vehicle.wheel(), vehicle.wheel_noise);
    const MotionIncrement increment = filter.take_increment(vehicle.time());
    EXPECT_LT(increment.moved.position().norm(), i > 100 ? 0.03 : 0.1) << i;
  }
}

TEST(LocalFilter, ALateReadingCountsAsIfItHadComeInTime) {
  LocalFilter in_time(LocalFilterConfig{});
  LocalFilter late(LocalFilterConfig{});
  for (int i = 0; i < 100; ++i) {
    const double t = 0.02 * i;
    in_time.add_speed(t, 1.0 + 0.01 * (i % 3), 0.02);
    in_time.add_yaw_rate(t + 0.001, 0.1, 0.002);
    late.add_speed(t, 1.0 + 0.01 * (i % 3), 0.02);
    if (i != 80) late.add_yaw_rate(t + 0.001, 0.1, 0.002);
  }
  EXPECT_NE(in_time.estimate().pose.x, late.estimate().pose.x);
  EXPECT_EQ(late.add_yaw_rate(0.02 * 80 + 0.001, 0.1, 0.002), ReadingOutcome::kUsed);
  EXPECT_EQ(in_time.estimate().pose.x, late.estimate().pose.x);
  EXPECT_EQ(in_time.estimate().pose.yaw, late.estimate().pose.yaw);
}

TEST(LocalFilter, RefusesWhatIsNoReading) {
  LocalFilter filter(LocalFilterConfig{});
  EXPECT_EQ(filter.add_speed(kNan, 1.0, 0.1), ReadingOutcome::kInvalid);
  EXPECT_EQ(filter.add_speed(0.0, kNan, 0.1), ReadingOutcome::kInvalid);
  EXPECT_EQ(filter.add_yaw_rate(0.0, 0.0, kNan), ReadingOutcome::kInvalid);
  EXPECT_EQ(filter.add_scan_motion(scan_motion(1.0, 0.5, {}, 0.01)), ReadingOutcome::kInvalid);
  EXPECT_EQ(filter.add_scan_motion(scan_motion(0.0, 0.1, {}, 0.0)), ReadingOutcome::kInvalid);
  EXPECT_TRUE(std::isnan(filter.estimate().time_s));
  EXPECT_EQ(filter.take_increment(kNan).moved.x, 0.0);
}

TEST(LocalFilter, TimeThatRunsBackwardsIsRefused) {
  LocalFilter filter(LocalFilterConfig{});
  for (int i = 0; i < 300; ++i) filter.add_speed(0.02 * i, 1.0, 0.02);
  const LocalEstimate before = filter.estimate();
  EXPECT_EQ(filter.add_speed(1.0, 1.0, 0.02), ReadingOutcome::kTooOld);
  EXPECT_EQ(filter.estimate().pose.x, before.pose.x);
  filter.take_increment(6.0);
  const MotionIncrement back = filter.take_increment(5.0);
  EXPECT_EQ(back.begin_s, back.end_s);
}

TEST(LocalFilter, WheelsThatKeepDisagreeingAreBelievedAgain) {
  LocalFilter filter(LocalFilterConfig{});
  for (int i = 0; i < 100; ++i) filter.add_speed(0.02 * i, 1.0, 0.02);
  EXPECT_EQ(filter.add_speed(2.0, 3.0, 0.02), ReadingOutcome::kRejected);
  for (int i = 1; i < 20; ++i) filter.add_speed(2.0 + 0.02 * i, 3.0, 0.02);
  EXPECT_NEAR(filter.estimate().speed, 3.0, 0.05);
}

TEST(LocalFilter, DoesNotAllocate) {
  LocalFilter filter(LocalFilterConfig{});
  const long before = testing::allocation_count();
  for (int i = 0; i < 3000; ++i) {
    filter.add_speed(0.02 * i, 1.0, 0.02);
    filter.add_yaw_rate(0.02 * i - 0.05, 0.1, 0.01);
    filter.take_increment(0.02 * i);
  }
  EXPECT_EQ(testing::allocation_count(), before);
}

}  // namespace
}  // namespace headland
