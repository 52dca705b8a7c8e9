// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace headland {

/// What a ray has met.
enum class Surface : std::int8_t { kNone, kGround, kGrass, kCanopy, kTrunk, kPost, kWire, kAgent };
inline constexpr int kSurfaces = 8;

/// Area that a leaf of unit area and random attitude shows to a ray (G).
inline constexpr double kLeafProjection = 0.5;

/// A question to a scene, in `map`.
struct Ray {
  Eigen::Vector3d origin{0.0, 0.0, 0.0};     ///< [m]
  Eigen::Vector3d direction{1.0, 0.0, 0.0};  ///< of length 1
  double max_range = 180.0;                  ///< [m]
  /// Optical depth at which leaves and grass stop it: -ln(u) with u uniform in (0, 1] for a ray as
  /// thin as light; infinite: it passes through all leaves.
  double depth = std::numeric_limits<double>::infinity();
  double width_rad = 0.0;  ///< full angle that it stands for; only thin wires mind
  double chance = 0.0;     ///< uniform in [0, 1): a wire is hit if it fills more of the width
};

/// The answer; surface kNone: nothing within the range.
struct RayHit {
  double range = std::numeric_limits<double>::infinity();  ///< [m]
  Surface surface = Surface::kNone;
  double cosine = 1.0;  ///< of the angle between ray and surface normal; leaves and grass: 1
  int agent = -1;       ///< index in the scene's agents, if it is one
};

}  // namespace headland
