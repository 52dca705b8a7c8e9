// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors.hpp"

#include <cmath>
#include <functional>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "core/config/yaml.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

constexpr double kTick = 0.01;

Vehicle vehicle_of(Steering steering) {
  Vehicle vehicle;
  vehicle.steering = steering;
  vehicle.track_width_m = 1.25;
  return vehicle;
}

VehicleState truth_at(double now) { return {{10.0 + now, -2.0 * now, 0.5}, 1.5, 0.2, 0.3}; }
constexpr double kYawRate = 0.4;

using Readings = std::map<MeasurementKind, std::vector<Measurement>>;

// What arrives in so many ticks, by kind; `look(now, reading)` sees each as it comes.
Readings sensed(Sensors& sensors, int ticks,
                const std::function<void(double, const Measurement&)>& look = {}) {
  Readings all;
  for (int i = 0; i < ticks; ++i) {
    const double now = i * kTick;
    for (const Measurement& m : sensors.sense(truth_at(now), kYawRate, now)) {
      all[m.kind].push_back(m);
      if (look) look(now, m);
    }
  }
  return all;
}

struct Moments {
  double mean = 0.0;
  double deviation = 0.0;
};
Moments moments(const std::vector<Measurement>& readings,
                const std::function<double(const Measurement&)>& error) {
  Moments m;
  double square = 0.0;
  const auto n = static_cast<double>(readings.size());
  for (const Measurement& reading : readings) {
    m.mean += error(reading) / n;
    square += error(reading) * error(reading) / n;
  }
  m.deviation = std::sqrt(square - m.mean * m.mean);
  return m;
}

std::string read_error(const std::string& text) {
  SensorConfig config;
  const auto ok = config::read_into(*config::Node::parse(text, "f"), config);
  return ok ? "" : ok.error().where.key;
}

TEST(Sensors, WithoutErrorsTellTheTruthAtEveryTickWithAFloorOfDeviation) {
  for (const Steering steering : {Steering::kAckermann, Steering::kDifferential}) {
    Sensors sensors(vehicle_of(steering), {}, 1);
    int count = 0;
    sensed(sensors, 100, [&](double now, const Measurement& m) {
      const VehicleState truth = truth_at(now);
      const double turn = steering == Steering::kAckermann ? truth.steering : truth.yaw_rate;
      const std::map<MeasurementKind, double> expected{{MeasurementKind::kPosition, truth.pose.x},
                                                       {MeasurementKind::kHeading, truth.pose.yaw},
                                                       {MeasurementKind::kSpeed, truth.speed},
                                                       {MeasurementKind::kTurn, turn},
                                                       {MeasurementKind::kYawRate, kYawRate}};
      EXPECT_EQ(m.value[0], expected.at(m.kind));
      if (m.kind == MeasurementKind::kPosition) {
        EXPECT_EQ(m.value[1], truth.pose.y);
      }
      EXPECT_EQ(m.time, now);
      EXPECT_EQ(m.deviation, Sensors::kLeastDeviation);
      ++count;
    });
    EXPECT_EQ(count, 500);
  }
}

TEST(Sensors, NoisesHaveTheDeviationThatComesWithThem) {
  SensorConfig config;
  config.position_accuracy_m = 0.03;
  config.gnss.noise_m = 0.02;
  config.heading_noise_deg = 0.3;
  config.heading.noise_deg = 0.4;
  config.wheel.noise_mps = 0.05;
  config.wheel.scale_error_ratio = 0.1;
  config.steering.noise_deg = 0.7;
  config.imu.noise_radps = 0.01;
  config.imu.bias_radps = -0.02;
  const double position = std::sqrt(0.03 * 0.03 / 3.0 + 0.02 * 0.02);
  for (const Steering steering : {Steering::kAckermann, Steering::kDifferential}) {
    const bool ackermann = steering == Steering::kAckermann;
    Sensors sensors(vehicle_of(steering), config, 5);
    const Readings all = sensed(sensors, 40000);
    const auto check = [&](MeasurementKind kind, double bias, double deviation, auto error) {
      const auto& readings = all.at(kind);
      const Moments m = moments(readings, error);
      EXPECT_NEAR(m.mean, bias, 4.0 * deviation / 200.0) << static_cast<int>(kind);
      EXPECT_NEAR(m.deviation, deviation, 0.02 * deviation) << static_cast<int>(kind);
      EXPECT_NEAR(readings.front().deviation, deviation, 1e-12) << static_cast<int>(kind);
    };
    const auto less = [](double truth) {
      return [truth](const Measurement& m) { return m.value[0] - truth; };
    };
    check(MeasurementKind::kPosition, 0.0, position,
          [](const Measurement& m) { return m.value[0] - 10.0 - m.time; });
    check(MeasurementKind::kPosition, 0.0, position,
          [](const Measurement& m) { return m.value[1] + 2.0 * m.time; });
    check(MeasurementKind::kHeading, 0.0, deg_to_rad(0.5), less(0.5));
    check(MeasurementKind::kSpeed, 0.15, 0.05, less(1.5));
    check(MeasurementKind::kTurn, ackermann ? 0.0 : 0.03,
          ackermann ? deg_to_rad(0.7) : 2.0 * 0.05 / 1.25, less(ackermann ? 0.2 : 0.3));
    check(MeasurementKind::kYawRate, -0.02, 0.01, less(kYawRate));
  }
}

TEST(Sensors, UniformFixesStayWithinTheirAccuracy) {
  SensorConfig config;
  config.position_accuracy_m = 0.05;
  Sensors sensors(vehicle_of(Steering::kAckermann), config, 1);
  double worst = 0.0;
  sensed(sensors, 10000, [&](double now, const Measurement& m) {
    if (m.kind != MeasurementKind::kPosition) return;
    worst = std::max(worst, std::abs(m.value[0] - truth_at(now).pose.x));
    EXPECT_EQ(m.deviation, 0.05 / std::sqrt(3.0));
  });
  EXPECT_LE(worst, 0.05 + 1e-9);
  EXPECT_GT(worst, 0.0499);
}

TEST(Sensors, ReadAtTheirRateAndArriveAfterTheirLatency) {
  SensorConfig config;
  config.gnss.rate_hz = 5.0;
  config.gnss.latency_s = 0.12;
  config.heading.rate_hz = 3.0;  // no whole number of ticks
  config.imu.latency_s = 1.0;    // many under way
  config.steering.enabled = false;
  Sensors sensors(vehicle_of(Steering::kAckermann), config, 1);
  const Readings all = sensed(sensors, 1001, [](double now, const Measurement& m) {
    double late = 0.0;
    if (m.kind == MeasurementKind::kPosition) late = 0.12;
    if (m.kind == MeasurementKind::kYawRate) late = 1.0;
    EXPECT_NEAR(now - m.time, late, 1e-9);
    if (m.kind == MeasurementKind::kPosition) {
      EXPECT_EQ(m.value[0], truth_at(m.time).pose.x);
    }
  });
  const auto& positions = all.at(MeasurementKind::kPosition);
  ASSERT_EQ(positions.size(), 50u);  // the one of 10 s is under way
  for (std::size_t i = 0; i < positions.size(); ++i) {
    EXPECT_NEAR(positions[i].time, 0.2 * static_cast<double>(i), 1e-9);
  }
  const auto& headings = all.at(MeasurementKind::kHeading);
  ASSERT_EQ(headings.size(), 31u);
  for (std::size_t i = 0; i < headings.size(); ++i) {
    const double due = static_cast<double>(i) / 3.0;
    EXPECT_GE(headings[i].time, due - 1e-9);
    EXPECT_LT(headings[i].time, due + kTick);
  }
  EXPECT_EQ(all.at(MeasurementKind::kSpeed).size(), 1001u);
  EXPECT_EQ(all.at(MeasurementKind::kYawRate).size(), 901u);
  EXPECT_EQ(all.count(MeasurementKind::kTurn), 0u);
}

TEST(Sensors, WhatWasUnderWayInABreakArrivesAfterIt) {
  SensorConfig config;
  config.gnss.rate_hz = 10.0;
  config.gnss.latency_s = 0.05;
  Sensors sensors(vehicle_of(Steering::kAckermann), config, 1);
  sensors.sense({}, 0.0, 0.0);
  int late = 0;
  int positions = 0;
  for (const Measurement& m : sensors.sense({}, 0.0, 100.0)) {
    if (m.kind != MeasurementKind::kPosition) continue;
    ++positions;
    late += m.time == 0.0 ? 1 : 0;
  }
  EXPECT_EQ(late, 1);
  EXPECT_EQ(positions, 1);
}

TEST(Sensors, DropoutsLoseTheirShareAndLeaveTheOthersAsTheyAre) {
  SensorConfig config;
  config.gnss.noise_m = 0.02;
  Sensors whole(vehicle_of(Steering::kAckermann), config, 9);
  config.gnss.dropout_probability = 0.3;
  Sensors holed(vehicle_of(Steering::kAckermann), config, 9);
  const auto all = sensed(whole, 20000).at(MeasurementKind::kPosition);
  const auto some = sensed(holed, 20000).at(MeasurementKind::kPosition);
  EXPECT_NEAR(static_cast<double>(some.size()), 14000.0, 4.0 * 65.0);
  std::size_t at = 0;
  for (const Measurement& m : some) {
    while (at < all.size() && all[at].time < m.time) ++at;
    ASSERT_LT(at, all.size());
    EXPECT_EQ(all[at].value, m.value);
  }
  config.gnss.dropout_probability = 1.0;
  Sensors deaf(vehicle_of(Steering::kAckermann), config, 9);
  EXPECT_EQ(sensed(deaf, 1000).count(MeasurementKind::kPosition), 0u);
}

TEST(Sensors, OutagesLastAsLongAndComeAsOftenAsTheySay) {
  SensorConfig config;
  config.gnss.outage_rate_hz = 0.1;
  config.gnss.outage_s = 2.0;
  Sensors sensors(vehicle_of(Steering::kAckermann), config, 2);
  constexpr int kTicks = 2000000;
  double last = 0.0;
  long count = 0;
  int gaps = 0;
  for (int i = 0; i < kTicks; ++i) {
    const double now = i * kTick;
    for (const Measurement& m : sensors.sense({}, 0.0, now)) {
      if (m.kind != MeasurementKind::kPosition) continue;
      ++count;
      if (now - last > 1.5 * kTick) {
        ++gaps;
        // Whole outages, at times two without a reading in between.
        const double outages = std::round((now - last - kTick) / 2.0);
        EXPECT_NEAR(now - last - kTick, 2.0 * outages, 1.01 * kTick * outages);
      }
      last = now;
    }
  }
  // Good for 10 s and out for 2 s in the mean.
  EXPECT_NEAR(gaps, kTicks * kTick / 12.0, 4.0 * 35.0);
  EXPECT_NEAR(static_cast<double>(count) / kTicks, 10.0 / 12.0, 0.01);
}

TEST(Sensors, SettingsOfOneDoNotChangeWhatAnotherDraws) {
  SensorConfig config;
  config.gnss.noise_m = 0.02;
  config.heading.noise_deg = 0.4;
  config.wheel.noise_mps = 0.05;
  config.imu.noise_radps = 0.01;
  Sensors one(vehicle_of(Steering::kAckermann), config, 3);
  Sensors same(vehicle_of(Steering::kAckermann), config, 3);
  config.gnss.enabled = false;
  config.wheel.rate_hz = 10.0;
  config.wheel.dropout_probability = 0.5;
  config.steering.noise_deg = 1.0;
  Sensors other(vehicle_of(Steering::kAckermann), config, 3);
  const Readings a = sensed(one, 200);
  const Readings b = sensed(same, 200);
  const Readings c = sensed(other, 200);
  for (const auto& [kind, readings] : a) {
    const bool untouched = kind == MeasurementKind::kHeading || kind == MeasurementKind::kYawRate;
    for (std::size_t i = 0; i < readings.size(); ++i) {
      EXPECT_EQ(readings[i].value, b.at(kind)[i].value);
      if (untouched) {
        EXPECT_EQ(readings[i].value, c.at(kind)[i].value);
      }
    }
  }
  EXPECT_EQ(c.count(MeasurementKind::kPosition), 0u);
}

TEST(Sensors, FixesDrawFromAStreamOfTheirOwnInTheOldOrder) {
  SensorConfig config;
  config.position_accuracy_m = 0.05;
  config.heading_noise_deg = 1.0;
  Sensors sensors(vehicle_of(Steering::kAckermann), config, 8);
  RandomStream random(8, "sim/sensors");
  for (int i = 0; i < 100; ++i) {
    const VehicleState truth = truth_at(i * kTick);
    sensors.sense(truth, 0.0, i * kTick);
    const VehicleState fix = sensors.fix(truth);
    EXPECT_EQ(fix.pose.x, truth.pose.x + random.uniform(-0.05, 0.05));
    EXPECT_EQ(fix.pose.y, truth.pose.y + random.uniform(-0.05, 0.05));
    EXPECT_EQ(fix.pose.yaw, wrap_angle(truth.pose.yaw + deg_to_rad(1.0) * random.normal()));
    EXPECT_EQ(fix.speed, truth.speed);
    EXPECT_EQ(fix.steering, truth.steering);
  }
}

TEST(Sensors, ATickDoesNotAllocate) {
  SensorConfig config;
  config.gnss = {};
  config.gnss.latency_s = 0.2;
  config.gnss.dropout_probability = 0.1;
  config.imu.latency_s = 0.05;
  config.imu.outage_rate_hz = 0.5;
  config.imu.outage_s = 0.3;
  Sensors sensors(vehicle_of(Steering::kDifferential), config, 1);
  for (int i = 0; i < 500; ++i) sensors.sense({}, 0.0, i * kTick);
  const long before = testing::allocation_count();
  for (int i = 500; i < 5000; ++i) sensors.sense({}, 0.0, i * kTick);
  EXPECT_EQ(testing::allocation_count(), before);
}

TEST(SensorConfig, BadKeysAreNamed) {
  EXPECT_EQ(read_error("gnss: {rate_hz: 5, latency_s: 0.1, noise_m: 0.02}"), "");
  EXPECT_EQ(read_error("gnss: {rate_hz: -5}"), "gnss.rate_hz");
  EXPECT_EQ(read_error("imu: {latency_s: -0.1}"), "imu.latency_s");
  EXPECT_EQ(read_error("wheel: {dropout_probability: 1.5}"), "wheel.dropout_probability");
  EXPECT_EQ(read_error("steering: {noise_deg: -1}"), "steering.noise_deg");
  EXPECT_EQ(read_error("heading: {outage_s: -1}"), "heading.outage_s");
}

}  // namespace
}  // namespace headland
