// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/result.hpp"
#include "core/world/camera.hpp"
#include "core/world/image.hpp"

namespace headland {

/// Finds people, animals and vehicles on an image. One object per thread.
class Detector {
 public:
  virtual ~Detector() = default;

  /// Boxes by falling score, within the image; none is fine.
  /// @return kOutOfRange for an image that is empty or not as large as it says; kInternal if the
  ///         network fails.
  Result<std::vector<DetectedBox>> detect(const Image& image) {
    if (!image.is_sound()) {
      return fail(ErrorCode::kOutOfRange, "the image is empty or its size is wrong",
                  "width times height pixels of 3 bytes");
    }
    return do_detect(image);
  }

 private:
  virtual Result<std::vector<DetectedBox>> do_detect(const Image& image) = 0;
};

}  // namespace headland
