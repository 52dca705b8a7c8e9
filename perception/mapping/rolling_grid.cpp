// SPDX-License-Identifier: Apache-2.0
#include "perception/mapping/rolling_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace headland {
namespace {

constexpr double kUnit = 0.05;     // of log-odds
constexpr int kLayerSlack = 5;     // the box follows the sensor's height in steps of this
constexpr double kFarthest = 1e9;  // [cells] of a sensor
constexpr float kNever = std::numeric_limits<float>::infinity();

int units(double probability) {
  return static_cast<int>(std::lround(std::log(probability / (1.0 - probability)) / kUnit));
}

int floor_to_cell(double value, double cell) { return static_cast<int>(std::floor(value / cell)); }

// One axis of a walk through cells: `next` is the share of the ray at which the next cell begins.
struct Axis {
  float next = kNever;
  float stride = 0.0f;
  int step = 0;
  int left = 0;  // cells to go

  Axis(float from, float to) {
    const int first = static_cast<int>(from);
    left = static_cast<int>(to) - first;
    if (left == 0) return;
    step = left > 0 ? 1 : -1;
    left = std::abs(left);
    stride = 1.0f / std::abs(to - from);
    const float edge =
        step > 0 ? static_cast<float>(first + 1) - from : from - static_cast<float>(first);
    next = edge * stride;
  }
  void advance() { next = --left == 0 ? kNever : next + stride; }
};

}  // namespace

RollingGrid::RollingGrid(const RollingGridConfig& config)
    : config_(config),
      side_(2 * static_cast<int>(std::ceil(config.reach_m / config.cell_m)) + 4),
      hit_(units(config.hit_ratio)),
      miss_(units(config.miss_ratio)),
      least_(units(config.least_ratio)),
      most_(units(config.most_ratio)),
      values_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_) * kLayers, kUnseen),
      marks_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_)) {}

void RollingGrid::insert(std::span<const LidarPoint> points, const Eigen::Vector3d& origin,
                         double time_s, std::span<const MaskedDisc> masked) {
  const double farthest = (origin / config_.cell_m).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  if (!(farthest < kFarthest)) return;
  move_to(origin);
  const Eigen::Vector3d corner = config_.cell_m * Eigen::Vector3d(column0_, row0_, layer0_);
  const auto per_metre = static_cast<float>(1.0 / config_.cell_m);
  const auto reach = static_cast<float>(config_.reach_m) * per_metre;
  const Eigen::Vector3f from = (origin - corner).cast<float>() * per_metre;
  for (const LidarPoint& point : points) {
    if (!point.position.allFinite() || is_masked(point.position, masked)) continue;
    const Eigen::Vector3f to = (point.position.cast<double>() - corner).cast<float>() * per_metre;
    const Eigen::Vector3f ray = to - from;
    const float length = ray.norm();
    if (!std::isfinite(length)) continue;
    if (length > reach) {
      cast(from, from + ray * (reach / length));
      continue;
    }
    cast(from, to);
    if (!(to.z() >= 0.0f && to.z() < static_cast<float>(kLayers))) continue;
    const auto bit = std::uint64_t{1} << static_cast<int>(to.z());
    marks_[column_index(static_cast<int>(to.x()), static_cast<int>(to.y()))].hit |=
        std::rotl(bit, layer0_ & (kLayers - 1));
  }
  apply_marks();
  forget(time_s);
}

// From column to column of the ray, in cells from the corner of the box; both ends lie in it.
void RollingGrid::cast(const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  Axis x(from.x(), to.x());
  Axis y(from.y(), to.y());
  int column = wrapped(static_cast<int>(from.x()) + wrapped(column0_));
  int row = wrapped(static_cast<int>(from.y()) + wrapped(row0_));
  const auto advance = [side = side_](Axis& axis, int& at) {
    at += axis.step;
    if (at == side) at = 0;
    if (at < 0) at = side - 1;
    axis.advance();
  };
  const float rise = to.z() - from.z();
  float z_in = from.z();
  for (int left = x.left + y.left; left > 0; --left) {
    const bool along_x = x.next < y.next;
    const float z_out = from.z() + rise * (along_x ? x.next : y.next);
    mark_passed(static_cast<std::size_t>(row * side_ + column), z_in, z_out);
    z_in = z_out;
    along_x ? advance(x, column) : advance(y, row);
  }
  mark_passed(static_cast<std::size_t>(row * side_ + column), z_in, to.z());
}

void RollingGrid::mark_passed(std::size_t column, float z_in, float z_out) {
  const float low = std::min(z_in, z_out);
  const float high = std::max(z_in, z_out);
  if (!(high >= 0.0f && low < static_cast<float>(kLayers))) return;
  const int first = low < 0.0f ? 0 : static_cast<int>(low);
  const int last = high < static_cast<float>(kLayers) ? static_cast<int>(high) : kLayers - 1;
  const std::uint64_t bits = (~std::uint64_t{0} >> (kLayers - 1 - (last - first))) << first;
  marks_[column].passed |= std::rotl(bits, layer0_ & (kLayers - 1));
}

void RollingGrid::apply_marks() {
  const auto change = [this](Value* column, std::uint64_t bits, int by) {
    for (; bits != 0; bits &= bits - 1) {
      Value& value = column[std::countr_zero(bits)];
      const int before = value == kUnseen ? 0 : value;
      value = static_cast<Value>(std::clamp(before + by, least_, most_));
    }
  };
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    Marks& marks = marks_[i];
    if ((marks.passed | marks.hit) == 0) continue;
    Value* column = values_.data() + i * kLayers;
    change(column, marks.passed & ~marks.hit, miss_);
    change(column, marks.hit, hit_);
    marks = {};
  }
}

// By a unit towards unseen for each cell of as many rows as are due: all of them `most_` times
// within the memory.
void RollingGrid::forget(double time_s) {
  const double passed = time_s - time_s_.value_or(time_s);
  if (!time_s_ || passed > 0.0) time_s_ = time_s;
  if (config_.memory_s <= 0.0 || !(passed > 0.0)) return;
  const double most_steps = static_cast<double>(side_) * most_;
  steps_due_ += std::min(passed / config_.memory_s, 1.0) * most_steps;
  for (; steps_due_ >= 1.0; steps_due_ -= 1.0) {
    const auto row = static_cast<std::size_t>(side_) * kLayers;
    Value* value = values_.data() + static_cast<std::size_t>(next_row_) * row;
    for (std::size_t i = 0; i < row; ++i) {
      const int sign = (value[i] > 0) - (value[i] < 0);
      const int towards = value[i] - sign;
      value[i] = value[i] == kUnseen || towards == 0 ? kUnseen : static_cast<Value>(towards);
    }
    next_row_ = next_row_ + 1 == side_ ? 0 : next_row_ + 1;
  }
}

int RollingGrid::wrapped(int index) const {
  const int rest = index % side_;
  return rest < 0 ? rest + side_ : rest;
}

// Where a column of the box, counted from its corner, is stored.
std::size_t RollingGrid::column_index(int column, int row) const {
  return static_cast<std::size_t>(wrapped(row + wrapped(row0_)) * side_ +
                                  wrapped(column + wrapped(column0_)));
}

void RollingGrid::clear_column(int column, int row) {
  const auto first =
      values_.begin() + static_cast<std::ptrdiff_t>(column_index(column, row)) * kLayers;
  std::fill(first, first + kLayers, kUnseen);
}

// Layers of the lattice from `from` on, in all columns.
void RollingGrid::clear_layers(int from, int count) {
  for (int layer = from; layer < from + std::min(count, kLayers); ++layer) {
    const auto offset = static_cast<std::size_t>(layer & (kLayers - 1));
    for (std::size_t i = offset; i < values_.size(); i += kLayers) values_[i] = kUnseen;
  }
}

void RollingGrid::move_to(const Eigen::Vector3d& origin) {
  const int dx = floor_to_cell(origin.x(), config_.cell_m) - side_ / 2 - column0_;
  const int dy = floor_to_cell(origin.y(), config_.cell_m) - side_ / 2 - row0_;
  const int dz = floor_to_cell(origin.z() + config_.low_m, config_.cell_m) - layer0_;
  column0_ += dx;
  row0_ += dy;
  if (std::abs(dx) >= side_ || std::abs(dy) >= side_) {
    std::fill(values_.begin(), values_.end(), kUnseen);
  } else {
    const int x_from = dx > 0 ? side_ - dx : 0;
    const int y_from = dy > 0 ? side_ - dy : 0;
    for (int row = 0; row < side_; ++row) {
      for (int i = 0; i < std::abs(dx); ++i) clear_column(x_from + i, row);
    }
    for (int i = 0; i < std::abs(dy); ++i) {
      for (int column = 0; column < side_; ++column) clear_column(column, y_from + i);
    }
  }
  if (std::abs(dz) < kLayerSlack) return;
  clear_layers(dz > 0 ? layer0_ + kLayers : layer0_ + dz, std::abs(dz));
  layer0_ += dz;
}

std::optional<std::size_t> RollingGrid::index_of(const Eigen::Vector3d& place) const {
  const Eigen::Vector3d cells = place / config_.cell_m;
  if (!(cells.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() < kFarthest)) return std::nullopt;
  const int column = static_cast<int>(std::floor(cells.x())) - column0_;
  const int row = static_cast<int>(std::floor(cells.y())) - row0_;
  const int layer = static_cast<int>(std::floor(cells.z())) - layer0_;
  const bool inside =
      column >= 0 && column < side_ && row >= 0 && row < side_ && layer >= 0 && layer < kLayers;
  if (!inside) return std::nullopt;
  return column_index(column, row) * kLayers +
         static_cast<std::size_t>((layer + layer0_) & (kLayers - 1));
}

bool RollingGrid::occupied(const Eigen::Vector3d& place) const {
  const std::optional<std::size_t> index = index_of(place);
  return index && values_[*index] > 0;
}

std::optional<double> RollingGrid::probability(const Eigen::Vector3d& place) const {
  const std::optional<std::size_t> index = index_of(place);
  if (!index || values_[*index] == kUnseen) return std::nullopt;
  return 1.0 / (1.0 + std::exp(-kUnit * values_[*index]));
}

std::vector<Eigen::Vector3d> RollingGrid::occupied_cells() const {
  std::vector<Eigen::Vector3d> centers;
  for (int row = 0; row < side_; ++row) {
    for (int column = 0; column < side_; ++column) {
      const Value* values = values_.data() + column_index(column, row) * kLayers;
      for (int layer = layer0_; layer < layer0_ + kLayers; ++layer) {
        if (values[layer & (kLayers - 1)] <= 0) continue;
        centers.push_back(config_.cell_m *
                          (Eigen::Vector3d(column0_ + column, row0_ + row, layer).array() + 0.5));
      }
    }
  }
  return centers;
}

bool RollingGrid::blocked(int column, int row, const HeightGrid& ground,
                          const ClearanceOptions& options) const {
  const Value* values = values_.data() + column_index(column, row) * kLayers;
  const bool any = std::any_of(values, values + kLayers, [](Value value) { return value > 0; });
  if (!any) return false;
  const Point2 center = config_.cell_m * (Point2(column0_ + column, row0_ + row).array() + 0.5);
  const std::optional<double> height = ground.height(center);
  if (!height) return true;
  for (int layer = layer0_; layer < layer0_ + kLayers; ++layer) {
    const double above = config_.cell_m * (layer + 0.5) - *height;
    if (above >= options.low && above <= options.high && values[layer & (kLayers - 1)] > 0) {
      return true;
    }
  }
  return false;
}

ClearanceMap RollingGrid::clearance_map(const HeightGrid& ground,
                                        const ClearanceOptions& options) const {
  const int coarse = std::max(1, options.coarseness);
  const int columns = (side_ + coarse - 1) / coarse;
  std::vector<std::uint8_t> cells(static_cast<std::size_t>(columns) *
                                  static_cast<std::size_t>(columns));
  for (int row = 0; row < side_; ++row) {
    for (int column = 0; column < side_; ++column) {
      if (!blocked(column, row, ground, options)) continue;
      cells[static_cast<std::size_t>(row / coarse * columns + column / coarse)] = 1;
    }
  }
  return ClearanceMap(config_.cell_m * Point2(column0_, row0_), config_.cell_m * coarse, columns,
                      columns, cells);
}

}  // namespace headland
