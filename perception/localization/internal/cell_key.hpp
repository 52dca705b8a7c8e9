// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace headland::internal {

/// A cell of a grid in space as one number: 21 bits an axis, 1e6 cells to either side.
inline std::uint64_t cell_key(const Eigen::Vector3i& cell) {
  constexpr std::uint64_t kMask = (1u << 21) - 1;
  const auto part = [](int i) { return static_cast<std::uint64_t>(i) & kMask; };
  return part(cell.x()) << 42 | part(cell.y()) << 21 | part(cell.z());
}

/// The cell that a point lies in; `per_metre` is 1 / its edge.
inline Eigen::Vector3i cell_of(const Eigen::Vector3f& point, float per_metre) {
  return (point * per_metre).array().floor().cast<int>();
}

/// Spreads keys over a table whose size is a power of two.
inline std::size_t slot_of(std::uint64_t key, std::size_t mask) {
  key *= 0x9e3779b97f4a7c15u;
  return static_cast<std::size_t>(key >> 20) & mask;
}

}  // namespace headland::internal
