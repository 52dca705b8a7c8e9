// SPDX-License-Identifier: Apache-2.0
#include "perception/localization/global_filter.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "perception/localization/internal/kalman.hpp"

namespace headland {
namespace {

// Where what lies in the state: pose, and what the odometry gets wrong.
enum Index { kX = 0, kYaw = 2, kScale, kTurning, kSide };

constexpr int kKept = 400;             // events, for late readings
constexpr double kLongestGuess = 0.5;  // motion goes on as it was for so long [s]
constexpr double kUnknownSpeed = 2.0;  // after that nothing is known but this [m/s]
constexpr double kUnknownTurn = 0.3;   // [rad/s]
constexpr double kReanchorYaw = 5.0;   // what the yaw may be off when the position was [deg]
constexpr double kAgreement = 3.0;     // deviations
constexpr double kReported = 2.0;      // a new anchor is told for so long [s]

double squared(double value) { return value * value; }

Eigen::Matrix2d rotation(double yaw) {
  Eigen::Matrix2d turn;
  turn << std::cos(yaw), -std::sin(yaw), std::sin(yaw), std::cos(yaw);
  return turn;
}

// Motion of a steady turn over a time, from its velocity at the begin: x, y [m/s], yaw [rad/s].
Eigen::Vector3d steady(const Eigen::Vector3d& rate, double dt) {
  const double turned = rate(2) * dt;
  const Eigen::Vector2d chord = rotation(0.5 * turned) * rate.head<2>() * dt;
  return {chord.x(), chord.y(), turned};
}

Eigen::Vector3d steady_rate(const MotionIncrement& increment) {
  const double dt = increment.end_s - increment.begin_s;
  const Pose2& moved = increment.moved;
  const Eigen::Vector2d begin = rotation(-0.5 * moved.yaw) * moved.position();
  return Eigen::Vector3d{begin.x(), begin.y(), moved.yaw} / dt;
}

}  // namespace

double FixNoiseConfig::of(FixQuality quality) const {
  switch (quality) {
    case FixQuality::kSingle:
      return single_m;
    case FixQuality::kDifferential:
      return differential_m;
    case FixQuality::kFloat:
      return float_m;
    case FixQuality::kFixed:
      return fixed_m;
    case FixQuality::kUnknown:
      break;
  }
  return unknown_m;
}

GlobalFilter::GlobalFilter(const GlobalFilterConfig& config)
    : config_(config),
      replay_(config.replay_s, kKept),
      first_heading_({config.antenna_x_m, config.antenna_y_m}) {}

GlobalFilter::Vector GlobalFilter::moved_on(const Vector& state, const Eigen::Vector3d& moved,
                                            double dt, Matrix& by_state,
                                            Eigen::Matrix<double, kSize, 3>& by_moved) {
  const double course = state(kYaw) - 0.5 * dt * state(kTurning) + state(kSide);
  const Eigen::Matrix2d turn = rotation(course);
  const Eigen::Vector2d told = turn * moved.head<2>();
  const Eigen::Vector2d step = (1.0 + state(kScale)) * told;
  const Eigen::Vector2d across{-step.y(), step.x()};
  Vector after = state;
  after.segment<2>(kX) += step;
  after(kYaw) += moved(2) - dt * state(kTurning);
  by_state.setIdentity();
  by_state.block<2, 1>(kX, kYaw) = across;
  by_state.block<2, 1>(kX, kScale) = told;
  by_state.block<2, 1>(kX, kTurning) = -0.5 * dt * across;
  by_state.block<2, 1>(kX, kSide) = across;
  by_state(kYaw, kTurning) = -dt;
  by_moved.setZero();
  by_moved.topLeftCorner<2, 2>() = (1.0 + state(kScale)) * turn;
  by_moved(kYaw, 2) = 1.0;
  return after;
}

Point2 GlobalFilter::antenna(const Vector& state, const Point2& arm,
                             Eigen::Matrix<double, 2, kSize>& by_state) {
  const Point2 turned = rotation(state(kYaw)) * arm;
  by_state.setZero();
  by_state.leftCols<2>().setIdentity();
  by_state.col(kYaw) << -turned.y(), turned.x();
  return state.segment<2>(kX) + turned;
}

void GlobalFilter::carry_on(State& state, const Eigen::Vector3d& moved,
                            const Eigen::Matrix3d& covariance, double dt) const {
  Matrix by_state;
  Eigen::Matrix<double, kSize, 3> by_moved;
  const double way = moved.head<2>().norm();
  state.mean = moved_on(state.mean, moved, dt, by_state, by_moved);
  state.covariance = (by_state * state.covariance * by_state.transpose() +
                      by_moved * covariance * by_moved.transpose())
                         .eval();
  auto variance = state.covariance.diagonal();
  variance.segment<2>(kX).array() += squared(config_.position_drift_m) * way;
  variance(kYaw) += squared(deg_to_rad(config_.heading_drift_deg)) * way;
  variance(kScale) += squared(config_.scale_walk_ratio) * dt;
  variance(kTurning) += squared(config_.bias_walk_radps) * dt;
  variance(kSide) += squared(deg_to_rad(config_.side_walk_deg)) * dt;
  state.travelled += way;
  state.time_s += dt;
}

// To a reading that lies after the last increment: the motion goes on.
void GlobalFilter::carry_on_to(State& state, double time_s) const {
  const double dt = time_s - state.time_s;
  if (!(dt > 0.0)) return;
  const double guessed = std::min(dt, kLongestGuess);
  carry_on(state, steady(state.rate, guessed), Eigen::Matrix3d::Zero(), guessed);
  const double unknown = dt - guessed;
  auto variance = state.covariance.diagonal();
  variance.segment<2>(kX).array() += squared(kUnknownSpeed * unknown);
  variance(kYaw) += squared(kUnknownTurn * unknown);
  state.time_s = time_s;
}

// Whether this rejection and those before it say the same.
bool GlobalFilter::agree(Rejected& rejected, const Point2& residual, double deviation) const {
  const int wanted = std::clamp(config_.reanchor_count, 2, Rejected::kMost);
  if (rejected.count == wanted) {
    std::copy(rejected.residual.begin() + 1, rejected.residual.end(), rejected.residual.begin());
    --rejected.count;
  }
  rejected.residual[static_cast<std::size_t>(rejected.count++)] = residual;
  if (rejected.count < wanted) return false;
  Point2 mean{0.0, 0.0};
  for (int i = 0; i < wanted; ++i) mean += rejected.residual[static_cast<std::size_t>(i)] / wanted;
  const double allowed = kAgreement * deviation + 0.05 * mean.norm();
  for (int i = 0; i < wanted; ++i) {
    if ((rejected.residual[static_cast<std::size_t>(i)] - mean).norm() > allowed) return false;
  }
  return true;
}

double GlobalFilter::position_noise(const Measurement& reading) const {
  return std::max(reading.deviation, config_.fix_noise.of(reading.quality));
}

ReadingOutcome GlobalFilter::apply_position(State& state, const Measurement& reading) const {
  const Point2 value{reading.value[0], reading.value[1]};
  if (value == state.last_value) {
    state.frozen = state.travelled - state.last_value_at > config_.frozen_m;
    if (state.frozen) return ReadingOutcome::kFrozen;
    state.last_fix_s = std::max(state.last_fix_s, reading.time);
    return ReadingOutcome::kRepeated;
  }
  state.frozen = false;
  state.last_value = value;
  state.last_value_at = state.travelled;

  internal::Innovation<kSize, 2> seen;
  seen.residual =
      value - antenna(state.mean, {config_.antenna_x_m, config_.antenna_y_m}, seen.by_state);
  const double deviation = position_noise(reading);
  const bool correlated =
      reading.quality != FixQuality::kFixed && reading.quality != FixQuality::kUnknown;
  const double since = std::max(reading.time - state.last_fix_s, 1e-3);
  const double repeats = correlated ? std::max(1.0, config_.correlation_s / since) : 1.0;
  seen.noise = repeats * squared(deviation) * Eigen::Matrix2d::Identity();

  ReadingOutcome outcome = ReadingOutcome::kUsed;
  const double distance = seen.squared_distance(state.covariance);
  if (distance > internal::gate_99(2)) {
    if (!agree(state.positions, seen.residual, deviation)) return ReadingOutcome::kRejected;
    state.covariance.topLeftCorner<2, 2>() += seen.residual * seen.residual.transpose();
    state.covariance(kYaw, kYaw) += squared(deg_to_rad(kReanchorYaw));
    state.anchored_s = reading.time;
    outcome = ReadingOutcome::kReanchored;
  } else if (distance > internal::gate_95(2)) {
    seen.noise *= distance / internal::gate_95(2);
    outcome = ReadingOutcome::kDoubted;
  }
  internal::update<kSize, 2>(state.mean, state.covariance, seen);
  state.positions.count = 0;
  state.last_fix_s = std::max(state.last_fix_s, reading.time);
  return outcome;
}

bool GlobalFilter::heading_fits_baseline(const Measurement& reading) const {
  return config_.baseline_m == 0.0 || reading.value[1] == 0.0 ||
         std::abs(reading.value[1] - config_.baseline_m) <= config_.baseline_tolerance_m;
}

ReadingOutcome GlobalFilter::apply_heading(State& state, const Measurement& reading) const {
  internal::Innovation<kSize, 1> seen;
  seen.residual(0) = wrap_angle(reading.value[0] - state.mean(kYaw));
  seen.by_state.setZero();
  seen.by_state(kYaw) = 1.0;
  const double deviation = std::max(reading.deviation, deg_to_rad(config_.least_heading_noise_deg));
  seen.noise(0) = squared(deviation);
  ReadingOutcome outcome = ReadingOutcome::kUsed;
  const double distance = seen.squared_distance(state.covariance);
  if (distance > internal::gate_99(1)) {
    if (!agree(state.headings, {seen.residual(0), 0.0}, deviation)) {
      return ReadingOutcome::kRejected;
    }
    state.covariance(kYaw, kYaw) += squared(seen.residual(0));
    state.anchored_s = reading.time;
    outcome = ReadingOutcome::kReanchored;
  } else if (distance > internal::gate_95(1)) {
    seen.noise *= distance / internal::gate_95(1);
    outcome = ReadingOutcome::kDoubted;
  }
  internal::update<kSize, 1>(state.mean, state.covariance, seen);
  state.headings.count = 0;
  return outcome;
}

ReadingOutcome GlobalFilter::apply(State& state, const Event& event) const {
  if (event.kind == EventKind::kIncrement) {
    // A reading inside it has carried the state on to its own time: the rest remains.
    const double whole = event.increment.end_s - event.increment.begin_s;
    const double rest = std::clamp(
        event.increment.end_s - std::max(event.increment.begin_s, state.time_s), 0.0, whole);
    if (std::isnan(state.time_s)) state.time_s = event.increment.begin_s;
    carry_on_to(state, event.increment.begin_s);
    state.rate = steady_rate(event.increment);
    carry_on(state, steady(state.rate, rest), event.increment.covariance * (rest / whole), rest);
    return ReadingOutcome::kUsed;
  }
  carry_on_to(state, event.time_s);
  return event.kind == EventKind::kPosition ? apply_position(state, event.reading)
                                            : apply_heading(state, event.reading);
}

void GlobalFilter::start(double time_s, const Pose2& T_map_base,
                         const Eigen::Matrix3d& covariance) {
  State state;
  state.time_s = time_s;
  state.last_fix_s = time_s;
  state.mean.head<3>() << T_map_base.x, T_map_base.y, T_map_base.yaw;
  state.covariance.topLeftCorner<3, 3>() = covariance;
  state.covariance(kScale, kScale) = squared(config_.first_scale_ratio);
  state.covariance(kTurning, kTurning) = squared(config_.first_bias_radps);
  state.covariance(kSide, kSide) = squared(deg_to_rad(config_.first_side_deg));
  replay_.reset(state);
  started_ = true;
}

// Before the start only the newest time counts: late readings wait or start like others.
ReadingOutcome GlobalFilter::try_to_start(const Measurement& reading) {
  if (reading.kind == MeasurementKind::kHeading) {
    waiting_heading_ = reading;
    waiting_motion_ = Pose2{};
    return ReadingOutcome::kWaiting;
  }
  const Point2 fix{reading.value[0], reading.value[1]};
  const Point2 arm{config_.antenna_x_m, config_.antenna_y_m};
  const double deviation = position_noise(reading);
  if (waiting_heading_) {
    const double yaw = waiting_heading_->value[0] + waiting_motion_.yaw;
    const Point2 place = fix - rotation(yaw) * arm;
    const double yaw_deviation =
        std::max(waiting_heading_->deviation, deg_to_rad(config_.least_heading_noise_deg));
    const Eigen::Vector3d variance{squared(deviation), squared(deviation), squared(yaw_deviation)};
    start(reading.time, {place.x(), place.y(), yaw}, variance.asDiagonal());
    return ReadingOutcome::kUsed;
  }
  const auto found = first_heading_.add(fix, deviation);
  if (!found) return ReadingOutcome::kWaiting;
  start(reading.time, found->T_map_base, found->covariance);
  return ReadingOutcome::kUsed;
}

ReadingOutcome GlobalFilter::add_increment(const MotionIncrement& increment) {
  const Pose2& moved = increment.moved;
  const bool usable = increment.end_s > increment.begin_s &&
                      std::isfinite(moved.x + moved.y + moved.yaw) &&
                      increment.covariance.allFinite();
  if (!usable) return ReadingOutcome::kInvalid;
  if (!started_) {
    first_heading_.move(moved);
    waiting_motion_ = waiting_motion_ * moved;
    return ReadingOutcome::kWaiting;
  }
  const auto outcome =
      replay_.add({increment.end_s, EventKind::kIncrement, increment, {}},
                  [this](State& state, const Event& event) { return apply(state, event); });
  return outcome.value_or(ReadingOutcome::kTooOld);
}

ReadingOutcome GlobalFilter::add(const Measurement& reading) {
  const bool position = reading.kind == MeasurementKind::kPosition;
  const bool usable = (position || reading.kind == MeasurementKind::kHeading) &&
                      std::isfinite(reading.time + reading.value[0] + reading.value[1]) &&
                      std::isfinite(reading.deviation);
  if (!usable) return ReadingOutcome::kInvalid;
  if (!position && !heading_fits_baseline(reading)) return ReadingOutcome::kWrongBaseline;
  if (!started_) return try_to_start(reading);
  const auto outcome = replay_.add(
      {reading.time, position ? EventKind::kPosition : EventKind::kHeading, {}, reading},
      [this](State& state, const Event& event) { return apply(state, event); });
  return outcome.value_or(ReadingOutcome::kTooOld);
}

GlobalEstimate GlobalFilter::estimate() const {
  GlobalEstimate estimate;
  if (!started_) {
    const bool fixes = waiting_heading_ || !first_heading_.empty();
    if (fixes && !waiting_heading_) estimate.health.reason = PoseReason::kNoHeading;
    return estimate;
  }
  const State& state = replay_.state();
  estimate.time_s = state.time_s;
  estimate.pose = {state.mean(kX), state.mean(kX + 1), wrap_angle(state.mean(kYaw))};
  estimate.covariance = state.covariance.topLeftCorner<3, 3>();
  estimate.odometry_scale = state.mean(kScale);
  estimate.odometry_turning = state.mean(kTurning);
  estimate.odometry_side = state.mean(kSide);
  const Eigen::Matrix2d spread = estimate.covariance.topLeftCorner<2, 2>();
  const double worst =
      std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvalues()(1));
  PoseHealth& health = estimate.health;
  if (!(worst <= config_.lost_m)) {
    health = {PoseState::kLost, PoseReason::kUncertain};
  } else if (state.time_s - state.last_fix_s > config_.coasting_s) {
    health = {PoseState::kCoasting, state.frozen                ? PoseReason::kFixesFrozen
                                    : state.positions.count > 0 ? PoseReason::kFixesRejected
                                                                : PoseReason::kNoFix};
  } else {
    const bool anchored = state.time_s - state.anchored_s < kReported;
    health = {PoseState::kGood, anchored ? PoseReason::kReanchored : PoseReason::kNone};
  }
  return estimate;
}

}  // namespace headland
