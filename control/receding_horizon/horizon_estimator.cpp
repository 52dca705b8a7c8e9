// SPDX-License-Identifier: Apache-2.0
#include "control/receding_horizon/horizon_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>

#include "control/estimation/ekf_estimator.hpp"

namespace headland {
namespace {

constexpr double kSameTime = 1e-9;        // [s]
constexpr double kLeastVariance = 1e-10;  // of the pose over a block that stands [m2, rad2]
constexpr double kLeastSlip = 1e-12;      // and of the slip
constexpr double kBoundWeight = 1e8;      // of a slip beyond its bound, squared

// Slower, the slip shows too little in the measurements to look for steps of it [m/s].
constexpr double kSlowest = 0.3;

// Lengths of the blocks of a full window, oldest first.
std::vector<int> block_lengths(const HorizonEstimatorConfig& config, int intervals) {
  if (config.blocking == NoiseBlocking::kNone) {
    return std::vector<int>(static_cast<std::size_t>(intervals), 1);
  }
  std::vector<int> lengths;  // newest first
  const int even = std::max(1, (intervals + config.blocks_count - 1) / config.blocks_count);
  int longer = 1;
  int shorter = 0;
  for (int left = intervals; left > 0;) {
    const int wanted = config.blocking == NoiseBlocking::kUniform ? even : longer;
    lengths.push_back(std::min(left, wanted));
    left -= lengths.back();
    longer += std::exchange(shorter, longer);  // 1, 1, 2, 3, 5, ...
  }
  std::reverse(lengths.begin(), lengths.end());
  return lengths;
}

}  // namespace

struct HorizonEstimator::Chain {
  EstimateVector state;
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Identity();
  MotionModel::Jacobian<double> by_begin = MotionModel::Jacobian<double>::Zero();
  MotionModel::Jacobian<double> by_end = MotionModel::Jacobian<double>::Zero();
  Within at;

  // Moves on for `dt` [s] until the drive is that of `next`.
  void move(const MotionModel& motion, const Within& next, double dt) {
    MotionModel::Jacobian<double> from;
    MotionModel::Jacobian<double> to;
    const Eigen::Vector3d moved = motion.displacement<double>(at.drive, next.drive, dt, from, to);
    const double c = std::cos(state(2));
    const double s = std::sin(state(2));
    Eigen::Matrix3d turned;
    turned << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
    const Eigen::Vector3d step = turned * moved;
    const auto swing = [&step](auto& jacobian) {  // by the yaw so far
      jacobian.row(0) -= step(1) * jacobian.row(2);
      jacobian.row(1) += step(0) * jacobian.row(2);
    };
    swing(by_pose);
    swing(by_begin);
    swing(by_end);
    by_begin += turned * (from * at.by_begin.asDiagonal() + to * next.by_begin.asDiagonal());
    by_end += turned * (at.by_end * from + next.by_end * to);
    state.head<3>() += step;
    state.tail<kDriveSize>() = next.drive;
    at = next;
  }
};

HorizonEstimator::HorizonEstimator(const Vehicle& vehicle, const EstimationConfig& model,
                                   const HorizonEstimatorConfig& config, double cycle)
    : model_(vehicle, model),
      config_(config),
      log_(vehicle, cycle, config.window_s + 2.0 * config.period_s),
      stride_(std::max(1, static_cast<int>(std::lround(config.period_s / cycle)))),
      most_(std::max(1, static_cast<int>(std::lround(config.window_s / (stride_ * cycle))))),
      block_lengths_(block_lengths(config, most_)),
      prior_(model_),
      grid_(static_cast<std::size_t>(most_) + 1, EstimateVector::Zero()),
      answers_(static_cast<std::size_t>(most_) + 1),
      blocks_(block_lengths_.size() + 1) {}

void HorizonEstimator::reset(const VehicleState& start, double now) {
  log_.reset(now);
  newest_ = model_.vector_of(start, {});
  prior_.reset(newest_, model_.first_covariance());
  variance_ = prior_.covariance().diagonal();
  prior_inflation_.setOnes();
  grid_[0] = newest_;
  grid_length_ = 0;
  solved_at_ = 0;
}

// After a failure: the window begins again with the prior, and that with what is known by heart.
void HorizonEstimator::restart() {
  if (!prior_.finite()) prior_.reset(newest_, model_.first_covariance());
  prior_inflation_.setOnes();
  grid(0) = prior_.state();
  grid_length_ = 0;
}

// The window's begin moves on: the prior filters what leaves it, and knows of steps from the
// smoothed window.
void HorizonEstimator::advance_base() {
  const long base = log_.now() - static_cast<long>(most_) * stride_;
  if (base <= log_.base()) return;
  log_.replay(prior_, base, prior_inflation_);
  const auto left = static_cast<std::ptrdiff_t>((base - log_.base()) / stride_);
  log_.forget_before(base);
  const auto kept = std::min<std::ptrdiff_t>(left, grid_length_);
  std::rotate(grid_.begin(), grid_.begin() + kept, grid_.begin() + grid_length_ + 1);
  grid_length_ -= static_cast<int>(kept);
}

// Blocks by their distance from now: those of a full window, the oldest cut off while it fills.
void HorizonEstimator::lay_blocks() {
  int left = length();
  int count = 0;
  for (auto it = block_lengths_.rbegin(); it != block_lengths_.rend() && left > 0; ++it, ++count) {
    left -= *it;
  }
  block_count_ = count;
  int end = length();
  for (int b = count - 1; b >= 0; --b) {
    const int wanted = *(block_lengths_.rbegin() + (count - 1 - b));
    block(b).last = end;
    block(b).first = end = std::max(0, end - wanted);
    block(b).trust.setOnes();
  }
  block(count).first = block(count).last = length();
}

// The trajectory of the last solve, and from its end on what the commands promise.
void HorizonEstimator::guess_grid() {
  for (int j = grid_length_; j < length(); ++j) {
    EstimateVector state = grid(j);
    for (int i = 0; i < stride_; ++i) {
      state = model_.coast(state, log_.acting(log_.base() + j * stride_ + i), log_.cycle());
    }
    grid(j + 1) = state;
  }
  grid_length_ = length();
}

// How speed and turn answer to the commands from each block's begin on.
void HorizonEstimator::guess_answers() {
  for (int b = 0; b < block_count_; ++b) {
    const Eigen::Vector2d before = grid(block(b).first).segment<2>(3);
    ActuatorAnswer sum;
    for (int j = block(b).first; j < block(b).last; ++j) {
      for (int i = 0; i < stride_; ++i) {
        const Command& acting = log_.acting(log_.base() + j * stride_ + i);
        const ActuatorAnswer one = model_.answer(before + sum.change, acting, log_.cycle());
        sum.change += one.change;
        sum.keep = sum.keep.cwiseProduct(one.keep);
      }
      answers_[static_cast<std::size_t>(j) + 1] = sum;  // a block's end keeps its own sum
    }
  }
}

// What the commands make of the drive at the block's begin, and the noise's even share.
HorizonEstimator::Within HorizonEstimator::within(const Block& b, int j, double fraction) const {
  const auto i = static_cast<std::size_t>(j);
  const auto at = [this](int k) { return grid_[static_cast<std::size_t>(k)].tail<kDriveSize>(); };
  const ActuatorAnswer begin = j == b.first ? ActuatorAnswer{} : answers_[i];
  const ActuatorAnswer& end = answers_[static_cast<std::size_t>(b.last)];
  Within result;
  result.by_end = (j - b.first + fraction) / (b.last - b.first);
  Drive<double> noise = at(b.last) - at(b.first);
  noise.head<2>() -= end.change;
  result.drive = at(b.first) + result.by_end * noise;
  result.drive.head<2>() += begin.change + fraction * (answers_[i + 1].change - begin.change);
  result.by_begin.setConstant(1.0 - result.by_end);
  result.by_begin.head<2>() =
      begin.keep + fraction * (answers_[i + 1].keep - begin.keep) - result.by_end * end.keep;
  return result;
}

void HorizonEstimator::linearise() {
  for (int b = 0; b <= block_count_; ++b) {
    block(b).own.setZero();
    block(b).coupling.setZero();
    block(b).slope.setZero();
  }
  EstimateVector off = grid(0) - prior_.state();
  off(2) = wrap_angle(off(2));
  const EstimateMatrix information = prior_.covariance().llt().solve(EstimateMatrix::Identity());
  block(0).own += information;
  block(0).slope += information * off;
  next_measurement_ = log_.measurements().begin();
  for (int b = 0; b < block_count_; ++b) add_block(block(b), block(b + 1));
  for (int b = 0; b <= block_count_; ++b) add_bounds(block(b));
}

void HorizonEstimator::add_block(Block& begin, Block& end) {
  Chain chain;
  chain.state = grid(begin.first);
  chain.at = within(begin, begin.first, 0.0);
  for (int j = begin.first; j < begin.last; ++j) add_measurements(begin, end, j, chain);
  add_transition(begin, end, chain);
}

// Moves the chain through interval j and takes the measurements in it.
void HorizonEstimator::add_measurements(Block& from, Block& to, int j, Chain& chain) {
  const double interval = stride_ * log_.cycle();
  const double time = log_.time(log_.base() + static_cast<long>(j) * stride_);
  double at = 0.0;  // fraction of the interval
  const auto move_to = [&](double fraction) {
    const double dt = (fraction - at) * interval;
    if (dt <= kSameTime) return;
    chain.move(model_.motion(), within(from, j, fraction), dt);
    at = fraction;
  };
  const auto last = log_.measurements().end();
  for (; next_measurement_ != last && next_measurement_->time <= time + interval + kSameTime;
       ++next_measurement_) {
    move_to(std::clamp((next_measurement_->time - time) / interval, 0.0, 1.0));
    const MeasurementModel seen =
        model_measurement(model_.motion(), chain.state, *next_measurement_);
    const double weight = 1.0 / model_.variance(*next_measurement_);
    for (int i = 0; i < seen.size; ++i) {
      const Eigen::Matrix<double, 1, 3> pose = seen.by_state.row(i).head<3>();
      const Eigen::Matrix<double, 1, kDriveSize> drive = seen.by_state.row(i).tail<kDriveSize>();
      EstimateVector by_from;
      by_from << (pose * chain.by_pose).transpose(),
          (pose * chain.by_begin + drive * chain.at.by_begin.asDiagonal()).transpose();
      const Drive<double> by_to = (pose * chain.by_end + chain.at.by_end * drive).transpose();
      from.own += weight * by_from * by_from.transpose();
      from.coupling.rightCols<kDriveSize>() += weight * by_from * by_to.transpose();
      to.own.bottomRightCorner<kDriveSize, kDriveSize>() += weight * by_to * by_to.transpose();
      from.slope -= weight * seen.residual(i) * by_from;
      to.slope.tail<kDriveSize>() -= weight * seen.residual(i) * by_to;
    }
  }
  move_to(1.0);
}

// What the block's end is off from where its begin leads, against the noise.
void HorizonEstimator::add_transition(Block& begin, Block& end, const Chain& chain) {
  const double dt = (begin.last - begin.first) * stride_ * log_.cycle();
  EstimateVector variance = model_.noise(chain.state, dt);
  variance.head<3>() = variance.head<3>().cwiseMax(kLeastVariance);
  variance.tail<3>() = variance.tail<3>().cwiseMax(kLeastSlip);
  EstimateVector weight = variance.cwiseInverse();
  weight.tail<3>() = weight.tail<3>().cwiseProduct(begin.trust);
  EstimateVector off;
  off.head<3>() = grid(begin.last).head<3>() - chain.state.head<3>();
  off.tail<kDriveSize>() =
      grid(begin.last).tail<kDriveSize>() - grid(begin.first).tail<kDriveSize>();
  const ActuatorAnswer& answer = answers_[static_cast<std::size_t>(begin.last)];
  off.segment<2>(3) -= answer.change;
  off(2) = wrap_angle(off(2));
  EstimateMatrix by_begin = EstimateMatrix::Zero();
  by_begin.topLeftCorner<3, 3>() = -chain.by_pose;
  by_begin.topRightCorner<3, kDriveSize>() = -chain.by_begin;
  by_begin.diagonal().segment<2>(3) = -answer.keep;
  by_begin.diagonal().tail<3>().setConstant(-1.0);
  EstimateMatrix by_end = EstimateMatrix::Identity();
  by_end.topRightCorner<3, kDriveSize>() = -chain.by_end;
  const EstimateMatrix weighted = weight.asDiagonal() * by_end;
  begin.own += by_begin.transpose() * weight.asDiagonal() * by_begin;
  begin.coupling += by_begin.transpose() * weighted;
  end.own += by_end.transpose() * weighted;
  const EstimateVector pull = weight.cwiseProduct(off);
  begin.slope += by_begin.transpose() * pull;
  end.slope += by_end.transpose() * pull;
}

void HorizonEstimator::add_bounds(Block& at) {
  for (int i = 0; i < 3; ++i) {
    const double slip = grid(at.first)(5 + i);
    const double beyond =
        slip - std::clamp(slip, -model_.slip_bounds()(i), model_.slip_bounds()(i));
    if (beyond == 0.0) continue;
    at.own(5 + i, 5 + i) += kBoundWeight;
    at.slope(5 + i) += kBoundWeight * beyond;
  }
}

// Block-tridiagonal elimination forwards, substitution backwards. False without a finite answer.
bool HorizonEstimator::solve_steps() {
  for (int b = 0; b < block_count_; ++b) {
    const Eigen::LLT<EstimateMatrix> factor(block(b).own);
    if (factor.info() != Eigen::Success) return false;
    // own^-1 coupling, and own^-1 slope.
    const EstimateMatrix gain = factor.solve(block(b).coupling);
    const EstimateVector step = factor.solve(block(b).slope);
    block(b + 1).own -= block(b).coupling.transpose() * gain;
    block(b + 1).slope -= block(b).coupling.transpose() * step;
    block(b).coupling = gain;
    block(b).step = -step;
  }
  Block& last = block(block_count_);
  const Eigen::LLT<EstimateMatrix> factor(last.own);
  if (factor.info() != Eigen::Success) return false;
  last.step = -factor.solve(last.slope);
  variance_ = factor.solve(EstimateMatrix::Identity()).diagonal();
  for (int b = block_count_ - 1; b >= 0; --b) {
    block(b).step -= block(b).coupling * block(b + 1).step;
  }
  return last.step.allFinite() && variance_.allFinite();
}

// The states at the blocks' borders, and between them what follows from these.
void HorizonEstimator::take_steps() {
  for (int b = 0; b <= block_count_; ++b) grid(block(b).first) += block(b).step;
  const double interval = stride_ * log_.cycle();
  for (int b = 0; b < block_count_; ++b) {
    Pose2 pose{grid(block(b).first)(0), grid(block(b).first)(1), grid(block(b).first)(2)};
    Drive<double> drive = grid(block(b).first).tail<kDriveSize>();
    for (int j = block(b).first; j + 1 < block(b).last; ++j) {
      const Drive<double> next = within(block(b), j, 1.0).drive;
      const Eigen::Vector3d moved = model_.motion().displacement<double>(drive, next, interval);
      pose = pose * Pose2{moved(0), moved(1), moved(2)};
      grid(j + 1) << pose.x, pose.y, pose.yaw, next;
      drive = next;
    }
  }
}

// Student's t: the larger a change of the slip came out, the less it is held against it.
void HorizonEstimator::weigh_changes() {
  const double freedom = config_.tail_freedom_count;
  if (freedom <= 0.0) return;
  for (int b = 0; b < block_count_; ++b) {
    const double dt = (block(b).last - block(b).first) * stride_ * log_.cycle();
    const EstimateVector variance = model_.noise(grid(block(b).first), dt);
    const EstimateVector change = grid(block(b).last) - grid(block(b).first);
    for (int i = 0; i < 3; ++i) {
      const double size = change(5 + i) * change(5 + i) / std::max(variance(5 + i), kLeastSlip);
      block(b).trust(i) = (freedom + 1.0) / (freedom + size);
    }
  }
}

// Weights near zero at first where no change was known yet: from there, iterating finds a step that
// the data show; from a weight of one it would hold on to no change (graduated non-convexity).
void HorizonEstimator::doubt_the_newest() {
  if (config_.tail_freedom_count <= 0.0) return;
  const double fresh = config_.fresh_s / (stride_ * log_.cycle());
  for (int b = 0; b < block_count_; ++b) {
    if (length() - block(b).first > fresh + 0.5) continue;
    if (std::abs(grid(block(b).first)(3)) < kSlowest) continue;
    block(b).trust = block(b).trust.cwiseMin(config_.fresh_weight);
  }
}

Estimate HorizonEstimator::update(std::span<const Measurement> measured, const Command& last,
                                  double now) {
  log_.take(measured, last, now);
  bool good = true;
  if (log_.now() >= solved_at_ + stride_) {
    advance_base();
    guess_grid();
    lay_blocks();
    weigh_changes();
    doubt_the_newest();
    for (int i = 0; good && i < config_.iterations_count; ++i) {
      guess_answers();
      linearise();
      good = solve_steps();
      if (!good) break;
      take_steps();
      weigh_changes();
    }
    prior_inflation_ = block(0).trust.cwiseInverse();
    solved_at_ = log_.base() + static_cast<long>(length()) * stride_;
    if (good) newest_ = grid(length());
  }
  EstimateVector state = newest_;
  for (long cycle = solved_at_; cycle < log_.now(); ++cycle) {
    state = model_.coast(state, log_.acting(cycle), log_.cycle());
  }
  model_.keep_bounds(state);
  Estimate estimate = make_estimate(model_, log_, state, variance_.cwiseMax(0.0));
  if (!good) {
    estimate.status = EstimateStatus::kFailed;
    restart();
  }
  return estimate;
}

}  // namespace headland
