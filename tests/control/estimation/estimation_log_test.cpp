// SPDX-License-Identifier: Apache-2.0
#include "control/estimation/estimation_log.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/control/estimation/sensed_vehicle.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

using testing::lagging_vehicle;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Measurement speed_at(double time, double value = 1.0) {
  return {time, MeasurementKind::kSpeed, {value, 0.0}, 0.1};
}

EstimationLog log_at(double now) {
  EstimationLog log(lagging_vehicle(Steering::kAckermann), 0.02, 1.0);
  log.reset(now);
  return log;
}

TEST(EstimationLog, SortsByTimeAndKeepsTheOrderOfOneTime) {
  EstimationLog log = log_at(10.0);
  log.take(std::vector{speed_at(10.3), speed_at(10.1, 1.0)}, {}, 10.4);
  log.take(std::vector{speed_at(10.2), speed_at(10.1, 2.0)}, {}, 10.5);
  ASSERT_EQ(log.measurements().size(), 4U);
  EXPECT_EQ(log.measurements()[0].value[0], 1.0);
  EXPECT_EQ(log.measurements()[1].value[0], 2.0);
  EXPECT_EQ(log.measurements()[2].time, 10.2);
  EXPECT_EQ(log.measurements()[3].time, 10.3);
}

TEST(EstimationLog, RefusesTheFutureAndWhatIsNoNumber) {
  EstimationLog log = log_at(0.0);
  std::vector<Measurement> bad{speed_at(0.2001),     speed_at(kNan),      speed_at(kInfinity),
                               speed_at(-kInfinity), speed_at(0.1, kNan), speed_at(0.1, kInfinity)};
  for (const double deviation : {0.0, -0.1, kNan, kInfinity}) {
    bad.push_back(speed_at(0.1));
    bad.back().deviation = deviation;
  }
  log.take(bad, {}, 0.2);
  EXPECT_EQ(log.measurements().size(), 0U);
  EXPECT_EQ(log.refused_count(), static_cast<int>(bad.size()));
  EXPECT_EQ(log.late_count(), 0);
  log.take(std::vector{speed_at(0.2)}, {}, 0.2);  // of this very moment
  EXPECT_EQ(log.measurements().size(), 1U);
}

TEST(EstimationLog, CountsWhatIsOlderThanItsBase) {
  EstimationLog log = log_at(0.0);
  log.take(std::vector{speed_at(0.1), speed_at(0.3)}, {}, 0.6);
  log.forget_before(10);
  EXPECT_EQ(log.measurements().size(), 1U);
  log.take(std::vector{speed_at(0.19), speed_at(0.2), speed_at(0.21)}, {}, 0.62);
  EXPECT_EQ(log.late_count(), 1);
  EXPECT_EQ(log.measurements().size(), 3U);
  log.reset(5.0);
  EXPECT_EQ(log.late_count(), 0);  // counts are since the start
  EXPECT_EQ(log.refused_count(), 0);
  EXPECT_EQ(log.measurements().size(), 0U);
}

TEST(EstimationLog, CommandsActAfterTheirDeadTime) {
  EstimationLog log = log_at(0.0);
  log.take({}, {1.0, 0.2, 0.0}, 0.02);
  log.take({}, {2.0, 0.3, 0.0}, 0.1);  // four cycles at once
  EXPECT_EQ(log.now(), 5);
  EXPECT_EQ(log.acting(0).speed, 1.0);
  EXPECT_EQ(log.acting(1).speed, 2.0);
  EXPECT_EQ(log.acting(2).steering, 0.0);  // three cycles of dead time
  EXPECT_EQ(log.acting(3).steering, 0.2);
  EXPECT_EQ(log.acting(4).steering, 0.3);
}

TEST(EstimationLog, ACommandOrATimeThatIsNoNumberChangesNothing) {
  EstimationLog log = log_at(0.0);
  log.take({}, {1.0, 0.2, 0.0}, 0.1);
  log.take({}, {kNan, kNan, kNan}, 0.2);
  for (long cycle = 0; cycle < log.now(); ++cycle) {
    EXPECT_TRUE(std::isfinite(log.acting(cycle).speed));
    EXPECT_TRUE(std::isfinite(log.acting(cycle).steering));
  }
  for (const double now : {kNan, kInfinity, 0.1}) {  // the last goes back
    log.take(std::vector{speed_at(0.15), speed_at(5.0)}, {}, now);
    EXPECT_EQ(log.now(), 10);
  }
  EXPECT_EQ(log.measurements().size(), 3U);
  EXPECT_EQ(log.refused_count(), 3);
}

TEST(EstimationLog, ReplaysEveryMeasurementAtItsTime) {
  const EstimationModel model(lagging_vehicle(Steering::kAckermann), {});
  EstimationLog log = log_at(0.0);
  log.take(std::vector{speed_at(0.03), speed_at(0.02), speed_at(0.0)}, {1.0, 0.0, 0.0}, 0.06);
  KalmanFilter replayed(model);
  replayed.reset(EstimateVector::Zero(), model.first_covariance());
  KalmanFilter by_hand = replayed;
  log.replay(replayed, log.now());
  const Command acting{1.0, 0.0, 0.0};
  by_hand.update(speed_at(0.0));
  by_hand.predict(acting, 0.02);
  by_hand.update(speed_at(0.02));
  by_hand.predict(acting, 0.01);
  by_hand.update(speed_at(0.03));
  by_hand.predict(acting, 0.01);
  by_hand.predict(acting, 0.02);
  EXPECT_LT((replayed.state() - by_hand.state()).norm(), 1e-12);
  EXPECT_LT((replayed.covariance() - by_hand.covariance()).norm(), 1e-12);
}

TEST(EstimationLog, AFloodNeitherAllocatesNorLosesTheNewest) {
  EstimationLog log = log_at(0.0);
  const std::vector<Measurement> many(1000, speed_at(0.5));
  const long before = testing::allocation_count();
  for (int i = 0; i < 40; ++i) log.take(many, {}, 0.5);
  log.take(std::span(many).first(1), {}, 0.9);
  EXPECT_EQ(testing::allocation_count(), before);
  EXPECT_EQ(log.measurements().back().time, 0.5);
  EXPECT_EQ(static_cast<int>(log.measurements().size()) + log.late_count(), 40001);
}

}  // namespace
}  // namespace headland
