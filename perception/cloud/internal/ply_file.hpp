// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "core/base/result.hpp"
#include "core/world/lidar.hpp"

namespace headland::perception::internal {

/// The vertices of a file in the PLY format 1.0, ascii or binary of either endianness.
/// @param content The whole file.
/// @return The scan; kSyntax with the line (0: in the binary part), or kUnsupported where vertices
///         or what stands before them hold lists; `where` being the file.
Result<LidarScan> parse_ply(std::string_view content, const Location& where);

}  // namespace headland::perception::internal
