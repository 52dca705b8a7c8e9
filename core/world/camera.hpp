// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

namespace headland {

/// What a box on an image, or a cluster of points, may be.
enum class ObjectClass : std::int8_t { kPerson, kLivestock, kVehicle, kOther };
inline constexpr int kObjectClasses = 4;
/// Probability of each class; they add up to 1.
using ClassProbability = std::array<double, kObjectClasses>;

/// A box on an image, from its upper left corner [px].
struct ImageBox {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;

  double area() const {
    return right > left && bottom > top ? (right - left) * (bottom - top) : 0.0;
  }
};

/// What a detector says of an image.
struct DetectedBox {
  ImageBox box;
  double score = 0.0;  ///< 0 to 1
  ClassProbability probability{};
};

/// A calibrated, rectified camera.
struct CameraModel {
  int width_px = 0;
  int height_px = 0;
  /// Homogeneous pixels from points in `base` [m]: intrinsics times T_camera_base.
  Eigen::Matrix<double, 3, 4> projection = Eigen::Matrix<double, 3, 4>::Zero();

  /// Pixel of a point in `base`; nullopt behind the camera. It may lie off the image.
  std::optional<Eigen::Vector2d> pixel(const Eigen::Vector3d& p_base) const {
    const Eigen::Vector3d h = projection * p_base.homogeneous();
    if (!(h.z() > 0.1)) return std::nullopt;
    return Eigen::Vector2d(h.x() / h.z(), h.y() / h.z());
  }
};

}  // namespace headland
