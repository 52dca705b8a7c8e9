// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "core/world/image.hpp"
#include "perception/detection/box_decoding.hpp"
#include "perception/detection/detector.hpp"

namespace headland {

/// How the outputs of a network are to be read: box_decoding.hpp.
enum class NetworkKind : std::int8_t { kSsd, kDarknet, kYoloV5 };

/// A network for OpenCV's DNN module. Its weights are the user's.
struct NetworkConfig {
  NetworkKind kind = NetworkKind::kDarknet;
  std::string weights;
  std::string layers;
  std::string names;
  int input_px = 320;
  double mean_ratio = 0.0;
  double spread_ratio = 1.0;
  bool blue_first = false;
  DecodingConfig decoding;

  template <class V>
  void visit(V& v) {
    v("kind", kind, "How its outputs are read");
    v.required("weights", weights, "File of the weights: .weights, .caffemodel, .onnx, .pb");
    v("layers", layers, "File of the layers: .cfg, .prototxt, .pbtxt; ONNX has none");
    v.required("names", names, "File of the names of its classes, one a line");
    v("input_px", input_px, config::Range{32, 4096}, "Side of its square input [px]");
    v("mean_ratio", mean_ratio, config::kFraction,
      "Taken off pixels from 0 to 1 (MobileNet-SSD: 0.5)");
    v("spread_ratio", spread_ratio, config::kPositive, "... which are then divided by this");
    v("blue_first", blue_first, "Blue is the first channel (Caffe), not red");
    v("decoding", decoding, "Of its boxes");
  }
};

/// A detector that runs a network by OpenCV, on the processor.
/// @return kFileNotFound; kSyntax for files that are no network or no names; kUnsupported if the
///         program was built without OpenCV (-DHEADLAND_OPENCV=ON).
Result<std::unique_ptr<Detector>> make_opencv_detector(const NetworkConfig& config);

/// An image file of any format that OpenCV reads. Errors as above; kSyntax if it is no image.
Result<Image> read_image(const std::string& file);

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::NetworkKind> {
  static constexpr std::pair<headland::NetworkKind, std::string_view> values[] = {
      {headland::NetworkKind::kSsd, "ssd"},
      {headland::NetworkKind::kDarknet, "darknet"},
      {headland::NetworkKind::kYoloV5, "yolo_v5"}};
};
