// SPDX-License-Identifier: Apache-2.0
#include "control/receding_horizon/horizon_tracker.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "control/drivable.hpp"
#include "control/receding_horizon/ipopt_solver.hpp"
#include "control/receding_horizon/rti_solver.hpp"

namespace headland {
namespace {

constexpr double kStill = 0.02;          // slower counts as standing, estimated as it is [m/s]
constexpr double kSettling = 4.0;        // lags of the drive until it stands, once it is that slow
constexpr double kSpeedRoom = 1.1;       // of the reference's speed that a plan may use
constexpr double kLeastSpeedRoom = 0.2;  // and at least [m/s]
constexpr double kBrakeShare = 0.9;      // of the braking that plans use; feedback has the rest
constexpr int kFirstSolves = 5;          // without a plan to start from

// What an estimator may say without being believed more than this.
Slip plausible(const Slip& slip) {
  const auto within = [](double value, double low, double high) {
    return std::isfinite(value) ? std::clamp(value, low, high) : 0.0;
  };
  return {within(slip.loss_ratio, -0.3, 0.7), within(slip.side_rad, -0.5, 0.5),
          within(slip.steering_offset_rad, -0.35, 0.35)};
}

Error excludes(const char* low, const char* high, double low_value, double high_value) {
  return {ErrorCode::kOutOfRange,
          fmt::format("the limits {} {} and {} {} leave nothing", low, low_value, high, high_value),
          fmt::format("{} must lie below zero and {} above", low, high),
          {{}, 0, low}};
}

std::unique_ptr<HorizonSolver> make_solver(const HorizonConfig& config) {
  if (config.solver == HorizonSolverKind::kIpopt) {
    return std::make_unique<IpoptSolver>(config.intervals_count);
  }
  return std::make_unique<RtiSolver>(config.intervals_count);
}

}  // namespace

std::optional<Error> HorizonConfig::check() const {
  if (!(steering_low_deg < 0.0 && steering_high_deg > 0.0)) {
    return excludes("steering_low_deg", "steering_high_deg", steering_low_deg, steering_high_deg);
  }
  if (!(acceleration_low_mps2 < 0.0 && acceleration_high_mps2 > 0.0)) {
    return excludes("acceleration_low_mps2", "acceleration_high_mps2", acceleration_low_mps2,
                    acceleration_high_mps2);
  }
  if (!(pivot_until_deg < pivot_from_deg)) {
    return Error{ErrorCode::kOutOfRange,
                 fmt::format("pivot_until_deg {} is not below pivot_from_deg {}", pivot_until_deg,
                             pivot_from_deg),
                 "turning on the spot must end before it begins",
                 {{}, 0, "pivot_until_deg"}};
  }
  return std::nullopt;
}

HorizonTracker::HorizonTracker(const Vehicle& vehicle, const HorizonConfig& config, double cycle,
                               const Clock* clock, const SpeedLimitConfig& limits,
                               std::unique_ptr<HorizonSolver> solver)
    : vehicle_(vehicle),
      config_(config),
      limits_(limits),
      cycle_(cycle),
      clock_(clock),
      delay_(vehicle, cycle),
      problem_(MotionModel(vehicle), config.intervals_count, config.interval_s),
      solver_(solver ? std::move(solver) : make_solver(config)),
      plan_(config.intervals_count),
      shifted_(config.intervals_count) {
  problem_.weights = config.weights;
  problem_.acceleration = {std::max(config.acceleration_low_mps2, -vehicle.acceleration_mps2),
                           std::min(config.acceleration_high_mps2, vehicle.acceleration_mps2)};
  const double rate = ackermann() ? vehicle.steering_rate_radps : vehicle.yaw_acceleration_radps2;
  problem_.turn_rate = {-rate, rate};
  if (ackermann()) {
    turn_ = {std::max(deg_to_rad(config.steering_low_deg), -vehicle.max_steering_rad()),
             std::min(deg_to_rad(config.steering_high_deg), vehicle.max_steering_rad())};
  } else {
    problem_.weights.turn_rate_weight = config.weights.yaw_acceleration_weight;
    turn_ = {-config.max_yaw_rate_radps, config.max_yaw_rate_radps};
  }
}

Result<void> HorizonTracker::do_start() {
  mode_ = Mode::kDone;
  if (auto error = config_.check()) return tl::unexpected<Error>(std::move(*error));
  const double most_angle = std::min({vehicle_.max_steering_rad(), -turn_.low, turn_.high});
  if (auto error = check_curvature(vehicle_, reference().path, most_angle)) {
    return tl::unexpected<Error>(std::move(*error));
  }
  const double braking = std::min(1.0, -problem_.acceleration.low / problem_.acceleration.high);
  profile_.build(reference(), problem_.acceleration.high,
                 speed_zones(reference(), vehicle_, limits_),
                 kBrakeShare * limits_.brake_ratio * braking);
  mode_ = reference().path.empty() ? Mode::kDone : Mode::kStanding;
  progress_.start(reference().path);
  has_plan_ = false;
  stale_ = 0;
  changing_gear_ = false;
  gear_left_ = 0.0;
  steering_left_ = longest_steering(vehicle_);
  return {};
}

// Where the vehicle will be when a command given now has begun to act.
VehicleState HorizonTracker::predict(const VehicleState& now) const {
  VehicleState then = now;
  for (int i = 1; i <= delay_.longest(); ++i) {
    then = step_vehicle(vehicle_, then, delay_.acting(i), cycle_, problem_.slip);
  }
  return then;
}

TrackOutput HorizonTracker::give(const Command& command, TrackStatus status) {
  delay_.push(command);
  return {command, status, progress_.s(), stale_ > 0 && has_plan_};
}

TrackOutput HorizonTracker::stop(TrackStatus status) {
  has_plan_ = false;
  return give({0.0, delay_.acting(delay_.longest()).steering, 0.0}, status);
}

TrackOutput HorizonTracker::arrive(const VehicleState& then) {
  has_plan_ = false;
  if (progress_.on_last()) {
    const bool still = std::abs(then.speed) <= kStill;
    mode_ = still ? Mode::kDone : Mode::kStopping;
    return stop(still ? TrackStatus::kDone : TrackStatus::kTracking);
  }
  progress_.next_segment();
  mode_ = Mode::kStanding;
  changing_gear_ = true;
  gear_left_ = std::max(vehicle_.gear_change_s, kSettling * vehicle_.speed_lag_s);
  steering_left_ = longest_steering(vehicle_);
  return stop(TrackStatus::kGearChange);
}

// The steering angle with which the vehicle drives off from a standstill [rad].
double HorizonTracker::standing_angle() const {
  const double angle =
      problem_.model.turn_for(reference().path.at(progress_.s()).curvature, 0.0, problem_.slip);
  return std::clamp(angle, turn_.low, turn_.high);
}

bool HorizonTracker::ready(const VehicleState& then) const {
  const bool turned =
      !ackermann() || steering_left_ <= 0.0 ||
      std::abs(standing_angle() - then.steering) <= deg_to_rad(config_.steering_tolerance_deg);
  return gear_left_ <= 0.0 && turned;
}

// Stands until the vehicle is still, the gear is in and the wheels have turned.
TrackOutput HorizonTracker::stand(const VehicleState& then) {
  const TrackStatus status = changing_gear_ ? TrackStatus::kGearChange : TrackStatus::kTracking;
  if (std::abs(then.speed) > kStill) return stop(status);
  gear_left_ -= cycle_;
  steering_left_ -= cycle_;
  const double angle = ackermann() ? command_through_lag(standing_angle(), then.steering,
                                                         vehicle_.steering_lag_s, cycle_)
                                   : 0.0;
  const double limit = vehicle_.max_steering_rad();
  return give({0.0, std::clamp(angle, -limit, limit), 0.0}, status);
}

// The reference of the coming seconds: along the path as the speed profile goes from here.
void HorizonTracker::refer_to_path(const VehicleState& then, double s) {
  const Path& path = reference().path;
  const PathSegment& now = progress_.segment();
  const double direction = sign(now.gear);
  const Slip& slip = problem_.slip;
  SpeedProfile::State at{s, std::max(0.0, direction * then.speed * (1.0 - slip.loss_ratio))};
  double yaw = problem_.start(kYaw);
  for (int k = 0; k <= problem_.intervals(); ++k) {
    if (k > 0) at = profile_.advance(at.s, at.speed, progress_.number(), problem_.interval_s);
    const PathSample sample =
        path.at(std::clamp(at.s, now.begin_s, now.end_s - PathProgress::kBeforeEnd));
    const double wheels = direction * at.speed / (1.0 - slip.loss_ratio);
    yaw += wrap_angle(sample.pose.yaw - slip.side_rad - yaw);
    HorizonStage& stage = problem_.stages[static_cast<std::size_t>(k)];
    const double turn = problem_.model.turn_for(sample.curvature, wheels, slip);
    stage.wanted << sample.pose.x, sample.pose.y, yaw, wheels,
        std::clamp(turn, turn_.low, turn_.high);
  }
}

// Turning on the spot until the heading is the path's.
void HorizonTracker::refer_to_pivot(const VehicleState& then, double heading_error) {
  for (int k = 0; k <= problem_.intervals(); ++k) {
    HorizonStage& stage = problem_.stages[static_cast<std::size_t>(k)];
    const double time = k * problem_.interval_s;
    const double left = std::max(0.0, std::abs(heading_error) - turn_.high * time);
    const double rate = left > 0.0 ? std::copysign(turn_.high, -heading_error) : 0.0;
    stage.wanted << then.pose.x, then.pose.y,
        problem_.start(kYaw) - heading_error + std::copysign(left, heading_error), 0.0, rate;
  }
}

// Controls between the reference's states, and the boxes: the reference's speed with some room, and
// always room for what the vehicle does now.
void HorizonTracker::set_bounds(const VehicleState& then) {
  const double h = problem_.interval_s;
  double fastest = 0.0;
  for (const HorizonStage& stage : problem_.stages) {
    fastest = std::max(fastest, std::abs(stage.wanted(kWheelSpeed)));
  }
  fastest = kSpeedRoom * fastest + kLeastSpeedRoom;
  const bool pivoting = mode_ == Mode::kPivoting;  // may correct its place both ways
  const double forwards = pivoting || progress_.segment().gear == Gear::kForward ? fastest : 0.0;
  const double backwards = pivoting || progress_.segment().gear == Gear::kReverse ? -fastest : 0.0;
  const Bounds speed{std::min(backwards, then.speed), std::max(forwards, then.speed)};
  const double turn = turn_of(then);
  for (std::size_t k = 0; k < problem_.stages.size(); ++k) {
    HorizonStage& stage = problem_.stages[k];
    stage.speed = speed;
    stage.turn = {std::min(turn_.low, turn), std::max(turn_.high, turn)};
    if (k + 1 == problem_.stages.size()) break;
    const HorizonState change = (problem_.stages[k + 1].wanted - stage.wanted) / h;
    stage.control << std::clamp(change(kWheelSpeed), problem_.acceleration.low,
                                problem_.acceleration.high),
        std::clamp(change(kWheelTurn), problem_.turn_rate.low, problem_.turn_rate.high);
  }
}

// Solves from the last plan, seen a cycle later. False: no plan is left to drive by.
bool HorizonTracker::improve_plan(double dt) {
  const bool fresh = !has_plan_;
  if (fresh) {
    for (std::size_t k = 0; k < plan_.states.size(); ++k) {
      plan_.states[k] = problem_.stages[k].wanted;
      if (k < plan_.controls.size()) plan_.controls[k] = problem_.stages[k].control;
    }
  } else {
    plan_.shift_into(shifted_, dt, problem_.interval_s);
    std::swap(plan_, shifted_);
    const double turns = std::round((problem_.start(kYaw) - plan_.states[0](kYaw)) / (2.0 * kPi));
    for (HorizonState& state : plan_.states) state(kYaw) += 2.0 * kPi * turns;
  }
  const Deadline deadline =
      config_.deadline_s > 0.0 ? Deadline::in(clock_, config_.deadline_s) : Deadline{};
  SolveResult result;
  for (int i = 0; i < (fresh ? kFirstSolves : 1); ++i) {
    result = solver_->solve(problem_, plan_, deadline);
    if (!solved(result.status)) break;
    has_plan_ = true;
  }
  ++counts_.solves;
  if (solved(result.status)) {
    stale_ = 0;
    return true;
  }
  ++(result.status == SolveStatus::kTimedOut ? counts_.late : counts_.failed);
  ++stale_;
  return has_plan_ && stale_ <= config_.most_stale_count;
}

// Where the plan is after the coming cycle, as the actuators must be told.
Command HorizonTracker::first_command(const VehicleState& then, double dt) const {
  const HorizonControl& u = plan_.controls[0];
  // An old plan's first state is not the vehicle's.
  const double speed = (stale_ > 0 ? plan_.states[0](kWheelSpeed) : then.speed) + u(0) * dt;
  const double turn = (stale_ > 0 ? plan_.states[0](kWheelTurn) : turn_of(then)) + u(1) * dt;
  const double lag = vehicle_.steering_lag_s;
  Command command;
  command.speed = command_through_lag(speed, then.speed, vehicle_.speed_lag_s, dt);
  const double told = command_through_lag(turn, turn_of(then), lag, dt);
  if (ackermann()) {
    command.steering = std::clamp(told, turn_.low, turn_.high);
  } else {
    command.yaw_rate = std::clamp(told, turn_.low, turn_.high);
  }
  return command;
}

TrackOutput HorizonTracker::drive(const VehicleState& then, double dt) {
  const PathSegment& now = progress_.segment();
  const Path& path = reference().path;
  const Projection nearest = progress_.nearest(then.pose.position(), config_.search_m);
  if (!(nearest.distance <= config_.lost_beyond_m)) return stop(TrackStatus::kPathLost);
  const double left = progress_.remaining(then.pose, nearest.s);
  if (left <= config_.stop_tolerance_m) return arrive(then);
  progress_.move_to(nearest.s);

  problem_.start << then.pose.x, then.pose.y, then.pose.yaw, then.speed, turn_of(then);
  const double path_yaw = path.at(progress_.inside(nearest.s)).pose.yaw - problem_.slip.side_rad;
  const double heading_error = wrap_angle(then.pose.yaw - path_yaw);
  if (!ackermann()) {
    const double limit =
        mode_ == Mode::kPivoting ? config_.pivot_until_deg : config_.pivot_from_deg;
    mode_ = std::abs(heading_error) > deg_to_rad(limit) ? Mode::kPivoting : Mode::kDriving;
  }
  if (mode_ == Mode::kPivoting) {
    refer_to_pivot(then, heading_error);
  } else {
    refer_to_path(then, now.end_s - left);
  }
  set_bounds(then);
  if (!improve_plan(dt)) return stop(TrackStatus::kSolverFailed);
  return give(first_command(then, dt), TrackStatus::kTracking);
}

TrackOutput HorizonTracker::do_step(const VehicleEstimate& estimate, double dt) {
  if (!is_finite(estimate.state) || !(dt > 0.0 && std::isfinite(dt))) {
    return stop(TrackStatus::kBadState);
  }
  problem_.slip = plausible(estimate.slip);
  const VehicleState then = predict(estimate.state);
  if (mode_ == Mode::kDone) return stop(TrackStatus::kDone);
  if (mode_ == Mode::kStopping) return arrive(then);
  if (mode_ == Mode::kStanding) {
    // A start while driving goes on driving.
    const bool moving_start = !changing_gear_ && std::abs(then.speed) > kStill;
    if (!moving_start && (std::abs(then.speed) > kStill || !ready(then))) return stand(then);
    mode_ = Mode::kDriving;
    changing_gear_ = false;
  }
  return drive(then, dt);
}

}  // namespace headland
