// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "core/base/result.hpp"
#include "core/world/lidar.hpp"

namespace headland {

/// Points from a file, by its extension: .pcd (ascii, binary, binary_compressed), .ply (ascii,
/// binary) or .bin (KITTI: x, y, z, reflectance as little-endian float32).
///
/// Frame: as in the file. Intensity, ring and time where the file has them (columns intensity,
/// ring, time or timestamp, of any type of number); integer times are nanoseconds. `time_s` is the
/// earliest of the file and offsets count from it; without times both are 0. Beams
/// without a return (not finite, or all zeros) are left out.
/// @return kFileNotFound, kUnsupported (another extension), or kSyntax with file and line.
/// O(file). Reads by itself: linking libpcl_io, which brings VTK and OpenNI, would cost each start
/// of the program 0.1 s.
Result<LidarScan> load_cloud(const std::filesystem::path& file);

/// Writes a scan as binary PCD with x, y, z, intensity, timestamp [s, float64] and ring.
/// @return Nothing, or kFileNotWritable.
std::optional<Error> save_pcd(const LidarScan& scan, const std::filesystem::path& file);

}  // namespace headland
