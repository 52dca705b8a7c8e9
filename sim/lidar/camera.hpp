// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/base/random.hpp"
#include "core/world/camera.hpp"
#include "core/world/lidar.hpp"
#include "sim/lidar/scene.hpp"

namespace headland {

/// A camera with a detector of people, animals and vehicles behind it, and what both get wrong.
struct CameraConfig {
  int width_px = 1280;
  int height_px = 720;
  double view_deg = 90.0;
  double found_probability = 0.95;
  int found_half_px = 25;
  double least_visible_ratio = 0.25;
  double jitter_ratio = 0.05;
  double confusion_probability = 0.08;
  double false_per_image_ratio = 0.05;

  template <class V>
  void visit(V& v) {
    v("width_px", width_px, config::Range{1, 10000}, "Width of the image [px]");
    v("height_px", height_px, config::Range{1, 10000}, "Height of the image [px]");
    v("view_deg", view_deg, config::Range{1.0, 170.0}, "Width of the view [deg]");
    v("found_probability", found_probability, config::kFraction,
      "Of someone near and in full view to be found in an image");
    v("found_half_px", found_half_px, config::Range{0, 10000},
      "At this height on the image only half of them are found [px]");
    v("least_visible_ratio", least_visible_ratio, config::Range{0.0, 0.99},
      "Someone of whom no more than this share is in view is never found");
    v("jitter_ratio", jitter_ratio, config::Range{0.0, 1.0},
      "Standard deviation of a box's edges over its width and height");
    v("confusion_probability", confusion_probability, config::kFraction,
      "Of a box to be taken for another class");
    v("false_per_image_ratio", false_per_image_ratio, config::Range{0.0, 100.0},
      "Boxes an image around nothing, on average");
  }
};

/// Boxes around the agents of a scene, as a detector gives them: small and half hidden ones are
/// missed more often, edges jitter, classes are confused, and now and then there is nothing in a
/// box. Misses of one image do not depend on the last one's. Deterministic for a seed and a
/// sequence of calls.
class CameraSimulator {
 public:
  /// `mount`: x of the sensor is the optical axis. Requires values within the config's ranges.
  CameraSimulator(const CameraConfig& config, const SensorMount& mount, std::uint64_t seed);

  const CameraModel& model() const { return model_; }
  /// What the detector says of an image taken at that pose; reuses the memory of `out`. Empty if
  /// the pose is not finite. About 10 us an agent in view.
  void detect(const LidarScene& scene, const Eigen::Isometry3d& T_map_base,
              std::vector<DetectedBox>& out);
  /// Whom the boxes of the last image are around: an index in the scene's agents; -1: nobody.
  std::span<const int> truth() const { return truth_; }

 private:
  double visible_ratio(const LidarScene& scene, int agent, const Eigen::Isometry3d& T_map_base);
  DetectedBox seen(const ImageBox& box, ObjectClass kind);
  void add_false_boxes(std::vector<DetectedBox>& out);

  CameraConfig config_;
  CameraModel model_;
  Eigen::Isometry3d T_base_sensor_;
  RandomStream finding_;
  RandomStream boxes_;
  RandomStream false_;
  std::vector<int> truth_;
};

/// The box of an agent on the image, not clipped, from the corners of its body; nullopt if a part
/// of it lies behind the camera.
std::optional<ImageBox> box_of(const CameraModel& model, const Agent& agent, double ground_m,
                               const Eigen::Isometry3d& T_map_base);

}  // namespace headland
