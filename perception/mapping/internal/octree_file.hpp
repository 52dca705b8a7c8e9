// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/base/result.hpp"

namespace headland::perception::internal {

enum class OctreeFormat { kBinary, kFull };  // .bt, .ot

/// What OctoMap's readers of nodes need to know.
struct OctreeFile {
  double cell = 0.0;       ///< [m]
  bool empty = true;       ///< no node at all
  std::string_view nodes;  ///< the part of the file with the nodes
};

/// What stands before the nodes.
std::string octree_header(OctreeFormat format, std::size_t nodes, double cell);

/// Checks that a file holds a whole octree of occupancy: OctoMap's own readers go on after the end
/// of a file, and as deep as its bits say. kSyntax or kUnsupported otherwise.
Result<OctreeFile> check_octree(std::string_view content, OctreeFormat format,
                                const Location& where);

}  // namespace headland::perception::internal
