// SPDX-License-Identifier: Apache-2.0
#include "perception/detection/opencv_detector.hpp"

// For builds without OpenCV.

namespace headland {
namespace {

constexpr const char* kWhat = "this program was built without OpenCV";
constexpr const char* kRemedy = "install libopencv-dev and build with -DHEADLAND_OPENCV=ON";

}  // namespace

Result<std::unique_ptr<Detector>> make_opencv_detector(const NetworkConfig&) {
  return fail(ErrorCode::kUnsupported, kWhat, kRemedy);
}

Result<Image> read_image(const std::string&) {
  return fail(ErrorCode::kUnsupported, kWhat, kRemedy);
}

}  // namespace headland
