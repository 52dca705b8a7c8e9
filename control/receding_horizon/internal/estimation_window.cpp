// SPDX-License-Identifier: Apache-2.0
#include "control/receding_horizon/internal/estimation_window.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace headland::control::internal {
namespace {

// Slower, the slip shows too little in the measurements to look for steps of it [m/s].
constexpr double kSlowest = 0.3;

constexpr double kSameTime = 1e-9;        // [s]
constexpr double kLeastVariance = 1e-10;  // of the pose over a block that stands [m2, rad2]
constexpr double kLeastSlip = 1e-12;      // and of the slip
constexpr double kBoundWeight = 1e8;      // of a slip beyond its bound, squared

}  // namespace

struct EstimationWindow::Chain {
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

EstimationWindow::EstimationWindow(const EstimationModel& model, const EstimationLog& log,
                                   int stride, int most, const std::vector<int>& block_lengths)
    : model_(model),
      log_(log),
      stride_(stride),
      block_lengths_(block_lengths),
      grid_(static_cast<std::size_t>(most) + 1, EstimateVector::Zero()),
      answers_(static_cast<std::size_t>(most) + 1),
      blocks_(block_lengths.size() + 1) {}

void EstimationWindow::begin_at(const EstimateVector& state) {
  grid(0) = state;
  grid_length_ = 0;
}

void EstimationWindow::drop_oldest(std::ptrdiff_t intervals) {
  const auto kept = std::min<std::ptrdiff_t>(intervals, grid_length_);
  std::rotate(grid_.begin(), grid_.begin() + kept, grid_.begin() + grid_length_ + 1);
  grid_length_ -= static_cast<int>(kept);
}

void EstimationWindow::extend() {
  guess_grid();
  lay_blocks();
}

// Blocks by their distance from now: those of a full window, the oldest cut off while it fills.
void EstimationWindow::lay_blocks() {
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
void EstimationWindow::guess_grid() {
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
void EstimationWindow::guess_answers() {
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
EstimationWindow::Within EstimationWindow::within(const NoiseBlock& b, int j,
                                                  double fraction) const {
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

void EstimationWindow::linearise(const KalmanFilter& prior) {
  cost_ = 0.0;
  for (int b = 0; b <= block_count_; ++b) {
    block(b).own.setZero();
    block(b).coupling.setZero();
    block(b).slope.setZero();
  }
  EstimateVector off = grid(0) - prior.state();
  off(2) = wrap_angle(off(2));
  const EstimateMatrix information = prior.covariance().llt().solve(EstimateMatrix::Identity());
  block(0).own += information;
  block(0).slope += information * off;
  cost_ += 0.5 * off.dot(information * off);
  next_measurement_ = log_.measurements().begin();
  for (int b = 0; b < block_count_; ++b) add_block(block(b), block(b + 1));
  for (int b = 0; b <= block_count_; ++b) add_bounds(block(b));
}

void EstimationWindow::add_block(NoiseBlock& begin, NoiseBlock& end) {
  Chain chain;
  chain.state = grid(begin.first);
  chain.at = within(begin, begin.first, 0.0);
  for (int j = begin.first; j < begin.last; ++j) add_measurements(begin, end, j, chain);
  add_transition(begin, end, chain);
}

// Moves the chain through interval j and takes the measurements in it.
void EstimationWindow::add_measurements(NoiseBlock& from, NoiseBlock& to, int j, Chain& chain) {
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
      cost_ += 0.5 * weight * seen.residual(i) * seen.residual(i);
      from.slope -= weight * seen.residual(i) * by_from;
      to.slope.tail<kDriveSize>() -= weight * seen.residual(i) * by_to;
    }
  }
  move_to(1.0);
}

// What the block's end is off from where its begin leads, against the noise.
void EstimationWindow::add_transition(NoiseBlock& begin, NoiseBlock& end, const Chain& chain) {
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
  cost_ += 0.5 * off.dot(pull);
  begin.slope += by_begin.transpose() * pull;
  end.slope += by_end.transpose() * pull;
}

void EstimationWindow::add_bounds(NoiseBlock& at) {
  for (int i = 0; i < 3; ++i) {
    const double slip = grid(at.first)(5 + i);
    const double beyond =
        slip - std::clamp(slip, -model_.slip_bounds()(i), model_.slip_bounds()(i));
    if (beyond == 0.0) continue;
    at.own(5 + i, 5 + i) += kBoundWeight;
    at.slope(5 + i) += kBoundWeight * beyond;
    cost_ += 0.5 * kBoundWeight * beyond * beyond;
  }
}

// Block-tridiagonal elimination forwards, substitution backwards. False without a finite answer.
bool EstimationWindow::solve_steps() {
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
  NoiseBlock& last = block(block_count_);
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
void EstimationWindow::take_steps() {
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
void EstimationWindow::weigh_changes(double freedom) {
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
void EstimationWindow::doubt_the_newest(double seconds, double weight) {
  const double fresh = seconds / (stride_ * log_.cycle());
  for (int b = 0; b < block_count_; ++b) {
    if (length() - block(b).first > fresh + 0.5) continue;
    if (std::abs(grid(block(b).first)(3)) < kSlowest) continue;
    block(b).trust = block(b).trust.cwiseMin(weight);
  }
}

bool EstimationWindow::improve(const KalmanFilter& prior) {
  guess_answers();
  linearise(prior);
  if (!solve_steps()) return false;
  take_steps();
  return true;
}

}  // namespace headland::control::internal
