// SPDX-License-Identifier: Apache-2.0
#include "local_planner/mcts/internal/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Core>
#include <Eigen/LU>

namespace headland::mcts {
namespace {

constexpr float kFarAway = 1e6F;    // where the padding stands [m]
constexpr double kLingers = 0.5;    // slower agents may still be there later [m/s]
constexpr double kStanding = 0.05;  // slower, the robot touches nobody: it is touched [m/s]

using Lanes = Eigen::Array4f;

Eigen::Map<const Lanes> lanes(const std::vector<float>& values, std::size_t at) {
  return Eigen::Map<const Lanes>(values.data() + at);
}

}  // namespace

void Forecast::set(const Prediction& prediction, std::span<const Agent> now, const Point2& origin,
                   double robot_radius, const MctsConfig& config) {
  origin_ = origin;
  levels_ = prediction.steps;
  influence_ = config.influence_m;
  std::vector<int> chosen(static_cast<std::size_t>(prediction.agents()));
  std::iota(chosen.begin(), chosen.end(), 0);
  std::vector<Point2> start(chosen.size());
  for (std::size_t a = 0; a < chosen.size(); ++a) {
    start[a] = prediction.mean[prediction.index(static_cast<int>(a), 0)];
    for (const Agent& agent : now) {
      if (agent.id == prediction.ids[a]) start[a] = agent.position;
    }
  }
  const auto distance = [&](int a) { return (start[static_cast<std::size_t>(a)] - origin).norm(); };
  std::erase_if(chosen, [&](int a) { return !(distance(a) <= config.view_m); });
  std::stable_sort(chosen.begin(), chosen.end(),
                   [&](int a, int b) { return distance(a) < distance(b); });
  if (static_cast<int>(chosen.size()) > config.agents_count) {
    chosen.resize(static_cast<std::size_t>(config.agents_count));
  }
  count_ = static_cast<int>(chosen.size());
  padded_ = (count_ + 3) / 4 * 4;
  const auto cells = static_cast<std::size_t>(padded_) * static_cast<std::size_t>(levels_ + 1);
  x_.assign(cells, kFarAway);
  y_.assign(cells, kFarAway);
  uncertainty_.assign(cells, 0.0F);
  rim_.assign(static_cast<std::size_t>(padded_), 0.0F);
  scale_.assign(static_cast<std::size_t>(padded_), 1.0F);
  lingers_.assign(static_cast<std::size_t>(padded_), 0.0F);
  ids_.clear();
  for (int i = 0; i < count_; ++i) {
    const int a = chosen[static_cast<std::size_t>(i)];
    const auto column = static_cast<std::size_t>(i);
    ids_.push_back(prediction.ids[static_cast<std::size_t>(a)]);
    const double reach = robot_radius + prediction.radius_m[static_cast<std::size_t>(a)];
    const double rim = reach + config.clearance_m;
    rim_[column] = static_cast<float>(rim * rim);
    scale_[column] = static_cast<float>(1.0 / (rim * rim - reach * reach));
    if (levels_ > 0) {
      const Point2 way =
          prediction.mean[prediction.index(a, levels_ - 1)] - start[static_cast<std::size_t>(a)];
      const double speed = way.norm() / (levels_ * prediction.step_s);
      lingers_[column] = static_cast<float>(std::max(0.0, 1.0 - speed / kLingers));
    }
    for (int level = 0; level <= levels_; ++level) {
      const Point2 p = level == 0 ? start[static_cast<std::size_t>(a)]
                                  : prediction.mean[prediction.index(a, level - 1)];
      x_[row(level) + column] = static_cast<float>(p.x() - origin.x());
      y_[row(level) + column] = static_cast<float>(p.y() - origin.y());
      if (level == 0) continue;
      const double det = prediction.covariance[prediction.index(a, level - 1)].determinant();
      uncertainty_[row(level) + column] = static_cast<float>(std::sqrt(std::max(0.0, det)));
    }
  }
  anyone_lingers_ = std::any_of(lingers_.begin(), lingers_.end(), [](float l) { return l > 0.0F; });
  weight_.resize(static_cast<std::size_t>(levels_) + 1);
  for (int level = 0; level <= levels_; ++level) {
    weight_[static_cast<std::size_t>(level)] =
        static_cast<float>(config.risk_ratio * std::exp(-level * config.step_s / config.trust_s));
  }
}

StepRisk Forecast::step(int level, double ax, double ay, double bx, double by, double speed) const {
  const auto fax = static_cast<float>(ax);
  const auto fay = static_cast<float>(ay);
  const auto fbx = static_cast<float>(bx);
  const auto fby = static_cast<float>(by);
  Lanes sum = Lanes::Zero();
  Lanes most = Lanes::Zero();
  const std::size_t before = row(level);
  const std::size_t after = row(level + 1);
  for (std::size_t i = 0; i < static_cast<std::size_t>(padded_); i += 4) {
    // Relative motion from d to d + e: where it is nearest to the origin.
    const Lanes dx = lanes(x_, before + i) - fax;
    const Lanes dy = lanes(y_, before + i) - fay;
    const Lanes ex = lanes(x_, after + i) - fbx - dx;
    const Lanes ey = lanes(y_, after + i) - fby - dy;
    const Lanes t = (-(dx * ex + dy * ey) / (ex * ex + ey * ey + 1e-9F)).max(0.0F).min(1.0F);
    const Lanes nx = dx + t * ex;
    const Lanes ny = dy + t * ey;
    const Lanes inside =
        ((lanes(rim_, i) - nx * nx - ny * ny) * lanes(scale_, i)).max(0.0F).min(2.0F);
    sum += inside * inside;
    most = most.max(inside);
  }
  const float cost = (sum(0) + sum(1)) + (sum(2) + sum(3));
  StepRisk risk;
  risk.cost = static_cast<double>(cost * weight_[static_cast<std::size_t>(level)]);
  risk.contact = most.maxCoeff() > 1.0F && std::abs(speed) > kStanding;
  return risk;
}

double Forecast::obstruction(double ax, double ay, double bx, double by) const {
  if (!anyone_lingers_) return 0.0;
  const auto fax = static_cast<float>(ax);
  const auto fay = static_cast<float>(ay);
  const auto ex = static_cast<float>(bx - ax);
  const auto ey = static_cast<float>(by - ay);
  const float per_length2 = 1.0F / (ex * ex + ey * ey + 1e-9F);
  Lanes most = Lanes::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(padded_); i += 4) {
    const Lanes dx = lanes(x_, row(levels_) + i) - fax;
    const Lanes dy = lanes(y_, row(levels_) + i) - fay;
    const Lanes t = ((dx * ex + dy * ey) * per_length2).max(0.0F).min(1.0F);
    const Lanes nx = dx - t * ex;
    const Lanes ny = dy - t * ey;
    const Lanes inside = ((lanes(rim_, i) - nx * nx - ny * ny) * lanes(scale_, i)).min(1.0F);
    most = most.max(inside * lanes(lingers_, i));
  }
  return static_cast<double>(most.maxCoeff());
}

double Forecast::seed_cost(int level, double x, double y) const {
  double sum = 0.0;
  for (int i = 0; i < count_; ++i) {
    const std::size_t cell = row(level) + static_cast<std::size_t>(i);
    const double distance =
        std::hypot(static_cast<double>(x_[cell]) - x, static_cast<double>(y_[cell]) - y);
    if (distance <= influence_) {
      sum += static_cast<double>(uncertainty_[cell]) / std::max(distance, 0.1);
    }
  }
  return sum;
}

bool Forecast::expected(int id, double level, Point2& position) const {
  const auto found = std::find(ids_.begin(), ids_.end(), id);
  if (found == ids_.end() || levels_ == 0) return false;
  const auto column = static_cast<std::size_t>(found - ids_.begin());
  const int before = std::clamp(static_cast<int>(level), 0, levels_ - 1);
  const double ratio = level - before;
  const std::size_t a = row(before) + column;
  const std::size_t b = row(before + 1) + column;
  const auto mix = [ratio](float from, float to) {
    return static_cast<double>(from) + ratio * static_cast<double>(to - from);
  };
  position = origin_ + Point2(mix(x_[a], x_[b]), mix(y_[a], y_[b]));
  return true;
}

}  // namespace headland::mcts
