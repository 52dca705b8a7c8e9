// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/config/visit.hpp"
#include "core/world/camera.hpp"

namespace headland {

struct DecodingConfig {
  double least_score_ratio = 0.3;
  double same_iou_ratio = 0.45;

  template <class V>
  void visit(V& v) {
    v("least_score_ratio", least_score_ratio, config::kFraction, "Boxes below are left out");
    v("same_iou_ratio", same_iou_ratio, config::kFraction,
      "Boxes of one class that overlap more are of one body: the surest stays");
  }
};

/// What a network puts out: rows of equal length, one after the other.
struct NetworkRows {
  std::span<const float> values;
  int columns = 0;
};

/// From the network's coordinates to pixels of the image: offset + scale times the coordinate.
struct InputMapping {
  double scale_x = 1.0;
  double scale_y = 1.0;
  double offset_x = 0.0;
  double offset_y = 0.0;
  int width_px = 0;  ///< of the image; boxes are clipped to it
  int height_px = 0;
};

/// An image of that size stretched over an input whose coordinates go from 0 to 1.
InputMapping stretched(int width_px, int height_px);
/// An image of that size shrunk to fit a square input of `input_px`, centred, borders filled up.
InputMapping letterboxed(int width_px, int height_px, int input_px);

// All three: rows that are too short or not finite, and classes beyond those given, are left out.
// Boxes lie within the image; those without area are left out. `classes` is the network's list.

/// SSD (Liu et al. 2016), as its detection output layer gives it: image, class, score, left, top,
/// right, bottom; coordinates from 0 to 1.
std::vector<DetectedBox> decode_ssd(const NetworkRows& rows, std::span<const ObjectClass> classes,
                                    const InputMapping& mapping, const DecodingConfig& config);
/// Darknet's region and yolo layers: centre x, y, width, height (0 to 1), objectness, and for each
/// class its score, objectness included.
std::vector<DetectedBox> decode_darknet(const NetworkRows& rows,
                                        std::span<const ObjectClass> classes,
                                        const InputMapping& mapping, const DecodingConfig& config);
/// YOLOv5 and alike: centre x, y, width, height in pixels of the input, objectness, and for each
/// class its score, given that there is an object.
std::vector<DetectedBox> decode_yolo_v5(const NetworkRows& rows,
                                        std::span<const ObjectClass> classes,
                                        const InputMapping& mapping, const DecodingConfig& config);

/// Non-maximum suppression among boxes of one class: from the surest on, those that overlap it more
/// than `same_iou` are left out. Sorted by falling score, ties as they came. O(n^2).
std::vector<DetectedBox> suppress_doubles(std::vector<DetectedBox> boxes, double same_iou);

}  // namespace headland
