// SPDX-License-Identifier: Apache-2.0
#include "control/speed_limits.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "control/speed_profile.hpp"
#include "core/base/random.hpp"
#include "core/config/yaml.hpp"

namespace headland {
namespace {

// Straights, arcs and clothoids that join without a step of curvature, and cusps.
Reference random_way(int number) {
  RandomStream random(static_cast<std::uint64_t>(number), "speed limits");
  Reference reference;
  Path& path = reference.path;
  path.append_straight({}, 3.0, 0);
  Gear gear = Gear::kForward;
  for (int leg = 1; leg < 9; ++leg) {
    if (random.uniform(0.0, 1.0) < 0.3) {
      gear = gear == Gear::kForward ? Gear::kReverse : Gear::kForward;
    }
    const double bend = (leg % 2 == 0 ? 1.0 : -1.0) * random.uniform(0.05, 0.4);
    const double ramp = random.uniform(1.0, 6.0);
    path.append({path.end_pose(), 0.0, ramp, gear, leg, bend / ramp});
    path.append({path.end_pose(), bend, random.uniform(0.5, 6.0), gear, leg});
    path.append({path.end_pose(), bend, ramp, gear, leg, -bend / ramp});
    path.append({path.end_pose(), 0.0, random.uniform(0.5, 9.0), gear, leg});
  }
  for (int leg = 0; leg < 9; ++leg) {
    reference.leg_speed.push_back(random.uniform(0.8, 4.0));
    reference.leg_working.push_back(leg % 3 == 0);
  }
  return reference;
}

Vehicle tractor() {
  Vehicle vehicle;
  vehicle.wheelbase_m = 2.18;
  vehicle.steering_rate_radps = 0.3;
  vehicle.acceleration_mps2 = 0.8;
  vehicle.energy.mass_kg = 3000.0;
  vehicle.energy.drag_area_m2 = 3.0;
  vehicle.energy.turn_loss_ratio = 0.5;
  vehicle.energy.base_power_w = 2500.0;
  vehicle.energy.implement_draft_n = 1500.0;
  return vehicle;
}

Vehicle rover() {
  Vehicle vehicle = tractor();
  vehicle.steering = Steering::kDifferential;
  vehicle.yaw_acceleration_radps2 = 0.3;
  return vehicle;
}

constexpr double kSlope = 0.06;

// The plane z = kSlope x, soft ground south of y = 0.
Ground hillside() {
  Farm farm;
  farm.soils.push_back(
      {"south", SoilClass::kSoft, {{{-500, -500}, {500, -500}, {500, 0}, {-500, 0}}, {}}});
  std::vector<double> heights;
  for (int row = 0; row <= 100; ++row) {
    for (int column = 0; column <= 100; ++column) heights.push_back(kSlope * 10.0 * column);
  }
  return Ground(farm, Terrain::from_grid({-500, -500}, 10.0, 101, 101, std::move(heights)));
}

// What the wheels must push against at a speed, written out on its own [W].
double power_needed(const Vehicle& vehicle, const PathSample& at, bool working, double v) {
  const EnergyModel& m = vehicle.energy;
  const double weight = m.total_mass() * kGravity;
  const bool soft = at.pose.y < 0.0;
  const SoilResistance soil = soil_resistance(soft ? SoilClass::kSoft : SoilClass::kFirm);
  const double force = weight * kSlope * std::cos(at.pose.yaw) * sign(at.gear) +
                       m.rolling_factor_ratio * soil.rolling_ratio * weight +
                       0.5 * 1.2041 * m.drag_area_m2 * v * v +
                       m.turn_loss_ratio * m.total_mass() * v * v * std::abs(at.curvature) +
                       (working ? m.implement_draft_n : 0.0);
  if (force <= 0.0) return 0.0;
  return force * v / (1.0 - std::min(0.5, soil.slip_per_traction * force / weight));
}

SpeedProfile profile_of(const Reference& reference, const Vehicle& vehicle,
                        const SpeedLimitConfig& config) {
  SpeedProfile profile;
  profile.build(reference, vehicle.acceleration_mps2, speed_zones(reference, vehicle, config),
                config.brake_ratio);
  return profile;
}

// Drives the profile's own motion; use(before, after, segment) sees every 10 ms of it.
template <class Use>
void drive(const Reference& reference, const SpeedProfile& profile, const Use& use) {
  int segment = 0;
  for (const PathSegment& span : reference.path.segments()) {
    SpeedProfile::State now{span.begin_s, 0.0};
    while (now.s < span.end_s) {
      const SpeedProfile::State next = profile.advance(now.s, now.speed, segment, 0.01);
      use(now, next, segment);
      now = next;
    }
    ++segment;
  }
}

TEST(SpeedLimits, KeepTheLateralAccelerationOnRandomWays) {
  for (const double most : {0.3, 1.0}) {
    for (int number = 0; number < 20; ++number) {
      const Reference reference = random_way(number);
      SpeedLimitConfig config;
      config.max_lateral_mps2 = most;
      const SpeedProfile profile = profile_of(reference, tractor(), config);
      double highest = 0.0;
      drive(reference, profile, [&](const auto& now, const auto&, int) {
        const double curvature = std::abs(reference.path.at(now.s).curvature);
        highest = std::max(highest, now.speed * now.speed * curvature);
      });
      EXPECT_LE(highest, most * (1.0 + 1e-9)) << number;
      EXPECT_GT(highest, 0.5 * most) << number;
    }
  }
}

TEST(SpeedLimits, KeepTheSteeringRateOnRandomWays) {
  const Vehicle vehicle = tractor();
  SpeedLimitConfig config;
  config.max_lateral_mps2 = 1000.0;
  config.least_speed_ratio = 0.05;
  const auto angle = [&](const Reference& reference, double s) {
    return std::atan(vehicle.wheelbase_m * reference.path.at(s).curvature);
  };
  double highest = 0.0;
  for (int number = 0; number < 20; ++number) {
    const Reference reference = random_way(number);
    const SpeedProfile profile = profile_of(reference, vehicle, config);
    drive(reference, profile, [&](const auto& now, const auto& next, int) {
      if (next.s - now.s < 1e-4) return;
      const double rate = (angle(reference, next.s) - angle(reference, now.s)) / 0.01;
      highest = std::max(highest, std::abs(rate));
    });
  }
  EXPECT_LE(highest, vehicle.steering_rate_radps);
  EXPECT_GT(highest, 0.9 * config.steering_use_ratio * vehicle.steering_rate_radps);
}

TEST(SpeedLimits, KeepTheYawAccelerationOfDifferentialVehicles) {
  const Vehicle vehicle = rover();
  SpeedLimitConfig config;
  config.max_lateral_mps2 = 1000.0;
  config.least_speed_ratio = 0.05;
  for (int number = 0; number < 20; ++number) {
    const Reference reference = random_way(number);
    const SpeedProfile profile = profile_of(reference, vehicle, config);
    drive(reference, profile, [&](const auto& now, const auto& next, int) {
      if (next.s - now.s < 1e-4) return;
      const double change =
          reference.path.at(next.s).curvature - reference.path.at(now.s).curvature;
      const double steady = now.speed * change / 0.01;
      ASSERT_LE(std::abs(steady), vehicle.yaw_acceleration_radps2 * 1.02) << now.s;
    });
  }
  Vehicle immediate = vehicle;
  immediate.yaw_acceleration_radps2 = 1000.0;
  EXPECT_TRUE(steering_zones(random_way(1), immediate, config).empty());
}

TEST(SpeedLimits, KeepThePowerAtTheWheelsOnAHillside) {
  const Ground ground = hillside();
  Vehicle vehicle = tractor();
  vehicle.energy.drive_power_w = 5000.0;
  SpeedLimitConfig config;
  config.max_lateral_mps2 = 1000.0;
  double highest = 0.0;
  for (int number = 0; number < 20; ++number) {
    Reference reference = random_way(number);
    reference.zones = energy_zones(reference, vehicle, config, ground);
    const SpeedProfile profile = profile_of(reference, vehicle, config);
    drive(reference, profile, [&](const auto& now, const auto&, int) {
      const PathSample at = reference.path.at(now.s);
      if (std::abs(at.pose.y) < 2.0) return;  // the soil is taken at the middle of each step
      const double power = power_needed(vehicle, at, at.leg % 3 == 0, now.speed);
      highest = std::max(highest, power);
      // The slope is the mean over steps that turn by up to 0.04 rad.
      ASSERT_LE(power, 5000.0 * 1.02) << number << " at " << now.s;
    });
  }
  EXPECT_GT(highest, 4900.0);
}

TEST(SpeedLimits, NeedAGroundAndASettingForTheEnergy) {
  const Reference reference = random_way(2);
  EXPECT_TRUE(energy_zones(reference, tractor(), {}, hillside()).empty());
  Vehicle strong = tractor();
  strong.energy.drive_power_w = 1e6;
  EXPECT_TRUE(energy_zones(reference, strong, {}, hillside()).empty());
  EXPECT_TRUE(energy_zones({}, strong, {}, hillside()).empty());
}

TEST(SpeedLimits, FindTheSpeedOfTheLeastEnergy) {
  // Base power b and air a v^2 per metre: b / v^2 = 2 a v / efficiency.
  EnergyModel model;
  model.base_power_w = 100.0;
  model.drag_area_m2 = 30.0;
  DriveStep step;
  step.distance_m = 2.0;
  step.soil.slip_per_traction = 0.0;
  const double air = 0.5 * 1.2041 * 30.0 / model.drive_efficiency_ratio;
  EXPECT_NEAR(economic_speed(model, step, 0.1, 10.0), std::cbrt(100.0 / (2.0 * air)), 1e-5);
  EXPECT_EQ(economic_speed(model, step, 0.1, 1.0), 1.0) << "the leg is slower than that";
  // In a curve turn losses add to the air's: slower pays.
  model.turn_loss_ratio = 1.0;
  step.curvature_1pm = 0.2;
  const double turn = 1000.0 * 0.2 / model.drive_efficiency_ratio;
  EXPECT_NEAR(economic_speed(model, step, 0.1, 10.0), std::cbrt(100.0 / (2.0 * (air + turn))),
              1e-5);
}

TEST(SpeedLimits, EconomyTakesLessEnergyAndItsRatioIsHowFarItGoes) {
  const Vehicle vehicle = tractor();
  Vehicle thirsty = vehicle;
  thirsty.energy.base_power_w = 300.0;
  thirsty.energy.turn_loss_ratio = 2.0;
  Reference reference;
  reference.path.append({{}, 0.3, 12.0, Gear::kForward, 0});
  reference.leg_speed = {2.0};
  double energy = 1e99;
  double speed_before = 2.0;
  for (const double ratio : {0.25, 0.5, 1.0}) {
    SpeedLimitConfig config;
    config.economy_ratio = ratio;
    const auto zones = energy_zones(reference, thirsty, config, Ground());
    ASSERT_EQ(zones.size(), 1U);
    const double v = zones.front().speed;
    EXPECT_LT(v, speed_before);
    DriveStep step;
    step.distance_m = 12.0;
    step.curvature_1pm = 0.3;
    step.speed_mps = step.speed_before_mps = v;
    step.duration_s = 12.0 / v;
    EXPECT_LT(step_energy(thirsty.energy, step), energy);
    energy = step_energy(thirsty.energy, step);
    speed_before = v;
  }
}

TEST(SpeedLimits, AreMonotone) {
  const Ground ground = hillside();
  const auto slower = [](const Reference& reference, const SpeedProfile& a, const SpeedProfile& b) {
    for (double s = 0.0; s < reference.path.length(); s += 0.05) {
      const int segment = reference.path.at(s).segment;
      if (a.limit(s, segment, 0.0) > b.limit(s, segment, 0.0) * (1.0 + 1e-9)) return false;
    }
    return a.duration() >= b.duration() * (1.0 - 1e-9);
  };
  for (int number = 0; number < 10; ++number) {
    Reference reference = random_way(number);
    Vehicle vehicle = tractor();
    const SpeedProfile plain = profile_of(reference, vehicle, {});
    SpeedLimitConfig tighter;
    tighter.max_lateral_mps2 = 0.5;
    EXPECT_TRUE(slower(reference, profile_of(reference, vehicle, tighter), plain));
    tighter = {};
    tighter.steering_use_ratio = 0.5;
    EXPECT_TRUE(slower(reference, profile_of(reference, vehicle, tighter), plain));
    tighter = {};
    tighter.brake_ratio = 0.5;
    EXPECT_TRUE(slower(reference, profile_of(reference, vehicle, tighter), plain));
    vehicle.energy.drive_power_w = 8000.0;
    reference.zones = energy_zones(reference, vehicle, {}, ground);
    const SpeedProfile strong = profile_of(reference, vehicle, {});
    EXPECT_TRUE(slower(reference, strong, plain));
    vehicle.energy.drive_power_w = 4000.0;
    reference.zones = energy_zones(reference, vehicle, {}, ground);
    EXPECT_TRUE(slower(reference, profile_of(reference, vehicle, {}), strong));
  }
}

TEST(SpeedLimits, CapTheSpeedInReverseGearAlone) {
  Reference reference;
  reference.path.append_straight({}, 10.0, 0);
  reference.path.append({{10.0, 0.0, 0.0}, 0.0, 8.0, Gear::kReverse, 0});
  reference.leg_speed = {1.5};
  Vehicle vehicle = tractor();
  EXPECT_TRUE(speed_zones(reference, vehicle, {}).empty());
  vehicle.reverse_speed_mps = 0.5;
  const SpeedProfile profile = profile_of(reference, vehicle, {});
  EXPECT_DOUBLE_EQ(profile.limit(5.0, 0, 0.0), 1.5);
  EXPECT_DOUBLE_EQ(profile.limit(13.0, 1, 0.0), 0.5);
}

TEST(SpeedLimits, GiveDisjointZonesInOrder) {
  for (int number = 0; number < 20; ++number) {
    Reference reference = random_way(number);
    reference.zones = {{1.0, 20.0, 0.7}, {2.0, 3.0, 0.4}, {2.5, 40.0, 0.9}};
    const auto zones = speed_zones(reference, tractor(), {});
    double end = -100.0;
    for (const SpeedZone& zone : zones) {
      EXPECT_GE(zone.begin_s, end);
      EXPECT_GT(zone.end_s, zone.begin_s);
      EXPECT_GT(zone.speed, 0.0);
      end = zone.end_s;
    }
    const SpeedProfile profile = profile_of(reference, tractor(), {});
    EXPECT_LE(profile.limit(2.7, 0, 0.0), 0.4);
    EXPECT_LE(profile.limit(2.9999, 0, 0.0), 0.4);
  }
}

TEST(SteeringZones, SlowDownOnlyWhereTheSteeringIsTooSlowForTheError) {
  Reference reference;
  reference.path.append_straight({0.0, 0.0, 0.0}, 10.0, 0);
  reference.path.append({reference.path.end_pose(), 0.4, 10.0, Gear::kForward, 0});
  reference.leg_speed = {1.0};
  Vehicle vehicle;
  vehicle.wheelbase_m = 2.5;
  vehicle.steering_rate_radps = 2.0;
  EXPECT_TRUE(steering_zones(reference, vehicle, {}).empty());
  SpeedLimitConfig config;
  config.step_error_m = 0.005;
  config.least_speed_ratio = 0.1;
  vehicle.steering_rate_radps = 0.5;
  const auto zones = steering_zones(reference, vehicle, config);
  ASSERT_EQ(zones.size(), 1U);
  // c l^2 / 24 over the zone is the error asked for, and the wheels just make it.
  const double length = zones[0].end_s - zones[0].begin_s;
  EXPECT_NEAR(0.4 * length * length / 24.0, 0.005, 1e-9);
  EXPECT_NEAR(length / zones[0].speed, std::atan(2.5 * 0.4) / (0.5 * config.steering_use_ratio),
              1e-9);
  EXPECT_NEAR(0.5 * (zones[0].begin_s + zones[0].end_s), 10.0, 1e-9);
}

TEST(SteeringZones, GiveADifferentialVehicleTheTimeForItsYawRate) {
  Reference reference;
  reference.path.append_straight({0.0, 0.0, 0.0}, 10.0, 0);
  reference.path.append({reference.path.end_pose(), 0.4, 10.0, Gear::kForward, 0});
  reference.leg_speed = {2.0};
  const auto zones = steering_zones(reference, rover(), {});
  ASSERT_EQ(zones.size(), 1U);
  const double length = zones[0].end_s - zones[0].begin_s;
  EXPECT_NEAR(0.4 * length * length / 24.0, 0.02, 1e-9);
  const double yaw_rate = 0.4 * zones[0].speed;
  EXPECT_NEAR(length / zones[0].speed, yaw_rate / (0.95 * 0.3), 1e-9);
}

TEST(SpeedLimitConfig, SaysWhatIsWrongWithItsInput) {
  const auto read = [](const std::string& text) {
    SpeedLimitConfig config;
    return config::read_into(*config::Node::parse(text, "limits.yaml"), config);
  };
  EXPECT_TRUE(read("max_lateral_mps2: 0.7\neconomy_ratio: 0.5\nbrake_ratio: 0.8\n"));
  for (const char* bad :
       {"max_lateral_mps2: 0", "economy_ratio: 1.1", "brake_ratio: 0", "least_speed_ratio: -1",
        "step_error_m: 0", "steering_use_ratio: 2", "max_lateral_mps2: .nan", "max_lateral: 1"}) {
    const auto result = read(bad);
    ASSERT_FALSE(result) << bad;
    EXPECT_NE(to_string(result.error()).find("limits.yaml:1:"), std::string::npos);
  }
}

// Speeding up and slowing down included, a slower turn saves energy where turning loses it.
TEST(SpeedLimits, EconomyPaysOverAWholeRouteWithTurnLosses) {
  Vehicle vehicle = tractor();
  vehicle.energy.turn_loss_ratio = 1.0;
  vehicle.energy.base_power_w = 500.0;
  Reference reference;
  for (int i = 0; i < 3; ++i) {
    const Pose2 from = i == 0 ? Pose2{} : reference.path.end_pose();
    reference.path.append({from, 0.0, 40.0, Gear::kForward, 0});
    reference.path.append({reference.path.end_pose(), 0.3, kPi / 0.3, Gear::kForward, 0});
  }
  reference.leg_speed = {1.6};
  double before = 1e99;
  for (const double ratio : {0.0, 0.5, 1.0}) {
    SpeedLimitConfig config;
    config.economy_ratio = ratio;
    reference.zones = energy_zones(reference, vehicle, config, Ground());
    double energy = 0.0;
    drive(reference, profile_of(reference, vehicle, config),
          [&](const auto& now, const auto& next, int) {
            DriveStep step;
            step.distance_m = next.s - now.s;
            step.duration_s = 0.01;
            step.curvature_1pm = reference.path.at(now.s).curvature;
            step.speed_mps = next.speed;
            step.speed_before_mps = now.speed;
            energy += step_energy(vehicle.energy, step);
          });
    std::printf("economy %.1f: %.1f kJ\n", ratio, energy / 1000.0);
    EXPECT_LT(energy, before);
    before = energy;
  }
}

}  // namespace
}  // namespace headland
