// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gtest/gtest.h>

#include "control/receding_horizon/horizon_tracker.hpp"
#include "control/receding_horizon/rti_solver.hpp"
#include "core/config/yaml.hpp"
#include "tests/control/receding_horizon/drive.hpp"

namespace headland {
namespace {

using testing::kCycle;
using testing::u_turn;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vehicle rover() {
  Vehicle vehicle;
  vehicle.wheelbase_m = 1.5;
  vehicle.max_steering_deg = 40.0;
  return vehicle;
}

/// Solves as the real-time iteration does, unless told not to.
class MoodySolver : public HorizonSolver {
 public:
  explicit MoodySolver(const SolveStatus* mood)
      : rti_(HorizonConfig{}.intervals_count), mood_(mood) {}
  SolveResult solve(const HorizonProblem& problem, HorizonPlan& plan,
                    const Deadline& deadline) override {
    return solved(*mood_) ? rti_.solve(problem, plan, deadline) : SolveResult{*mood_, 0};
  }

 private:
  RtiSolver rti_;
  const SolveStatus* mood_;
};

// A clock of which every look takes `step`.
class FakeClock : public Clock {
 public:
  double step = 0.0;  ///< [s]
  double now() const override { return now_ += step; }

 private:
  mutable double now_ = 0.0;
};

/// A drive that can be interfered with, tick by tick.
struct Ride {
  explicit Ride(const Vehicle& v, const HorizonConfig& config = {}, const Clock* clock = nullptr)
      : vehicle(v),
        tracker(v, config, kCycle, clock, {},
                clock ? nullptr : std::make_unique<MoodySolver>(&mood)) {
    EXPECT_TRUE(tracker.start(reference));
  }
  TrackOutput tick() {
    const TrackOutput out = tracker.step(state, kCycle);
    EXPECT_TRUE(std::isfinite(out.command.speed) && std::isfinite(out.command.steering));
    if (failed(out.status)) {
      EXPECT_EQ(out.command.speed, 0.0);
    }
    state = step_vehicle(vehicle, state, out.command, kCycle);
    return out;
  }
  TrackOutput ticks(int count) {
    TrackOutput out;
    for (int i = 0; i < count; ++i) out = tick();
    return out;
  }
  TrackStatus to_the_end() {
    TrackOutput out;
    for (int i = 0; i < 5000 && !failed(out.status) && out.status != TrackStatus::kDone; ++i) {
      out = tick();
    }
    return out.status;
  }

  Vehicle vehicle;
  Reference reference = u_turn(3.0, 1.0, 8.0);
  VehicleState state;
  SolveStatus mood = SolveStatus::kUsable;
  HorizonTracker tracker;
};

TEST(HorizonTrackerFailures, AStateOrATimeThatIsNoNumberIsAStop) {
  Ride ride(rover());
  ride.ticks(200);
  for (double VehicleState::*member :
       {&VehicleState::speed, &VehicleState::steering, &VehicleState::yaw_rate}) {
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
      VehicleState state = ride.state;
      state.*member = bad;
      const TrackOutput out = ride.tracker.step(state, kCycle);
      EXPECT_EQ(out.status, TrackStatus::kBadState);
      EXPECT_EQ(out.command.speed, 0.0);
      EXPECT_TRUE(std::isfinite(out.command.steering));
    }
  }
  for (const Pose2& pose :
       {Pose2{kNan, 0.0, 0.0}, Pose2{0.0, kInfinity, 0.0}, Pose2{0.0, 0.0, kNan}}) {
    VehicleState state = ride.state;
    state.pose = pose;
    EXPECT_EQ(ride.tracker.step(state, kCycle).status, TrackStatus::kBadState);
  }
  for (const double dt : {0.0, -0.02, kNan, kInfinity}) {
    const TrackOutput out = ride.tracker.step(ride.state, dt);
    EXPECT_EQ(out.status, TrackStatus::kBadState);
    EXPECT_EQ(out.command.speed, 0.0);
  }
  EXPECT_EQ(ride.to_the_end(), TrackStatus::kDone);
}

TEST(HorizonTrackerFailures, ASlipThatIsNoNumberOrAbsurdIsNotBelieved) {
  Ride ride(rover());
  ride.ticks(200);
  for (const double bad : {kNan, kInfinity, -kInfinity, 1.0, 1e300, -1e300}) {
    const TrackOutput out = ride.tracker.step({ride.state, {bad, bad, bad}}, kCycle);
    EXPECT_TRUE(std::isfinite(out.command.speed) && std::isfinite(out.command.steering));
  }
  EXPECT_EQ(ride.to_the_end(), TrackStatus::kDone);
}

TEST(HorizonTrackerFailures, AVehicleThatJumpsFiveMetresStopsAndGoesOnWhenItIsBack) {
  Ride ride(rover());
  ride.ticks(200);
  const VehicleState before = ride.state;
  for (const Pose2& jump :
       {Pose2{5.0, 0.0, 0.0}, Pose2{-5.0, 0.0, 0.0}, Pose2{0.0, -5.0, 0.0}, Pose2{1e6, 0.0, 0.0}}) {
    ride.state = before;
    ride.state.pose = before.pose * jump;
    EXPECT_EQ(ride.tick().status, TrackStatus::kPathLost);
  }
  ride.state = before;
  EXPECT_EQ(ride.to_the_end(), TrackStatus::kDone);
}

TEST(HorizonTrackerFailures, AReferenceThatJumpsFiveMetresStops) {
  Ride ride(rover());
  ride.ticks(200);
  Reference other = ride.reference;
  other.path = Path();
  other.path.append(
      {{ride.state.pose.x, ride.state.pose.y + 5.0, 0.0}, 0.0, 9.0, Gear::kForward, 0});
  ASSERT_TRUE(ride.tracker.start(other));
  EXPECT_EQ(ride.tick().status, TrackStatus::kPathLost);
  // Anew on the old one, from where it stands now.
  ride.state = {};
  ASSERT_TRUE(ride.tracker.start(ride.reference));
  EXPECT_EQ(ride.to_the_end(), TrackStatus::kDone);
}

TEST(HorizonTrackerFailures, TheShiftedPlanDrivesUntilItIsTooOld) {
  HorizonConfig config;
  for (const SolveStatus bad : {SolveStatus::kFailed, SolveStatus::kTimedOut}) {
    Ride ride(rover(), config);
    ride.ticks(200);
    ride.mood = bad;
    for (int i = 0; i < config.most_stale_count; ++i) {
      const TrackOutput out = ride.tick();
      EXPECT_EQ(out.status, TrackStatus::kTracking) << i;
      EXPECT_NEAR(out.command.speed, 1.0, 0.02) << i;
    }
    EXPECT_LT(std::abs(ride.state.pose.y), 0.01);
    EXPECT_EQ(ride.tick().status, TrackStatus::kSolverFailed);
    EXPECT_EQ(ride.ticks(5).status, TrackStatus::kSolverFailed);
    const HorizonCounts& counts = ride.tracker.counts();
    EXPECT_EQ(counts.late + counts.failed, config.most_stale_count + 6);
    EXPECT_EQ(bad == SolveStatus::kFailed ? counts.late : counts.failed, 0);
    ride.mood = SolveStatus::kUsable;
    EXPECT_EQ(ride.to_the_end(), TrackStatus::kDone);
  }
}

TEST(HorizonTrackerFailures, TheFirstSolveThatFailsLeavesNoPlanToDriveBy) {
  Ride ride(rover());
  ride.mood = SolveStatus::kFailed;
  TrackOutput out;
  for (int i = 0; i < 200 && !failed(out.status); ++i) out = ride.tick();
  EXPECT_EQ(out.status, TrackStatus::kSolverFailed);
  EXPECT_EQ(ride.state.speed, 0.0);
  ride.mood = SolveStatus::kUsable;
  EXPECT_EQ(ride.to_the_end(), TrackStatus::kDone);
}

TEST(HorizonTrackerFailures, EverySecondSolveIsEnough) {
  Ride ride(rover());
  double largest = 0.0;
  TrackOutput out;
  for (int i = 0; i < 5000 && out.status != TrackStatus::kDone; ++i) {
    ride.mood = i % 2 == 0 ? SolveStatus::kUsable : SolveStatus::kTimedOut;
    out = ride.tick();
    ASSERT_FALSE(failed(out.status));
    const Projection near = ride.reference.path.project(ride.state.pose.position(),
                                                        std::max(0.0, out.s - 1.0), out.s + 1.0);
    largest = std::max(largest, std::abs(near.lateral_error));
  }
  EXPECT_EQ(out.status, TrackStatus::kDone);
  EXPECT_LT(largest, 0.05);
}

TEST(HorizonTrackerFailures, ADeadlineIsHeldAgainstTheClockOfBothSolvers) {
  for (const HorizonSolverKind solver : {HorizonSolverKind::kRti, HorizonSolverKind::kIpopt}) {
    HorizonConfig config;
    config.solver = solver;
    config.deadline_s = 0.01;
    FakeClock clock;
    Ride ride(rover(), config, &clock);
    ride.ticks(100);
    EXPECT_EQ(ride.tracker.counts().late, 0);
    clock.step = 0.02;
    EXPECT_EQ(ride.ticks(config.most_stale_count).status, TrackStatus::kTracking);
    EXPECT_EQ(ride.tick().status, TrackStatus::kSolverFailed);
    EXPECT_EQ(ride.tracker.counts().late, config.most_stale_count + 1);
    clock.step = 0.0;
    EXPECT_EQ(ride.tick().status, TrackStatus::kTracking);
  }
}

TEST(HorizonTrackerStart, RefusesAPathThatIsTooTightForTheSteeringAllowed) {
  HorizonConfig config;
  config.steering_high_deg = 20.0;  // one side is enough: 4.1 m
  HorizonTracker tracker(rover(), config, kCycle);
  const Reference tight = u_turn(3.0, 1.0);
  const Result<void> started = tracker.start(tight);
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, ErrorCode::kPathTooTight);
  EXPECT_NE(to_string(started.error()).find("3.00 m"), std::string::npos);
  EXPECT_NE(to_string(started.error()).find("4.12 m"), std::string::npos);
  EXPECT_EQ(tracker.step(VehicleState{}, kCycle).command.speed, 0.0);
  EXPECT_TRUE(failed(tracker.step(VehicleState{}, kCycle).status));
}

TEST(HorizonTrackerStart, RefusesLimitsThatExcludeEachOtherByTheirKey) {
  const auto key_of = [](const std::function<void(HorizonConfig&)>& spoil) {
    HorizonConfig config;
    spoil(config);
    HorizonTracker tracker(rover(), config, kCycle);
    const Reference reference = u_turn(3.0, 1.0);
    const Result<void> started = tracker.start(reference);
    return started ? std::string("started") : started.error().where.key;
  };
  EXPECT_EQ(key_of([](HorizonConfig&) {}), "started");
  EXPECT_EQ(key_of([](HorizonConfig& c) { c.steering_low_deg = 5.0; }), "steering_low_deg");
  EXPECT_EQ(key_of([](HorizonConfig& c) { c.steering_high_deg = -5.0; }), "steering_low_deg");
  EXPECT_EQ(key_of([](HorizonConfig& c) { c.acceleration_low_mps2 = 0.0; }),
            "acceleration_low_mps2");
  EXPECT_EQ(key_of([](HorizonConfig& c) { c.acceleration_high_mps2 = kNan; }),
            "acceleration_low_mps2");
  EXPECT_EQ(key_of([](HorizonConfig& c) { c.pivot_until_deg = 60.0; }), "pivot_until_deg");
}

TEST(HorizonTrackerStart, YamlNamesFileLineAndKeyOfWhatIsOutOfRange) {
  const auto message_of = [](const std::string& text) {
    HorizonConfig config;
    const auto node = config::Node::parse(text, "horizon.yaml");
    const Result<void> read = config::read_into(*node, config);
    return read ? std::string() : to_string(read.error());
  };
  EXPECT_EQ(message_of("interval_s: 0.1\nintervals_count: 20\n"), "");
  for (const char* line :
       {"intervals_count: 0", "interval_s: 0", "deadline_s: -1", "weights: {across_weight: 0}"}) {
    const std::string message = message_of("search_m: 2\n" + std::string(line) + "\n");
    EXPECT_NE(message.find("horizon.yaml:2: "), std::string::npos) << message;
  }
  EXPECT_NE(message_of("intervals_count: 0\n").find("intervals_count: 0 is out of range"),
            std::string::npos);
  EXPECT_NE(message_of("steering_low_deg: 5\n").find("steering_low_deg"), std::string::npos);
}

}  // namespace
}  // namespace headland
