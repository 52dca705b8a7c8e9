// SPDX-License-Identifier: Apache-2.0
#include "perception/mapping/internal/octree_file.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace headland::perception::internal {
namespace {

constexpr int kDepth = 16;  // levels of OctoMap's trees

// Walks the nodes of a tree; false where they go beyond the end of the data or the deepest level.
class NodeWalk {
 public:
  NodeWalk(std::string_view data, OctreeFormat format) : data_(data), format_(format) {}

  bool node(int depth) {
    if (depth > kDepth) return false;
    return format_ == OctreeFormat::kBinary ? binary_node(depth) : full_node(depth);
  }

 private:
  // Two bits a child: unknown, free, occupied, or a node of its own (both bits).
  bool binary_node(int depth) {
    if (data_.size() - at_ < 2) return false;
    const auto low = static_cast<std::uint8_t>(data_[at_]);
    const auto high = static_cast<std::uint8_t>(data_[at_ + 1]);
    at_ += 2;
    for (int child = 0; child < 8; ++child) {
      const int bits = (child < 4 ? low : high) >> (2 * (child % 4)) & 3;
      if (bits == 3 && !node(depth + 1)) return false;
    }
    return true;
  }
  // Its value, then one bit a child.
  bool full_node(int depth) {
    constexpr std::size_t kSize = sizeof(float) + 1;
    if (data_.size() - at_ < kSize) return false;
    const auto children = static_cast<std::uint8_t>(data_[at_ + sizeof(float)]);
    at_ += kSize;
    for (int child = 0; child < 8; ++child) {
      if ((children >> child & 1) != 0 && !node(depth + 1)) return false;
    }
    return true;
  }

  std::string_view data_;
  OctreeFormat format_;
  std::size_t at_ = 0;
};

std::string_view first_line(OctreeFormat format) {
  return format == OctreeFormat::kBinary ? "# Octomap OcTree binary file\n"
                                         : "# Octomap OcTree file\n";
}

// What follows a key at the start of a line of the header; none where the key is absent.
std::optional<std::string_view> value_of(std::string_view header, std::string_view key) {
  const std::string line_start = "\n" + std::string(key) + " ";
  const std::size_t at = header.find(line_start);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view rest = header.substr(at + line_start.size());
  return rest.substr(0, rest.find('\n'));
}

}  // namespace

std::string octree_header(OctreeFormat format, std::size_t nodes, double cell) {
  return fmt::format("{}id OcTree\nsize {}\nres {}\ndata\n", first_line(format), nodes, cell);
}

Result<OctreeFile> check_octree(std::string_view content, OctreeFormat format,
                                const Location& where) {
  constexpr std::string_view kData = "\ndata\n";
  const std::size_t end = content.find(kData);
  if (!content.starts_with(first_line(format)) || end == std::string_view::npos) {
    return fail(ErrorCode::kSyntax, "not the header of an OctoMap file",
                "write it with OctoMap 1.x, .bt or .ot", where);
  }
  const std::string_view header = content.substr(0, end);
  if (value_of(header, "id") != "OcTree") {
    return fail(ErrorCode::kUnsupported, "another kind of tree", "id OcTree", where);
  }
  OctreeFile file{.cell = 0.0,
                  .empty = value_of(header, "size") == "0",
                  .nodes = content.substr(end + kData.size())};
  const std::string_view resolution = value_of(header, "res").value_or("");
  std::from_chars(resolution.data(), resolution.data() + resolution.size(), file.cell);
  if (!(file.cell > 0.0) || !std::isfinite(file.cell)) {
    return fail(ErrorCode::kSyntax, "no resolution", "res, in metres", where);
  }
  if (!file.empty && !NodeWalk(file.nodes, format).node(0)) {
    return fail(ErrorCode::kSyntax, "the tree is damaged or ends early", "", where);
  }
  return file;
}

}  // namespace headland::perception::internal
