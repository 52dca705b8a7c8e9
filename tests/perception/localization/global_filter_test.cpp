// SPDX-License-Identifier: Apache-2.0
#include "perception/localization/global_filter.hpp"

#include <limits>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/perception/localization/driven_vehicle.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

using testing::DrivenFilters;
using testing::DrivenVehicle;
using testing::start_covariance;

const double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(GlobalFilter, DerivativesAgreeWithDifferences) {
  using Vector = GlobalFilter::Vector;
  GlobalFilter::Matrix by_state;
  GlobalFilter::Matrix unused;
  Eigen::Matrix<double, 6, 3> by_moved;
  Eigen::Matrix<double, 6, 3> unused_moved;
  Vector state;
  state << 4.0, -3.0, 1.2, 0.02, 0.01, 0.05;
  const Eigen::Vector3d moved{0.3, 0.02, 0.1};
  const Point2 arm{0.4, -0.3};
  GlobalFilter::moved_on(state, moved, 0.2, by_state, by_moved);
  Eigen::Matrix<double, 2, 6> by_antenna;
  Eigen::Matrix<double, 2, 6> unused_antenna;
  GlobalFilter::antenna(state, arm, by_antenna);
  const double h = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vector step = h * Vector::Unit(i);
    const Vector difference =
        (GlobalFilter::moved_on(state + step, moved, 0.2, unused, unused_moved) -
         GlobalFilter::moved_on(state - step, moved, 0.2, unused, unused_moved)) /
        (2.0 * h);
    EXPECT_LT((difference - by_state.col(i)).norm(), 1e-8) << i;
    const Point2 antenna = (GlobalFilter::antenna(state + step, arm, unused_antenna) -
                            GlobalFilter::antenna(state - step, arm, unused_antenna)) /
                           (2.0 * h);
    EXPECT_LT((antenna - by_antenna.col(i)).norm(), 1e-8) << i;
  }
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
    const Vector difference =
        (GlobalFilter::moved_on(state, moved + step, 0.2, unused, unused_moved) -
         GlobalFilter::moved_on(state, moved - step, 0.2, unused, unused_moved)) /
        (2.0 * h);
    EXPECT_LT((difference - by_moved.col(i)).norm(), 1e-8) << i;
  }
}

// RMS of the position over four rows, with a share of wrong fixes.
double rms_with_outliers(double share, double deviation, FixQuality quality) {
  DrivenVehicle vehicle(11);
  RandomStream outliers(5, "outliers");
  DrivenFilters filters;
  filters.global.start(0.0, vehicle.pose(), start_covariance());
  double squares = 0.0;
  int count = 0;
  while (vehicle.driven() < 540.0) {
    filters.tick(vehicle);
    if (vehicle.every(0.2)) {
      Measurement fix = vehicle.fix(deviation, quality);
      const double off = outliers.uniform(5.0, 40.0);
      const double towards = outliers.uniform(-kPi, kPi);
      if (outliers.uniform() < share) {
        fix.value[0] += off * std::cos(towards);
        fix.value[1] += off * std::sin(towards);
      }
      filters.global.add(fix);
    }
    if (vehicle.every(1.0)) filters.global.add(vehicle.heading(deg_to_rad(0.6)));
    if (vehicle.driven() > 20.0 && vehicle.every(0.05)) {
      squares += std::pow(filters.error(vehicle), 2);
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

TEST(GlobalFilter, AFifthOfWrongFixesRaisesTheErrorByLessThanATenth) {
  const double clean = rms_with_outliers(0.0, 0.02, FixQuality::kFixed);
  const double dirty = rms_with_outliers(0.2, 0.02, FixQuality::kFixed);
  RecordProperty("clean_mm", static_cast<int>(clean * 1000.0));
  EXPECT_LT(clean, 0.02);
  EXPECT_LT(dirty, 1.1 * clean) << clean;
}

TEST(GlobalFilter, AFifthOfWrongFixesAmongFloatOnesRaisesTheErrorByLessThanAQuarter) {
  const double clean = rms_with_outliers(0.0, 0.3, FixQuality::kFloat);
  const double dirty = rms_with_outliers(0.2, 0.3, FixQuality::kFloat);
  EXPECT_LT(clean, 0.2);
  EXPECT_LT(dirty, 1.25 * clean) << clean;
}

TEST(GlobalFilter, AnOutageInARowDriftsLittleAndIsRecoveredFrom) {
  for (const std::uint64_t seed : {21u, 22u, 23u, 24u, 25u}) {
    DrivenVehicle vehicle(seed);
    DrivenFilters filters;
    filters.scans = true;
    filters.global.start(0.0, vehicle.pose(), start_covariance());
    double worst = 0.0;
    double recovered = 0.0;
    while (vehicle.time() < 280.0) {
      filters.tick(vehicle);
      const bool outage = vehicle.time() > 230.0 && vehicle.time() <= 260.0;
      if (!outage && vehicle.every(0.2)) filters.global.add(vehicle.fix(0.02));
      if (!outage && vehicle.every(0.2)) filters.global.add(vehicle.heading(deg_to_rad(0.6)));
      if (outage && vehicle.every(0.05)) worst = std::max(worst, filters.error(vehicle));
      if (vehicle.time() > 262.0 && vehicle.every(0.05))
        recovered = std::max(recovered, filters.error(vehicle));
      if (vehicle.time() > 250.0 && outage) {
        EXPECT_EQ(filters.global.estimate().health.state, PoseState::kCoasting);
      }
    }
    EXPECT_LT(worst, 0.005 * 30.0) << seed;
    EXPECT_LT(recovered, 0.08) << seed;
    EXPECT_EQ(filters.global.estimate().health.state, PoseState::kGood);
  }
}

TEST(GlobalFilter, LearnsWhatTheOdometryGetsWrong) {
  DrivenVehicle vehicle(31);
  DrivenFilters filters;
  filters.global.start(0.0, vehicle.pose(), start_covariance());
  while (vehicle.driven() < 270.0) {
    filters.tick(vehicle);
    if (vehicle.every(0.2)) filters.global.add(vehicle.fix(0.02));
  }
  const GlobalEstimate estimate = filters.global.estimate();
  const double wheels = 1.0 - filters.local.estimate().wheel_scale;
  EXPECT_NEAR((1.0 + vehicle.wheel_scale) * wheels * (1.0 + estimate.odometry_scale), 1.0, 0.003);
  EXPECT_NEAR(filters.local.estimate().gyro_bias + estimate.odometry_turning, vehicle.gyro_bias,
              0.0005);
}

TEST(GlobalFilter, FixesThatAgreeReanchorIt) {
  DrivenVehicle vehicle(41);
  DrivenFilters filters;
  Pose2 wrong = vehicle.pose();
  wrong.x += 8.0;
  filters.global.start(0.0, wrong, start_covariance());
  int rejected = 0;
  bool anchored = false;
  while (vehicle.time() < 5.0) {
    filters.tick(vehicle);
    if (!vehicle.every(0.2)) continue;
    const ReadingOutcome outcome = filters.global.add(vehicle.fix(0.02));
    rejected += outcome == ReadingOutcome::kRejected;
    if (outcome == ReadingOutcome::kReanchored) {
      anchored = true;
      EXPECT_EQ(filters.global.estimate().health.reason, PoseReason::kReanchored);
    }
  }
  EXPECT_GE(rejected, 4);
  EXPECT_TRUE(anchored);
  EXPECT_LT(filters.error(vehicle), 0.1);
}

TEST(GlobalFilter, StartsFromFixesAloneOnceTheWayTellsTheHeading) {
  DrivenVehicle vehicle(51);
  DrivenFilters filters;
  EXPECT_EQ(filters.global.estimate().health.reason, PoseReason::kNoFix);
  double started_at = 0.0;
  while (vehicle.driven() < 60.0) {
    filters.tick(vehicle);
    if (!vehicle.every(0.2)) continue;
    Measurement fix = vehicle.fix(0.3, FixQuality::kFloat);
    if (vehicle.every(1.4)) fix.value[1] += 20.0;  // every seventh is wrong
    filters.global.add(fix);
    if (!filters.global.started()) {
      EXPECT_EQ(filters.global.estimate().health.reason, PoseReason::kNoHeading);
    } else if (started_at == 0.0) {
      started_at = vehicle.driven();
      EXPECT_LT(std::abs(wrap_angle(filters.global.estimate().pose.yaw - vehicle.pose().yaw)),
                deg_to_rad(20.0));
    }
  }
  EXPECT_GT(started_at, 1.0);
  EXPECT_LT(started_at, 20.0);
  EXPECT_LT(filters.error(vehicle), 0.5);
}

TEST(GlobalFilter, StartsFromAHeadingAndAPositionOfTheAntenna) {
  GlobalFilterConfig config;
  config.antenna_x_m = 1.0;
  config.antenna_y_m = 0.5;
  config.baseline_m = 1.0;
  GlobalFilter filter(config);
  Measurement heading{0.0, MeasurementKind::kHeading, {kPi / 2.0, 1.2}, 0.01};
  EXPECT_EQ(filter.add(heading), ReadingOutcome::kWrongBaseline);
  heading.value[1] = 1.01;
  EXPECT_EQ(filter.add(heading), ReadingOutcome::kWaiting);
  filter.add({0.1, MeasurementKind::kPosition, {10.0, 20.0}, 0.02});
  ASSERT_TRUE(filter.started());
  EXPECT_NEAR(filter.estimate().pose.x, 10.5, 1e-9);
  EXPECT_NEAR(filter.estimate().pose.y, 19.0, 1e-9);
}

TEST(GlobalFilter, ALateFixCountsAsIfItHadComeInTime) {
  DrivenFilters in_time;
  DrivenFilters late;
  in_time.global.start(0.0, {}, start_covariance());
  late.global.start(0.0, {}, start_covariance());
  Measurement under_way{};
  for (int i = 1; i <= 200; ++i) {
    const MotionIncrement increment{
        0.05 * (i - 1), 0.05 * i, {0.05, 0.0, 0.0}, 1e-6 * Eigen::Matrix3d::Identity()};
    in_time.global.add_increment(increment);
    late.global.add_increment(increment);
    if (i % 20 == 0) {
      under_way = {0.05 * i, MeasurementKind::kPosition, {0.0501 * i, 0.03}, 0.05};
      in_time.global.add(under_way);
    }
    if (i % 20 == 10 && i > 20) late.global.add(under_way);  // half a second late
  }
  EXPECT_NE(in_time.global.estimate().pose.x, late.global.estimate().pose.x);
  late.global.add(under_way);
  EXPECT_EQ(in_time.global.estimate().pose.x, late.global.estimate().pose.x);
  EXPECT_EQ(in_time.global.estimate().covariance(0, 0), late.global.estimate().covariance(0, 0));
  under_way.time = 5.0;
  EXPECT_EQ(late.global.add(under_way), ReadingOutcome::kTooOld);
}

TEST(GlobalFilter, AFrozenReceiverIsNotBelieved) {
  DrivenVehicle vehicle(71);
  DrivenFilters filters;
  filters.global.start(0.0, vehicle.pose(), start_covariance());
  Measurement frozen{};
  ReadingOutcome last = ReadingOutcome::kUsed;
  while (vehicle.driven() < 110.0) {
    filters.tick(vehicle);
    if (!vehicle.every(0.2)) continue;
    if (vehicle.driven() < 80.0) frozen = vehicle.fix(0.02);
    frozen.time = vehicle.time();
    last = filters.global.add(frozen);
  }
  EXPECT_EQ(last, ReadingOutcome::kFrozen);
  EXPECT_EQ(filters.global.estimate().health.reason, PoseReason::kFixesFrozen);
  EXPECT_EQ(filters.global.estimate().health.state, PoseState::kCoasting);
  EXPECT_LT(filters.error(vehicle), 0.3);
}

TEST(GlobalFilter, TheCovarianceIsHonest) {
  // Normalised squared error of x and y over many runs: 2 on average if the covariance is right.
  double sum = 0.0;
  int count = 0;
  for (std::uint64_t seed = 100; seed < 120; ++seed) {
    DrivenVehicle vehicle(seed);
    DrivenFilters filters;
    filters.global.start(0.0, vehicle.pose(), start_covariance());
    while (vehicle.driven() < 60.0) {
      filters.tick(vehicle);
      if (vehicle.every(0.2)) filters.global.add(vehicle.fix(0.02));
    }
    const GlobalEstimate estimate = filters.global.estimate();
    const Eigen::Vector2d off = estimate.pose.position() - vehicle.pose().position();
    const Eigen::Matrix2d spread = estimate.covariance.topLeftCorner<2, 2>();
    sum += off.dot(spread.inverse() * off);
    ++count;
  }
  EXPECT_GT(sum / count, 0.5);
  EXPECT_LT(sum / count, 4.0);
}

TEST(GlobalFilter, RefusesWhatIsNoReading) {
  GlobalFilter filter(GlobalFilterConfig{});
  filter.start(0.0, {}, start_covariance());
  EXPECT_EQ(filter.add({0.0, MeasurementKind::kPosition, {kNan, 0.0}, 0.1}),
            ReadingOutcome::kInvalid);
  EXPECT_EQ(filter.add({kNan, MeasurementKind::kPosition, {0.0, 0.0}, 0.1}),
            ReadingOutcome::kInvalid);
  EXPECT_EQ(filter.add({0.0, MeasurementKind::kSpeed, {0.0, 0.0}, 0.1}), ReadingOutcome::kInvalid);
  MotionIncrement backwards;
  backwards.begin_s = 1.0;
  backwards.end_s = 0.5;
  EXPECT_EQ(filter.add_increment(backwards), ReadingOutcome::kInvalid);
  EXPECT_EQ(filter.estimate().pose.x, 0.0);
}

TEST(GlobalFilter, IsLostWhenItKnowsTooLittle) {
  DrivenVehicle vehicle(81);
  DrivenFilters filters;
  filters.global.start(0.0, vehicle.pose(), start_covariance());
  while (vehicle.driven() < 400.0) filters.tick(vehicle);
  EXPECT_EQ(filters.global.estimate().health.state, PoseState::kLost);
  EXPECT_EQ(filters.global.estimate().health.reason, PoseReason::kUncertain);
}

TEST(GlobalFilter, DoesNotAllocate) {
  GlobalFilter filter(GlobalFilterConfig{});
  filter.start(0.0, {}, start_covariance());
  const long before = testing::allocation_count();
  for (int i = 1; i < 1000; ++i) {
    filter.add_increment({0.05 * (i - 1), 0.05 * i, {0.05, 0.0, 0.0}, Eigen::Matrix3d::Zero()});
    filter.add({0.05 * i - 0.2, MeasurementKind::kPosition, {0.05 * i - 0.2, 0.001 * i}, 0.05});
  }
  EXPECT_EQ(testing::allocation_count(), before);
}

}  // namespace
}  // namespace headland
