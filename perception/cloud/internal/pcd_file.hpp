// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "core/base/result.hpp"
#include "core/world/lidar.hpp"

namespace headland::perception::internal {

/// A point cloud in the PCD format, version 0.7 and older: DATA ascii, binary or binary_compressed.
/// @param content The whole file.
/// @return The scan, or kSyntax with the line (0: in the binary part), `where` being the file.
Result<LidarScan> parse_pcd(std::string_view content, const Location& where);

/// The scan as PCD, binary, with x, y, z, intensity, timestamp [s, float64] and ring.
std::string to_pcd(const LidarScan& scan);

}  // namespace headland::perception::internal
