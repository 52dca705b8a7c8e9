// SPDX-License-Identifier: Apache-2.0
#include "perception/localization/voxel_map.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Eigenvalues>

#include "perception/localization/internal/cell_key.hpp"

namespace headland {
namespace {

using internal::cell_key;

constexpr int kLeastPoints = 8;   // for a shape
constexpr int kFull = 300;        // points; after that a voxel stays as it is
constexpr float kExtent = 0.08f;  // a surface or trunk is seen over at least this [m, sd]
constexpr float kThin = 0.09f;    // and is thinner than this across [m, sd]
constexpr float kFlat = 0.1f;     // thinnest variance of a plane, against its second
constexpr float kSlender = 0.3f;  // larger variance across a trunk, against its vertical one
constexpr float kGrain = 0.01f;   // least noise of a point [m]
constexpr float kLean = 0.1f;     // most deviation of a normal's direction [rad]

// Cells lie around multiples of their edge, so that level ground at height 0 is not between two.
Eigen::Vector3i cell_around(const Eigen::Vector3f& point, float per_metre) {
  return internal::cell_of(point.array() + 0.5f / per_metre, per_metre);
}

// The normal of a plane that can be told from `upright` (or, off it, from level) counts as it is;
// one that cannot is taken as such: a normal that leans by its noise alone would tie far points to
// directions that they say nothing about.
Eigen::Vector3f settled(Eigen::Vector3f normal, float lean_variance) {
  const float level = normal.head<2>().norm();
  const float told = 9.0f * lean_variance;
  if (level * level < told) return Eigen::Vector3f::UnitZ();
  if (normal.z() * normal.z() < told) normal.z() = 0.0f;
  return normal.normalized();
}

Eigen::Matrix3f plane_information(const Eigen::Matrix3f& covariance, float count, float noise) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> axes;
  axes.computeDirect(covariance);
  const Eigen::Vector3f variance = axes.eigenvalues().cwiseMax(0.0f);
  const float lean = (variance(0) + kGrain * kGrain) / (count * std::max(variance(1), 1e-9f));
  const bool plane = variance(1) > kExtent * kExtent && variance(0) < kFlat * variance(1) &&
                     variance(0) < kThin * kThin && lean < kLean * kLean;
  if (!plane) return Eigen::Matrix3f::Zero();
  const Eigen::Vector3f normal = settled(axes.eigenvectors().col(0), lean);
  return normal * normal.transpose() / (variance(0) + noise);
}

Eigen::Matrix3f upright_information(const Eigen::Matrix3f& covariance, float noise) {
  const Eigen::Matrix2f level = covariance.topLeftCorner<2, 2>();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f> axes;
  axes.computeDirect(level);
  const Eigen::Vector2f variance = axes.eigenvalues().cwiseMax(0.0f);
  Eigen::Matrix3f information = Eigen::Matrix3f::Zero();
  if (covariance(2, 2) < kExtent * kExtent || variance(1) > kSlender * covariance(2, 2)) {
    return information;
  }
  for (int i = 0; i < 2; ++i) {
    if (variance(i) > kThin * kThin) continue;
    const Eigen::Vector2f axis = axes.eigenvectors().col(i);
    information.topLeftCorner<2, 2>() += axis * axis.transpose() / (variance(i) + noise);
  }
  return information;
}

}  // namespace

VoxelMap::VoxelMap(const VoxelMapConfig& config)
    : config_(config), per_metre_(static_cast<float>(1.0 / config.cell_m)) {
  std::size_t size = 1024;
  while (size < 2 * static_cast<std::size_t>(config.most_count)) size *= 2;
  table_.assign(size, -1);
  voxels_.reserve(static_cast<std::size_t>(config.most_count));
  ages_.reserve(voxels_.capacity());
}

void VoxelMap::clear() {
  voxels_.clear();
  std::fill(table_.begin(), table_.end(), -1);
}

// Where the key is in the table, or would be put.
std::size_t VoxelMap::slot(std::uint64_t key) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t at = internal::slot_of(key, mask);
  while (table_[at] >= 0 && voxels_[static_cast<std::size_t>(table_[at])].key != key) {
    at = (at + 1) & mask;
  }
  return at;
}

void VoxelMap::insert(const Eigen::Vector3f& point) {
  const Eigen::Vector3i cell = cell_around(point, per_metre_);
  const std::uint64_t key = cell_key(cell);
  const std::size_t at = slot(key);
  if (table_[at] < 0) {
    if (voxels_.size() == voxels_.capacity()) return;
    table_[at] = static_cast<int>(voxels_.size());
    Entry entry;
    entry.key = key;
    entry.centre = cell.cast<float>() / per_metre_;
    entry.shape_due = kLeastPoints;
    voxels_.push_back(entry);
  }
  Entry& entry = voxels_[static_cast<std::size_t>(table_[at])];
  entry.last_scan = scan_;
  if (entry.voxel.count >= kFull) return;
  const Eigen::Vector3f off = point - entry.centre;
  entry.sum += off;
  entry.squares += off * off.transpose();
  if (++entry.voxel.count >= entry.shape_due) find_shape(entry);
}

void VoxelMap::find_shape(Entry& entry) const {
  const auto n = static_cast<float>(entry.voxel.count);
  entry.shape_due = entry.voxel.count + 1 + entry.voxel.count / 3;
  const Eigen::Vector3f mean = entry.sum / n;
  const Eigen::Matrix3f covariance = (entry.squares - n * mean * mean.transpose()) / (n - 1.0f);
  entry.voxel.mean = entry.centre + mean;
  const auto noise = static_cast<float>(config_.noise_m * config_.noise_m);
  entry.voxel.information = plane_information(covariance, n, noise);
  if (entry.voxel.information.isZero()) {
    entry.voxel.information = upright_information(covariance, noise);
  }
  entry.voxel.informative = !entry.voxel.information.isZero();
}

const Voxel* VoxelMap::find(const Eigen::Vector3f& point) const {
  const int index = table_[slot(cell_key(cell_around(point, per_metre_)))];
  return index < 0 ? nullptr : &voxels_[static_cast<std::size_t>(index)].voxel;
}

const Voxel* VoxelMap::find_informative(const Eigen::Vector3f& point) const {
  const Eigen::Vector3i cell = cell_around(point, per_metre_);
  const auto informative = [&](const Eigen::Vector3i& place) -> const Voxel* {
    const int index = table_[slot(cell_key(place))];
    if (index < 0) return nullptr;
    const Voxel& voxel = voxels_[static_cast<std::size_t>(index)].voxel;
    return voxel.informative ? &voxel : nullptr;
  };
  if (const Voxel* own = informative(cell)) return own;
  const Voxel* best = nullptr;
  float nearest = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    for (const int step : {-1, 1}) {
      Eigen::Vector3i place = cell;
      place(axis) += step;
      const Voxel* beside = informative(place);
      if (beside == nullptr) continue;
      const float distance = (beside->mean - point).squaredNorm();
      if (distance < nearest) {
        nearest = distance;
        best = beside;
      }
    }
  }
  return best;
}

void VoxelMap::end_scan(const Eigen::Vector3f& centre) {
  ++scan_;
  const auto radius = static_cast<float>(config_.radius_m);
  const bool full = voxels_.size() > voxels_.capacity() - voxels_.capacity() / 8;
  if (full || (centre - forgot_at_).norm() > 0.1f * radius) forget(centre);
}

void VoxelMap::forget(const Eigen::Vector3f& centre) {
  forgot_at_ = centre;
  const auto radius = static_cast<float>(config_.radius_m);
  std::erase_if(voxels_, [&](const Entry& e) { return (e.centre - centre).norm() > radius; });
  const std::size_t most = voxels_.capacity() - voxels_.capacity() / 4;
  if (voxels_.size() > most) {
    ages_.clear();
    for (const Entry& entry : voxels_) ages_.push_back(entry.last_scan);
    const auto limit = ages_.begin() + static_cast<std::ptrdiff_t>(voxels_.size() - most);
    std::nth_element(ages_.begin(), limit, ages_.end());
    std::erase_if(voxels_, [&](const Entry& e) { return e.last_scan < *limit; });
    if (voxels_.size() > most)
      voxels_.erase(voxels_.begin() + static_cast<std::ptrdiff_t>(most), voxels_.end());
  }
  std::fill(table_.begin(), table_.end(), -1);
  for (std::size_t i = 0; i < voxels_.size(); ++i) {
    table_[slot(voxels_[i].key)] = static_cast<int>(i);
  }
}

}  // namespace headland
