// SPDX-License-Identifier: Apache-2.0
#include "perception/cloud/cloud_file.hpp"

#include <bit>
#include <fstream>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "perception/cloud/internal/pcd_file.hpp"
#include "perception/cloud/internal/ply_file.hpp"
#include "perception/cloud/internal/point_table.hpp"

namespace headland {
namespace {

using namespace perception::internal;

static_assert(std::endian::native == std::endian::little, "the files are read as they lie");

Result<std::string> content_of(const std::filesystem::path& file) {
  const Location where{file.string(), 0, {}};
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    return fail(ErrorCode::kFileNotFound, "no such file", "check the path", where);
  }
  std::ifstream in(file, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(file, ignored)) {
    return fail(ErrorCode::kFileNotFound, "the file cannot be read", "check its permissions",
                where);
  }
  std::string content(std::filesystem::file_size(file), '\0');
  in.read(content.data(), std::ssize(content));
  content.resize(static_cast<std::size_t>(in.gcount()));
  return content;
}

Result<LidarScan> parse_kitti(std::string_view content, const Location& where) {
  constexpr std::size_t kRecord = 4 * sizeof(float);
  if (content.size() % kRecord != 0) {
    return fail(ErrorCode::kSyntax, fmt::format("{} bytes", content.size()),
                "16 bytes a point: x, y, z, reflectance", where);
  }
  std::vector<PointColumn> columns;
  const auto* first = reinterpret_cast<const std::byte*>(content.data());
  for (const char* name : {"x", "y", "z", "intensity"}) {
    columns.push_back({name, NumberType::kFloat32, false, first, kRecord});
    first += sizeof(float);
  }
  return scan_from(columns, static_cast<std::ptrdiff_t>(content.size() / kRecord), where);
}

}  // namespace

Result<LidarScan> load_cloud(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  const Location where{file.string(), 0, {}};
  if (extension != ".pcd" && extension != ".ply" && extension != ".bin") {
    return fail(ErrorCode::kUnsupported, fmt::format("a cloud of points in '{}'", extension),
                ".pcd, .ply or .bin", where);
  }
  const Result<std::string> content = content_of(file);
  if (!content) return tl::unexpected(content.error());
  if (extension == ".pcd") return parse_pcd(*content, where);
  if (extension == ".ply") return parse_ply(*content, where);
  return parse_kitti(*content, where);
}

std::optional<Error> save_pcd(const LidarScan& scan, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  const std::string content = to_pcd(scan);
  out.write(content.data(), std::ssize(content));
  out.close();
  if (out) return std::nullopt;
  return Error{ErrorCode::kFileNotWritable, "the cloud cannot be written",
               "check the folder and its free space", Location{file.string(), 0, {}}};
}

}  // namespace headland
