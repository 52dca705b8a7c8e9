// SPDX-License-Identifier: Apache-2.0
#include "perception/ground/height_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace headland {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr TerrainCell kUnknown{.variance = kNone};

perception::internal::GroundSearchConfig search_config(const HeightGridConfig& config) {
  return {.cell = config.cell_m,
          .widest_object = config.widest_object_m,
          .slope = config.slope_ratio,
          .least_rise = config.least_rise_m};
}

std::size_t at_index(int cell) { return static_cast<std::size_t>(cell); }

// The lesser of two differences of one sign, else none: beside a step, the slope of its own side.
float lesser(float a, float b) {
  if (a * b <= 0.0f) return 0.0f;
  return std::abs(a) < std::abs(b) ? a : b;
}

float spare(float value, double most) {
  return std::max(0.0f, 1.0f - value / static_cast<float>(most));
}

}  // namespace

HeightGrid::HeightGrid(const HeightGridConfig& config)
    : config_(config),
      side_(2 * static_cast<int>(std::ceil(config.reach_m / config.cell_m))),
      per_metre_(static_cast<float>(1.0 / config.cell_m)),
      cells_(at_index(side_ * side_), kUnknown),
      gradients_(cells_.size(), Eigen::Vector2f::Zero()),
      search_(search_config(config)),
      lowest_{side_, side_, std::vector<float>(cells_.size(), kNone)} {}

void HeightGrid::clear() {
  std::fill(cells_.begin(), cells_.end(), kUnknown);
  labels_.clear();
}

void HeightGrid::update(std::span<const LidarPoint> points, const Point2& center) {
  move_to(center);
  sort_points(points);
  find_lowest(points);
  search_.find(lowest_, is_ground_);
  fuse(points);
  find_slopes();
  find_steps();
  label(points);
  rate();
}

bool HeightGrid::known(int cell) const { return cells_[at_index(cell)].variance != kNone; }

int HeightGrid::cell_at(const Point2& place) const {
  const double x = place.x() / config_.cell_m - column0_;
  const double y = place.y() / config_.cell_m - row0_;
  if (!(x >= 0.0 && y >= 0.0 && x < side_ && y < side_)) return -1;
  return static_cast<int>(y) * side_ + static_cast<int>(x);
}

std::optional<TerrainCell> HeightGrid::at(const Point2& place) const {
  const int cell = cell_at(place);
  if (cell < 0 || !known(cell)) return std::nullopt;
  return cells_[at_index(cell)];
}

std::optional<double> HeightGrid::height(const Point2& place) const {
  const int cell = cell_at(place);
  if (cell < 0 || !known(cell)) return std::nullopt;
  return static_cast<double>(surface(cell,
                                     static_cast<float>(place.x() / config_.cell_m - column0_),
                                     static_cast<float>(place.y() / config_.cell_m - row0_)));
}

// Cells keep their place in the frame: whole cells enter and leave. A centre that is no number
// leaves the window where it is.
void HeightGrid::move_to(const Point2& center) {
  constexpr double kFarthest = 1e9;  // [cells]
  const Point2 scaled = center / config_.cell_m;
  if (!(scaled.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() < kFarthest)) return;
  const int dx = static_cast<int>(std::floor(scaled.x())) - side_ / 2 - column0_;
  const int dy = static_cast<int>(std::floor(scaled.y())) - side_ / 2 - row0_;
  column0_ += dx;
  row0_ += dy;
  if (dx == 0 && dy == 0) return;
  // In the order in which nothing is overwritten before it has moved.
  for (int i = 0; i < side_; ++i) {
    const int row = dy >= 0 ? i : side_ - 1 - i;
    for (int j = 0; j < side_; ++j) {
      const int column = dx >= 0 ? j : side_ - 1 - j;
      const bool inside =
          row + dy >= 0 && row + dy < side_ && column + dx >= 0 && column + dx < side_;
      cells_[at_index(row * side_ + column)] =
          inside ? cells_[at_index((row + dy) * side_ + column + dx)] : kUnknown;
    }
  }
}

void HeightGrid::sort_points(std::span<const LidarPoint> points) {
  cell_of_.resize(points.size());
  // From the corner in double precision: coordinates may be large.
  const Eigen::Vector2d corner = config_.cell_m * Eigen::Vector2d(column0_, row0_);
  const auto limit = static_cast<float>(side_);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f& p = points[i].position;
    const float x = static_cast<float>(static_cast<double>(p.x()) - corner.x()) * per_metre_;
    const float y = static_cast<float>(static_cast<double>(p.y()) - corner.y()) * per_metre_;
    const bool inside = x >= 0.0f && y >= 0.0f && x < limit && y < limit && std::isfinite(p.z());
    cell_of_[i] = inside ? static_cast<int>(y) * side_ + static_cast<int>(x) : -1;
  }
}

// The lowest point of each cell, but for errors deep in the ground.
void HeightGrid::find_lowest(std::span<const LidarPoint> points) {
  const auto take_all = [&](auto&& allowed) {
    std::fill(lowest_.heights.begin(), lowest_.heights.end(), kNone);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (cell_of_[i] < 0) continue;
      float& lowest = lowest_.heights[at_index(cell_of_[i])];
      const float z = points[i].position.z();
      if (z < lowest && allowed(at_index(cell_of_[i]), z)) lowest = z;
    }
  };
  take_all([](std::size_t, float) { return true; });
  search_.find_pits(lowest_, config_.pit_m, least_);
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    if (lowest_.heights[cell] >= least_[cell]) continue;
    take_all([&](std::size_t at, float z) { return z >= least_[at]; });
    return;
  }
}

// The mean of the ground's points of each cell measures its height.
void HeightGrid::fuse(std::span<const LidarPoint> points) {
  const auto noise2 = static_cast<float>(config_.range_noise_m * config_.range_noise_m);
  const auto settling2 = static_cast<float>(config_.settling_m * config_.settling_m);
  const auto band = static_cast<float>(config_.label_band_m + 2.0 * config_.range_noise_m);
  sums_.assign(cells_.size(), Sums{});
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (cell_of_[i] < 0 || is_ground_[at_index(cell_of_[i])] == 0) continue;
    const float z = points[i].position.z();
    const float above = z - lowest_.heights[at_index(cell_of_[i])];
    if (above < 0.0f || above > band) continue;
    Sums& sums = sums_[at_index(cell_of_[i])];
    sums.count += 1.0f;
    sums.sum += z;
  }
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    cells_[i].variance += settling2;
    if (sums_[i].count == 0.0f) continue;
    // Points of one scan share part of their error: their mean is not much better than one.
    constexpr float kShared = 0.25f;
    fuse(cells_[i], sums_[i].sum / sums_[i].count, (kShared + 1.0f / sums_[i].count) * noise2);
  }
}

// A Kalman filter's update, gated at three standard deviations: what is lower replaces the height,
// as ground is the lowest; what is higher by more than an object's least height stands on it.
void HeightGrid::fuse(TerrainCell& cell, float measured, float variance) const {
  const float innovation = measured - cell.height;
  const float expected2 = cell.variance + variance;
  const bool surprising = innovation * innovation > 9.0f * expected2;
  if (cell.variance == kNone || (surprising && innovation < 0.0f)) {
    cell.height = measured;
    cell.variance = variance;
    return;
  }
  if (surprising && innovation > static_cast<float>(config_.label_band_m)) return;
  cell.height += cell.variance / expected2 * innovation;
  cell.variance *= variance / expected2;
}

void HeightGrid::find_slopes() {
  const auto along = [this](int cell, int place, int stride) {
    const bool before = place > 0 && known(cell - stride);
    const bool after = place < side_ - 1 && known(cell + stride);
    const float here = cells_[at_index(cell)].height;
    const float back = before ? here - cells_[at_index(cell - stride)].height : 0.0f;
    const float ahead = after ? cells_[at_index(cell + stride)].height - here : 0.0f;
    return (before && after ? lesser(back, ahead) : back + ahead) * per_metre_;
  };
  const auto steepest = static_cast<float>(config_.steepest_ratio);
  for (int i = 0; i < side_ * side_; ++i) {
    if (!known(i)) continue;
    Eigen::Vector2f gradient(along(i, i % side_, 1), along(i, i / side_, side_));
    cells_[at_index(i)].slope = gradient.norm();
    if (cells_[at_index(i)].slope > steepest) gradient *= steepest / gradient.norm();
    gradients_[at_index(i)] = gradient;
  }
}

// Differences to the cells beside, beyond what the slopes of both explain.
void HeightGrid::find_steps() {
  const auto step = [this](int cell, int place, int stride, int axis) {
    float most = 0.0f;
    for (const int sign : {-1, 1}) {
      const int other = cell + sign * stride;
      if (place + sign < 0 || place + sign >= side_ || !known(other)) continue;
      const float rise = static_cast<float>(sign) * 0.5f / per_metre_ *
                         (gradients_[at_index(cell)][axis] + gradients_[at_index(other)][axis]);
      const float jump = cells_[at_index(other)].height - cells_[at_index(cell)].height;
      most = std::max(most, std::abs(jump - rise));
    }
    return most;
  };
  for (int i = 0; i < side_ * side_; ++i) {
    if (!known(i)) continue;
    cells_[at_index(i)].step = std::max(step(i, i % side_, 1, 0), step(i, i / side_, side_, 1));
  }
}

// Height of the slope of a cell at (x, y), in cells from the corner of the window.
float HeightGrid::surface(int cell, float x, float y) const {
  const Eigen::Vector2f& gradient = gradients_[at_index(cell)];
  const float dx = x - static_cast<float>(cell % side_) - 0.5f;
  const float dy = y - static_cast<float>(cell / side_) - 0.5f;
  return cells_[at_index(cell)].height + (gradient.x() * dx + gradient.y() * dy) / per_metre_;
}

// Labels, and what ground points and objects say of their cells: roughness and obstacles.
void HeightGrid::label(std::span<const LidarPoint> points) {
  labels_.resize(points.size());
  sums_.assign(cells_.size(), Sums{});
  const Eigen::Vector2d corner = config_.cell_m * Eigen::Vector2d(column0_, row0_);
  const auto band = static_cast<float>(config_.label_band_m);
  const auto top = static_cast<float>(config_.vehicle_height_m);
  const auto pit = static_cast<float>(config_.pit_m);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int index = cell_of_[i];
    labels_[i] = index < 0 ? GroundLabel::kOutside : GroundLabel::kObject;
    if (index < 0 || !known(index)) continue;
    const Eigen::Vector3f& p = points[i].position;
    const float x = static_cast<float>(static_cast<double>(p.x()) - corner.x()) * per_metre_;
    const float y = static_cast<float>(static_cast<double>(p.y()) - corner.y()) * per_metre_;
    const float above = p.z() - surface(index, x, y);
    TerrainCell& cell = cells_[at_index(index)];
    Sums& sums = sums_[at_index(index)];
    if (sums.count == 0.0f && sums.sum == 0.0f) cell.obstacle = 0.0f;
    const float doubt = band + 0.5f * gradients_[at_index(index)].norm() / per_metre_;
    if (above >= -pit && above <= doubt) {
      labels_[i] = GroundLabel::kGround;
      sums.count += 1.0f;
      sums.sum += above * above;
    } else if (above > doubt && above < top) {
      cell.obstacle = std::max(cell.obstacle, above);
      sums.sum += std::numeric_limits<float>::min();  // seen
    }
  }
}

void HeightGrid::rate() {
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    TerrainCell& cell = cells_[i];
    constexpr float kEnough = 3.0f;
    if (sums_[i].count >= kEnough) cell.roughness = std::sqrt(sums_[i].sum / sums_[i].count);
    cell.traversability = spare(cell.slope, config_.most_slope_ratio) *
                          spare(std::max(cell.step, cell.obstacle), config_.most_step_m) *
                          spare(cell.roughness, config_.most_roughness_m);
  }
}

}  // namespace headland
