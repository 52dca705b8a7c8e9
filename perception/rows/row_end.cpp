// SPDX-License-Identifier: Apache-2.0
// u, v: along and across the row, from the robot.
#include "perception/rows/row_end.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kLearnBehind = 8.0;     // the stretch that shows what a row hits [m]
constexpr double kLearnAhead = 3.0;      // [m]
constexpr double kStartBehind = 1.0;     // the sum starts here [m]
constexpr double kSeenShare = 0.6;       // of the bins of a gap must have rays
constexpr double kLeastRays = 2.0;       // of a bin with evidence
constexpr float kMostRays = 24.0f;       // of a bin: older ones make room for those from nearer
constexpr double kTilt = 0.015;          // the ground's plane may be off by so much [rad]
constexpr double kOdometryShare = 0.01;  // of the distance, what the end's place may be off

std::size_t wrapped(long long index, std::size_t count) {
  const auto size = static_cast<long long>(count);
  return static_cast<std::size_t>(((index % size) + size) % size);
}

}  // namespace

RowEndFinder::RowEndFinder(const RowEndConfig& config, const Eigen::Vector3d& sensor_base)
    : config_(config), sensor_base_(sensor_base) {
  const auto count =
      static_cast<std::size_t>(std::ceil((config.ahead_m + config.behind_m) / config.bin_m));
  for (auto& side : bins_) side.resize(count);
}

void RowEndFinder::reset(bool keep_end) {
  for (auto& side : bins_) std::fill(side.begin(), side.end(), Bin{});
  if (!keep_end) end_along_m_.reset();
}

RowEndFinder::Bin* RowEndFinder::bin_at(std::size_t side, double u) {
  if (u >= config_.ahead_m - config_.bin_m || u <= config_.bin_m - config_.behind_m) return nullptr;
  const auto index = static_cast<long long>(std::floor((along_m_ + u) / config_.bin_m));
  return &bins_[side][wrapped(index, bins_[side].size())];
}

const RowEndFinder::Bin* RowEndFinder::bin_at(std::size_t side, double u) const {
  return const_cast<RowEndFinder*>(this)->bin_at(side, u);
}

void RowEndFinder::move(double along_m) {
  const auto bin_of = [&](double along) {
    return static_cast<long long>(std::floor(along / config_.bin_m));
  };
  const long long before = bin_of(along_m_);
  along_m_ += along_m;
  const long long shift = bin_of(along_m_) - before;
  const auto count = static_cast<long long>(bins_[0].size());
  // What leaves at one end of the ring enters at the other, empty.
  const long long ahead = before + bin_of(config_.ahead_m);
  for (long long i = 0; i < std::min(std::abs(shift), count); ++i) {
    const long long entering = shift > 0 ? ahead + i : ahead - count - i;
    for (auto& side : bins_) side[wrapped(entering, side.size())] = Bin{};
  }
}

void RowEndFinder::count_ray(std::size_t side, double u, bool is_hit) {
  Bin* bin = bin_at(side, u);
  if (bin == nullptr) return;
  (is_hit ? bin->hits : bin->passes) += 1.0f;
  if (is_hit) bin->hits_m += (static_cast<float>(along_m_ + u) - bin->hits_m) / bin->hits;
  if (bin->hits + bin->passes <= kMostRays) return;
  bin->hits *= 0.75f;
  bin->passes *= 0.75f;
}

void RowEndFinder::count_rays(std::span<const LidarPoint> points_base,
                              const internal::FittedPlane& ground, const RowEstimate& lane) {
  const double c = std::cos(lane.heading_rad);
  const double s = std::sin(lane.heading_rad);
  const auto in_row = [&](double x, double y) {
    return Eigen::Vector2d(c * x + s * y, c * y - s * x - lane.offset_m);
  };
  const Eigen::Vector2d start = in_row(sensor_base_.x(), sensor_base_.y());
  const double start_height = ground.height(sensor_base_);
  const double half = 0.5 * lane.width_m;
  const double gate = config_.gate_ratio * lane.width_m;
  for (const LidarPoint& point : points_base) {
    const Eigen::Vector3d p = point.position.cast<double>();
    if (!p.allFinite()) continue;
    const Eigen::Vector2d place = in_row(p.x(), p.y());
    const double reach = std::abs(place.y());
    if (reach < half - gate) continue;
    const std::size_t side = place.y() > 0.0 ? 1 : 0;
    const double height = ground.height(p);
    if (reach <= half + gate) {
      const double lowest = config_.low_m + kTilt * std::abs(place.x());
      if (height < lowest || height > config_.high_m) continue;
      count_ray(side, place.x(), true);
      continue;
    }
    const double line = side == 1 ? half : -half;
    const double share = (line - start.y()) / (place.y() - start.y());
    if (!(share > 0.0 && share < 1.0)) continue;
    const double crossing = start_height + share * (height - start_height);
    if (crossing < config_.low_m || crossing > config_.high_m) continue;
    count_ray(side, start.x() + share * (place.x() - start.x()), false);
  }
}

double RowEndFinder::hit_ratio() const {
  double sum = 0.0;
  int count = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    for (double u = -kLearnBehind; u < kLearnAhead; u += config_.bin_m) {
      const Bin* bin = bin_at(side, u);
      if (bin == nullptr || bin->hits + bin->passes < kLeastRays) continue;
      sum += bin->hits / (bin->hits + bin->passes);
      ++count;
    }
  }
  return std::clamp(count > 0 ? sum / count : 0.0, config_.least_hit_ratio, 0.9);
}

double RowEndFinder::log_odds(const Bin& bin, double hit_ratio) const {
  const double rays = static_cast<double>(bin.hits) + static_cast<double>(bin.passes);
  if (rays < kLeastRays) return 0.0;
  const double hits = bin.hits / rays;
  const double each = hits * std::log(hit_ratio / config_.free_hit_ratio) +
                      (1.0 - hits) * std::log((1.0 - hit_ratio) / (1.0 - config_.free_hit_ratio));
  return std::min(rays, config_.rays_weight) * each;
}

void RowEndFinder::look_for_end() {
  const double ratio = hit_ratio();
  const double into_bin = along_m_ / config_.bin_m - std::floor(along_m_ / config_.bin_m);
  double sum = 0.0;
  double highest = 0.0;
  double highest_u = -kStartBehind;
  int bins_since = 0;
  int seen_since = 0;
  for (double u = -kStartBehind + (0.5 - into_bin) * config_.bin_m;; u += config_.bin_m) {
    const Bin* right = bin_at(0, u);
    const Bin* left = bin_at(1, u);
    if (right == nullptr || left == nullptr) break;
    const double rays =
        static_cast<double>(right->hits) + right->passes + left->hits + left->passes;
    sum += log_odds(*right, ratio) + log_odds(*left, ratio);
    ++bins_since;
    if (rays >= kLeastRays) ++seen_since;
    if (sum > highest) {
      highest = sum;
      // Within the bin the row ends where its hits do.
      const float hits = std::max(1.0f, right->hits + left->hits);
      highest_u = (right->hits * right->hits_m + left->hits * left->hits_m) / hits - along_m_;
      bins_since = 0;
      seen_since = 0;
      continue;
    }
    const bool is_long = bins_since * config_.bin_m >= config_.gap_m;
    const bool is_seen = seen_since >= kSeenShare * bins_since;
    if (highest - sum < config_.evidence_weight || !is_long || !is_seen) continue;
    end_along_m_ = along_m_ + highest_u;
    const double resolution = config_.bin_m / std::sqrt(12.0);
    end_deviation_m_ = std::hypot(resolution, kOdometryShare * std::abs(highest_u));
    return;
  }
  // No end: one believed before stays, unless the row is now seen to go on beyond it.
  if (end_along_m_ && along_m_ + highest_u > *end_along_m_ + config_.gap_m) end_along_m_.reset();
}

void RowEndFinder::update(std::span<const LidarPoint> points_base,
                          const internal::FittedPlane& ground, const RowEstimate& lane) {
  count_rays(points_base, ground, lane);
  look_for_end();
}

RowEnd RowEndFinder::end() const {
  if (!end_along_m_) return {};
  return {true, *end_along_m_ - along_m_, end_deviation_m_};
}

}  // namespace headland
