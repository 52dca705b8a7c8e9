// SPDX-License-Identifier: Apache-2.0
#include "perception/localization/first_heading.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr std::size_t kMostPairs = 64;
constexpr int kLeastPairs = 4;
constexpr int kRounds = 10;       // of re-weighting
constexpr double kDoubted = 1.5;  // residuals are doubted beyond this many deviations
constexpr double kSure = 6.0;     // of the yaw [deg]

Eigen::Matrix2d rotation(double yaw) {
  Eigen::Matrix2d turn;
  turn << std::cos(yaw), -std::sin(yaw), std::sin(yaw), std::cos(yaw);
  return turn;
}

}  // namespace

FirstHeading::FirstHeading(const Point2& antenna) : antenna_(antenna) {
  pairs_.reserve(kMostPairs);
}

FirstHeading::Fit FirstHeading::fit() const {
  Fit fit;
  for (const Pair& pair : pairs_) {
    fit.weight += pair.weight;
    fit.mean_odom += pair.weight * pair.p_odom;
    fit.mean_map += pair.weight * pair.p_map;
  }
  fit.mean_odom /= fit.weight;
  fit.mean_map /= fit.weight;
  double along = 0.0;
  double across = 0.0;
  for (const Pair& pair : pairs_) {
    const Point2 a = pair.p_odom - fit.mean_odom;
    const Point2 b = pair.p_map - fit.mean_map;
    along += pair.weight * a.dot(b);
    across += pair.weight * (a.x() * b.y() - a.y() * b.x());
    fit.spread += pair.weight * a.squaredNorm();
  }
  fit.yaw = std::atan2(across, along);
  return fit;
}

void FirstHeading::reweight(const Fit& fit) {
  const Eigen::Matrix2d turn = rotation(fit.yaw);
  for (Pair& pair : pairs_) {
    const double off =
        (turn * (pair.p_odom - fit.mean_odom) + fit.mean_map - pair.p_map).norm() / pair.deviation;
    pair.weight = std::min(1.0, kDoubted / std::max(off, 1e-9)) / (pair.deviation * pair.deviation);
  }
}

std::optional<FirstHeading::Found> FirstHeading::add(const Point2& fix, double deviation) {
  if (pairs_.size() == kMostPairs) {  // every second one makes room: the whole way stays covered
    for (std::size_t i = 0; i < kMostPairs / 2; ++i) pairs_[i] = pairs_[2 * i];
    pairs_.resize(kMostPairs / 2);
  }
  pairs_.push_back({T_odom_base_ * antenna_, fix, deviation, 1.0 / (deviation * deviation)});
  if (pairs_.size() < kLeastPairs) return std::nullopt;
  for (Pair& pair : pairs_) pair.weight = 1.0 / (pair.deviation * pair.deviation);
  Fit found = fit();
  for (int round = 0; round < kRounds; ++round) {
    reweight(found);
    found = fit();
  }
  // Residuals larger than their deviations say how wrong those are.
  const Eigen::Matrix2d turn = rotation(found.yaw);
  double squares = 0.0;
  for (const Pair& pair : pairs_) {
    const Point2 off = turn * (pair.p_odom - found.mean_odom) + found.mean_map - pair.p_map;
    squares += pair.weight * off.squaredNorm();
  }
  const double excess = std::max(1.0, squares / (2.0 * static_cast<double>(pairs_.size()) - 3.0));
  const double yaw_variance = excess / std::max(found.spread, 1e-9);
  if (std::sqrt(yaw_variance) > deg_to_rad(kSure)) return std::nullopt;
  Found result;
  const Point2 arm = T_odom_base_.position() - found.mean_odom;
  const Point2 place = turn * arm + found.mean_map;
  result.T_map_base = {place.x(), place.y(), wrap_angle(T_odom_base_.yaw + found.yaw)};
  Eigen::Matrix<double, 3, 1> by_yaw;
  by_yaw << turn * Point2{-arm.y(), arm.x()}, 1.0;
  result.covariance = yaw_variance * by_yaw * by_yaw.transpose();
  result.covariance.topLeftCorner<2, 2>().diagonal().array() += excess / found.weight;
  return result;
}

}  // namespace headland
