// SPDX-License-Identifier: Apache-2.0
#include "perception/mapping/octree_map.hpp"

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <octomap/OcTree.h>

#include "perception/mapping/internal/octree_file.hpp"

namespace headland {
namespace {

using perception::internal::check_octree;
using perception::internal::octree_header;
using perception::internal::OctreeFormat;

octomap::point3d to_octomap(const Eigen::Vector3d& p) {
  const Eigen::Vector3f f = p.cast<float>();
  return {f.x(), f.y(), f.z()};
}

std::optional<OctreeFormat> format_of(const std::filesystem::path& file) {
  if (file.extension() == ".bt") return OctreeFormat::kBinary;
  if (file.extension() == ".ot") return OctreeFormat::kFull;
  return std::nullopt;
}

Error unsupported(const std::filesystem::path& file) {
  return {ErrorCode::kUnsupported, fmt::format("a map in '{}'", file.extension().string()),
          ".bt or .ot", Location{file.string(), 0, {}}};
}

}  // namespace

struct OctreeMap::State {
  OctreeMapConfig config;
  std::unique_ptr<octomap::OcTree> tree;
};

OctreeMap::OctreeMap(const OctreeMapConfig& config)
    : state_(std::make_unique<State>(
          State{config, std::make_unique<octomap::OcTree>(config.cell_m)})) {
  octomap::OcTree& tree = *state_->tree;
  tree.setProbHit(config.hit_ratio);
  tree.setProbMiss(config.miss_ratio);
  tree.setClampingThresMin(config.least_ratio);
  tree.setClampingThresMax(config.most_ratio);
}

OctreeMap::~OctreeMap() = default;
OctreeMap::OctreeMap(OctreeMap&&) noexcept = default;
OctreeMap& OctreeMap::operator=(OctreeMap&&) noexcept = default;

Result<OctreeMap> OctreeMap::read(const std::filesystem::path& file) {
  const Location where{file.string(), 0, {}};
  const std::optional<OctreeFormat> format = format_of(file);
  if (!format) return tl::unexpected(unsupported(file));
  std::error_code ignored;
  std::ifstream in(file, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(file, ignored)) {
    return fail(ErrorCode::kFileNotFound, "no such file, or it cannot be read", "check the path",
                where);
  }
  const std::string content{std::istreambuf_iterator<char>(in), {}};
  const auto checked = check_octree(content, *format, where);
  if (!checked) return tl::unexpected(checked.error());
  OctreeMapConfig config;
  config.cell_m = checked->cell;
  OctreeMap map(config);
  if (checked->empty) return map;
  std::istringstream nodes{std::string(checked->nodes)};
  octomap::OcTree& tree = *map.state_->tree;
  *format == OctreeFormat::kFull ? tree.readData(nodes) : tree.readBinaryData(nodes);
  return map;
}

std::optional<Error> OctreeMap::write(const std::filesystem::path& file) const {
  const std::optional<OctreeFormat> format = format_of(file);
  if (!format) return unsupported(file);
  octomap::OcTree copy(*state_->tree);
  if (*format == OctreeFormat::kBinary) copy.toMaxLikelihood();
  copy.prune();
  std::ofstream out(file, std::ios::binary);
  out << octree_header(*format, copy.size(), copy.getResolution());
  if (copy.size() > 0) {
    *format == OctreeFormat::kBinary ? copy.writeBinaryData(out) : copy.writeData(out);
  }
  out.close();
  if (out) return std::nullopt;
  return Error{ErrorCode::kFileNotWritable, "the map cannot be written",
               "check the folder and its free space", Location{file.string(), 0, {}}};
}

void OctreeMap::insert(std::span<const LidarPoint> points, const Eigen::Vector3d& origin,
                       std::span<const MaskedDisc> masked) {
  if (!origin.allFinite()) return;
  octomap::Pointcloud cloud;
  cloud.reserve(points.size());
  for (const LidarPoint& point : points) {
    const Eigen::Vector3f& p = point.position;
    if (p.allFinite() && !is_masked(p, masked)) cloud.push_back(p.x(), p.y(), p.z());
  }
  constexpr bool kLazy = true;
  state_->tree->insertPointCloud(cloud, to_octomap(origin), state_->config.range_m, kLazy);
  state_->tree->updateInnerOccupancy();
}

std::optional<double> OctreeMap::probability(const Eigen::Vector3d& place) const {
  octomap::OcTreeKey key;
  if (!place.allFinite() || !state_->tree->coordToKeyChecked(to_octomap(place), key)) {
    return std::nullopt;
  }
  const octomap::OcTreeNode* node = state_->tree->search(key);
  if (node == nullptr) return std::nullopt;
  return node->getOccupancy();
}

std::optional<bool> OctreeMap::occupied(const Eigen::Vector3d& place) const {
  const std::optional<double> share = probability(place);
  if (!share) return std::nullopt;
  return *share >= state_->tree->getOccupancyThres();
}

double OctreeMap::cell() const { return state_->tree->getResolution(); }

std::size_t OctreeMap::node_count() const { return state_->tree->size(); }

}  // namespace headland
