// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace headland {

/// A colour image, row by row from its upper left corner.
struct Image {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 bytes a pixel

  /// Whether there are pixels, and as many as it says.
  bool is_sound() const {
    return width_px > 0 && height_px > 0 &&
           rgb.size() ==
               3 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  }
};

}  // namespace headland
