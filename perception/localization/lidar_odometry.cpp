// SPDX-License-Identifier: Apache-2.0
#include "perception/localization/lidar_odometry.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "perception/localization/internal/rotation.hpp"

namespace headland {
namespace {

using Filter = internal::InertialFilter;

constexpr std::size_t kMostReadings = 4000;  // waiting for a scan
constexpr double kStep = 0.01;               // of the way within a scan [s]
constexpr double kSlice = 0.001;             // points shot within it share a pose [s]
constexpr double kLongestScan = 1.0;         // [s]
constexpr double kImuSilence = 0.5;          // after that there is no inertial unit [s]
constexpr double kLongestGap = 5.0;          // that is carried over step by step [s]
constexpr int kLevelReadings = 5;            // at least, to find gravity before the first scan
constexpr int kLeastMatches = 30;
constexpr double kTurnArm = 3.0;     // a point so far away that faces a turn counts once [m]
constexpr int kBelieveAgain = 5;     // wheel readings rejected in a row
constexpr double kConverged = 1e-4;  // [m, rad]
constexpr double kBlind = 1.0;       // deviation where the scan says nothing [m]
constexpr double kBlindTurn = 0.1;   // [rad]

double squared(double value) { return value * value; }

Filter::Noise noise_of(const LidarOdometryConfig& config) {
  Filter::Noise noise;
  noise.gyro_radps = config.gyro_noise_radps;
  noise.accelerometer_mps2 = config.accelerometer_noise_mps2;
  return noise;
}

Pose2 planar(const Eigen::Isometry3d& T) {
  return {T.translation().x(), T.translation().y(), std::atan2(T(1, 0), T(0, 0))};
}

template <class Reading>
void insert_by_time(std::vector<Reading>& readings, const Reading& reading) {
  if (readings.size() >= kMostReadings) readings.erase(readings.begin());
  const auto place =
      std::upper_bound(readings.begin(), readings.end(), reading,
                       [](const Reading& a, const Reading& b) { return a.time_s < b.time_s; });
  readings.insert(place, reading);
}

}  // namespace

// The body lies at the inertial unit, with the axes of base.
LidarOdometry::LidarOdometry(const LidarOdometryConfig& config)
    : config_(config), filter_(noise_of(config)), map_(config.map) {
  const Eigen::Isometry3d T_base_imu = config.imu.pose();
  Eigen::Isometry3d T_body_lidar = config.lidar.pose();
  T_body_lidar.translation() -= T_base_imu.translation();
  T_body_lidar_ = T_body_lidar.cast<float>();
  R_body_imu_ = T_base_imu.linear();
  base_in_body_ = -T_base_imu.translation();
}

void LidarOdometry::add_imu(const ImuReading& reading) {
  if (!std::isfinite(reading.time_s) || !reading.angular_rate.allFinite() ||
      !reading.specific_force.allFinite()) {
    return;
  }
  if (started_ && reading.time_s <= time_s_) return;
  insert_by_time(imu_, {reading.time_s, R_body_imu_ * reading.angular_rate,
                        R_body_imu_ * reading.specific_force});
}

void LidarOdometry::add_wheel(double time_s, double speed_mps) {
  if (!std::isfinite(time_s + speed_mps)) return;
  if (started_ && time_s <= time_s_) return;
  insert_by_time(wheels_, {time_s, speed_mps});
}

const OdometryEstimate& LidarOdometry::add_scan(const LidarScan& scan) {
  if (!std::isfinite(scan.time_s)) {
    estimate_.status = OdometryStatus::kInvalid;
    return estimate_;
  }
  double end_s = scan.time_s;
  for (const LidarPoint& point : scan.points) {
    const double offset = point.offset_s;
    if (offset > 0.0 && offset < kLongestScan) end_s = std::max(end_s, scan.time_s + offset);
  }
  if (started_ && end_s <= time_s_) {
    estimate_.status = OdometryStatus::kTimeBackwards;
    return estimate_;
  }
  const bool first = !started_;
  if (first) start(scan.time_s);
  const double before_s = estimate_.time_s;
  const Pose2 before = planar(estimate_.T_odom_base);
  carry_on_to(end_s);
  straighten(scan);
  thinner_.thin(points_, static_cast<float>(config_.map_cell_m), map_points_);
  thinner_.thin(map_points_, static_cast<float>(config_.scan_cell_m), scan_points_);
  OdometryStatus status = OdometryStatus::kFirst;
  if (map_points_.empty()) {
    status = OdometryStatus::kNoPoints;
  } else if (map_.size() > 0) {
    fit_scan();
    status = estimate_.matched < kLeastMatches ? OdometryStatus::kNoPoints
             : estimate_.weak_directions > 0   ? OdometryStatus::kWeak
                                               : OdometryStatus::kGood;
  }
  extend_map();
  report(status, before, first ? end_s : before_s);
  return estimate_;
}

// Level by the mean specific force of the readings so far, where there are some; the speed is the
// wheels'.
void LidarOdometry::start(double time_s) {
  started_ = true;
  time_s_ = time_s;
  Filter::State state;
  Eigen::Vector3d force{0.0, 0.0, 0.0};
  for (const ImuReading& reading : imu_) force += reading.specific_force;
  const bool level = imu_.size() >= kLevelReadings && force.norm() > 1.0;
  if (level) {
    state.R = Eigen::Quaterniond::FromTwoVectors(force, Eigen::Vector3d::UnitZ()).matrix();
  }
  Filter::Vector deviation;
  deviation.segment<3>(Filter::kP).setConstant(1e-4);
  deviation.segment<3>(Filter::kTheta).setConstant(1e-4);
  deviation.segment<3>(Filter::kV).setConstant(wheels_.empty() ? 2.0 : 0.3);
  deviation.segment<3>(Filter::kBg).setConstant(imu_.empty() ? 0.5 : 0.01);
  deviation.segment<3>(Filter::kBa).setConstant(0.1);
  deviation.segment<2>(Filter::kG).setConstant(0.03);
  if (!wheels_.empty()) state.v = state.R * Eigen::Vector3d{wheels_.back().speed_mps, 0.0, 0.0};
  state.p = -(state.R * base_in_body_);
  filter_.reset(state, deviation);
  std::erase_if(imu_, [&](const ImuReading& reading) { return reading.time_s <= time_s; });
  std::erase_if(wheels_, [&](const WheelReading& wheel) { return wheel.time_s <= time_s; });
}

// Through all readings up to a time, in their order.
void LidarOdometry::carry_on_to(double time_s) {
  way_.clear();
  way_.push_back({time_s_, filter_.state().p, Eigen::Quaterniond(filter_.state().R)});
  std::size_t i = 0;
  std::size_t w = 0;
  while (true) {
    const bool imu_due = i < imu_.size() && imu_[i].time_s <= time_s;
    const bool wheel_due = w < wheels_.size() && wheels_[w].time_s <= time_s;
    if (imu_due && (!wheel_due || imu_[i].time_s <= wheels_[w].time_s)) {
      const ImuReading& reading = imu_[i++];
      ImuReading mean = reading;
      if (last_imu_) {
        mean.angular_rate = 0.5 * (reading.angular_rate + last_imu_->angular_rate);
        mean.specific_force = 0.5 * (reading.specific_force + last_imu_->specific_force);
      }
      advance_to(reading.time_s, mean);
      last_imu_ = reading;
    } else if (wheel_due) {
      advance_to(wheels_[w].time_s, last_imu_);
      apply_wheel(wheels_[w++]);
    } else {
      break;
    }
  }
  imu_.erase(imu_.begin(), imu_.begin() + static_cast<std::ptrdiff_t>(i));
  wheels_.erase(wheels_.begin(), wheels_.begin() + static_cast<std::ptrdiff_t>(w));
  if (last_imu_ && time_s - last_imu_->time_s > kImuSilence) last_imu_.reset();
  advance_to(time_s, last_imu_);
}

void LidarOdometry::advance_to(double time_s, std::optional<ImuReading> reading) {
  double rest = time_s - time_s_;
  if (!(rest > 0.0)) return;
  const double step = std::max(kStep, rest / (kLongestGap / kStep));
  while (rest > 0.0) {
    const double dt = rest < 1.5 * step ? rest : step;
    filter_.propagate(reading, dt);
    rest -= dt;
    way_.push_back({time_s - rest, filter_.state().p, Eigen::Quaterniond(filter_.state().R)});
  }
  time_s_ = time_s;
}

void LidarOdometry::apply_wheel(const WheelReading& wheel) {
  const Eigen::Vector3d turn =
      last_imu_ ? last_imu_->angular_rate : Eigen::Vector3d(Eigen::Vector3d::Zero());
  const Eigen::Vector3d deviation{config_.wheel_noise_mps, config_.side_noise_mps,
                                  config_.side_noise_mps};
  const bool gated = wheels_rejected_ < kBelieveAgain;
  const bool used =
      filter_.update_velocity({wheel.speed_mps, 0.0, 0.0}, deviation, base_in_body_, turn, gated);
  wheels_rejected_ = used ? 0 : wheels_rejected_ + 1;
}

// Points to where they would be seen from the body at the scan's end, by the way just gone.
void LidarOdometry::straighten(const LidarScan& scan) {
  const Eigen::Isometry3d T_end = pose();
  const double whole = std::max(time_s_ - scan.time_s, 0.0);
  const auto slices = static_cast<std::size_t>(whole / kSlice) + 1;
  straight_.clear();
  std::size_t node = 0;
  for (std::size_t i = 0; i < slices; ++i) {
    const double t = scan.time_s + (static_cast<double>(i) + 0.5) * kSlice;
    while (node + 2 < way_.size() && way_[node + 1].time_s < t) ++node;
    const Node& a = way_[node];
    const Node& b = way_[std::min(node + 1, way_.size() - 1)];
    const double span = b.time_s - a.time_s;
    const double share = span > 0.0 ? std::clamp((t - a.time_s) / span, 0.0, 1.0) : 1.0;
    Eigen::Isometry3d T_then = Eigen::Isometry3d::Identity();
    T_then.linear() = a.q.slerp(share, b.q).matrix();
    T_then.translation() = a.p + share * (b.p - a.p);
    straight_.push_back((T_end.inverse() * T_then).cast<float>() * T_body_lidar_);
  }
  points_.clear();
  const auto near2 = static_cast<float>(squared(config_.near_m));
  const auto far2 = static_cast<float>(squared(config_.far_m));
  for (const LidarPoint& point : scan.points) {
    const float r2 = point.position.squaredNorm();
    if (!(r2 >= near2 && r2 <= far2)) continue;  // NaN too
    if (!(point.offset_s >= 0.0f && point.offset_s < static_cast<float>(kLongestScan))) continue;
    const auto slice = static_cast<std::size_t>(point.offset_s / static_cast<float>(kSlice));
    points_.push_back(straight_[std::min(slice, slices - 1)] * point.position);
  }
}

// Residual r = mean - (R q + p) of each point q, weighted with the voxel's information L and the
// kernel: sums of H'LH and H'Lr, H = [I, -R [q]x] by the errors of p and R.
LidarOdometry::Match LidarOdometry::match(const Filter::State& state, double kernel) const {
  Match match;
  const Eigen::Matrix3f R = state.R.cast<float>();
  const Eigen::Vector3f p = state.p.cast<float>();
  const auto kernel2 = static_cast<float>(kernel * kernel);
  for (const Eigen::Vector3f& q : scan_points_) {
    const Eigen::Vector3f place = R * q + p;
    const Voxel* voxel = map_.find_informative(place);
    if (voxel == nullptr) continue;
    const Eigen::Vector3f residual = voxel->mean - place;
    const float distance2 = residual.dot(voxel->information * residual);
    const float root = kernel2 / (kernel2 + distance2);
    const Eigen::Matrix3f weight = root * root * voxel->information;
    const Eigen::Matrix3f turned = -R * internal::cross(q.cast<double>()).cast<float>();
    const Eigen::Matrix3f mixed = weight * turned;
    const Eigen::Vector3f pull = weight * residual;
    match.information.topLeftCorner<3, 3>() += weight.cast<double>();
    match.information.topRightCorner<3, 3>() += mixed.cast<double>();
    match.information.bottomRightCorner<3, 3>() += (turned.transpose() * mixed).cast<double>();
    match.vector.head<3>() += pull.cast<double>();
    match.vector.tail<3>() += (turned.transpose() * pull).cast<double>();
    ++match.points;
  }
  match.information.bottomLeftCorner<3, 3>() = match.information.topRightCorner<3, 3>().transpose();
  return match;
}

// What the scan says about the position once the rotation is free, and the reverse: eigenvalues
// tell how many points face each direction; of weak ones nothing is taken.
void LidarOdometry::leave_weak_directions(Match& match) {
  Eigen::Matrix3d position = match.information.topLeftCorner<3, 3>();
  Eigen::Matrix3d rotation = match.information.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d mixed = match.information.topRightCorner<3, 3>();
  const Eigen::Matrix3d least = 1e-3 * Eigen::Matrix3d::Identity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> shifts(
      position - mixed * (rotation + least).inverse() * mixed.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> turns(
      rotation - mixed.transpose() * (position + least).inverse() * mixed);
  const double variance = squared(config_.map.noise_m);
  const double enough = std::max(config_.weak_count, config_.weak_ratio * match.points);
  estimate_.support = shifts.eigenvalues() * variance;
  estimate_.directions = shifts.eigenvectors();
  estimate_.weak_directions = 0;
  Eigen::Matrix<double, 6, 6> keep = Eigen::Matrix<double, 6, 6>::Identity();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d shift = shifts.eigenvectors().col(i);
    const Eigen::Vector3d turn = turns.eigenvectors().col(i);
    if (estimate_.support(i) < enough) {
      ++estimate_.weak_directions;
      keep.topLeftCorner<3, 3>() -= shift * shift.transpose();
    }
    if (turns.eigenvalues()(i) * variance < enough * squared(kTurnArm)) {
      keep.bottomRightCorner<3, 3>() -= turn * turn.transpose();
    }
  }
  match.information = (keep * match.information * keep).eval();
  match.vector = (keep * match.vector).eval();
}

// Adds noise F to what the scan measures: (A^-1 + F)^-1 = (1 + A F)^-1 A, also for a singular A.
void LidarOdometry::blur(Match& match) const {
  using Square = Eigen::Matrix<double, 6, 6>;
  Eigen::Matrix<double, 6, 1> noise;
  noise.head<3>().setConstant(squared(config_.least_position_noise_m));
  noise.tail<3>().setConstant(squared(deg_to_rad(config_.least_rotation_noise_deg)));
  const Square less = (Square::Identity() + match.information * noise.asDiagonal()).inverse();
  match.information = (less * match.information).eval();
  match.information = (0.5 * (match.information + match.information.transpose())).eval();
  match.vector = (less * match.vector).eval();
}

// Gauss-Newton on |x - prior|^2 / P + sum |r|^2 L. The kernel is wide at first if the prediction is
// unsure, so that points a while off still pull.
void LidarOdometry::fit_scan() {
  const Filter::State prior = filter_.state();
  const Filter::Matrix prior_information =
      filter_.covariance().ldlt().solve(Filter::Matrix::Identity());
  const double unsure = std::sqrt(filter_.covariance().diagonal().head<3>().maxCoeff());
  double kernel = config_.kernel_ratio * (1.0 + unsure / 0.05);
  Filter::State state = prior;
  Filter::Matrix information = prior_information;
  for (int i = 0; i < config_.iteration_count; ++i) {
    Match found = match(state, kernel);
    estimate_.matched = found.points;
    if (found.points < kLeastMatches) return;
    leave_weak_directions(found);
    blur(found);
    information = prior_information;
    information.topLeftCorner<6, 6>() += found.information;
    Filter::Vector vector = -prior_information * state.minus(prior);
    vector.head<6>() += found.vector;
    const Filter::Vector step = information.ldlt().solve(vector);
    state = state.plus(step);
    scan_information_ = found.information;
    const bool narrow = kernel == config_.kernel_ratio;
    if (narrow && step.head<6>().cwiseAbs().maxCoeff() < kConverged) break;
    kernel = std::max(config_.kernel_ratio, 0.5 * kernel);
  }
  const Filter::Matrix covariance = information.ldlt().solve(Filter::Matrix::Identity());
  if (!covariance.allFinite() || !state.p.allFinite() || !state.R.allFinite()) {
    estimate_.matched = 0;
    return;
  }
  state.R = Eigen::Quaterniond(state.R).normalized().matrix();
  filter_.set(state, 0.5 * (covariance + covariance.transpose()));
}

void LidarOdometry::extend_map() {
  const Eigen::Isometry3f T_odom_body = pose().cast<float>();
  for (const Eigen::Vector3f& point : map_points_) map_.insert(T_odom_body * point);
  map_.end_scan(T_odom_body.translation());
}

Eigen::Isometry3d LidarOdometry::pose() const {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = filter_.state().R;
  T.translation() = filter_.state().p;
  return T;
}

void LidarOdometry::report(OdometryStatus status, const Pose2& before, double before_s) {
  estimate_.time_s = time_s_;
  estimate_.status = status;
  estimate_.T_odom_base = pose() * Eigen::Translation3d(base_in_body_);
  estimate_.velocity = filter_.state().v;
  if (status == OdometryStatus::kFirst || status == OdometryStatus::kNoPoints) {
    estimate_.matched = 0;
    estimate_.support.setZero();
    estimate_.weak_directions = 3;
    scan_information_.setZero();
  }
  // The covariance of what the two scans said, in the plane and the frame of base.
  const Pose2 now = planar(estimate_.T_odom_base);
  estimate_.motion.begin_s = before_s;
  estimate_.motion.end_s = time_s_;
  estimate_.motion.moved = inverse(before) * now;
  estimate_.motion.moved.yaw = wrap_angle(now.yaw - before.yaw);
  Eigen::Matrix<double, 6, 6> information = scan_information_;
  information.diagonal().head<3>().array() += 1.0 / squared(kBlind);
  information.diagonal().tail<3>().array() += 1.0 / squared(kBlindTurn);
  Eigen::Matrix<double, 3, 6> by_pose = Eigen::Matrix<double, 3, 6>::Zero();
  by_pose.topLeftCorner<2, 2>() << std::cos(now.yaw), std::sin(now.yaw), -std::sin(now.yaw),
      std::cos(now.yaw);
  by_pose(2, 5) = 1.0;
  estimate_.motion.covariance = 2.0 * by_pose * information.inverse() * by_pose.transpose();
}

}  // namespace headland
