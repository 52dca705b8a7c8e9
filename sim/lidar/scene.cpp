// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/scene.hpp"

#include <algorithm>
#include <cmath>

#include "sim/lidar/internal/agent_bodies.hpp"
#include "sim/lidar/internal/planting.hpp"

namespace headland {
namespace {

using internal::Planter;
using internal::Station;
using internal::World;

constexpr double kMargin = 60.0;      // around the rows [m]
constexpr double kAgentHeight = 2.0;  // none is taller [m]
constexpr double kTiledHeight = 5.0;  // of tiled plants, which are cut there [m]
constexpr double kSameLine = 0.3;     // of the spacing: lines this near are one
constexpr double kStripGround = 0.2;  // [m]

Point2 middle(const Polyline& line) { return line[line.size() / 2]; }

// The line moved to its left by `offset`, each point along the mean of its segments' normals.
Polyline moved_left(const Polyline& line, double offset) {
  Polyline moved;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Point2 way = line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0];
    const Point2 along = way.norm() > 0.0 ? Point2(way.normalized()) : Point2(1.0, 0.0);
    moved.push_back(line[i] + offset * Point2(-along.y(), along.x()));
  }
  return moved;
}

double distance_to(const Polyline& line, const Point2& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    least = std::min(least, distance_to_segment(p, line[i], line[i + 1]));
  }
  return least;
}

// Lines of plants on both sides of each row, those between two rows once.
std::vector<Polyline> lines_beside(const RowParcel& parcel) {
  std::vector<Polyline> lines;
  for (const Row& row : parcel.rows) {
    if (row.line.size() < 2) continue;
    for (const double side : {-0.5, 0.5}) {
      Polyline line = moved_left(row.line, side * parcel.row_spacing_m);
      const bool known = std::any_of(lines.begin(), lines.end(), [&](const Polyline& other) {
        return distance_to(other, middle(line)) < kSameLine * parcel.row_spacing_m;
      });
      if (!known) lines.push_back(std::move(line));
    }
  }
  return lines;
}

std::vector<Polyline> lines_of(const RowLayout& layout) {
  std::vector<Polyline> lines;
  for (int i = 0; i < layout.rows_count; ++i) {
    const double y = (i - 0.5 * (layout.rows_count - 1)) * layout.spacing_m;
    lines.push_back({{0.0, y}, {layout.length_m, y}});
    if (layout.next_block_m <= 0.0) continue;
    const double next = layout.length_m + layout.next_block_m;
    lines.push_back({{next, y}, {next + layout.next_block_length_m, y}});
  }
  return lines;
}

std::function<double(const Point2&)> slope_of(const RowLayout& layout) {
  const Point2 rise(std::tan(deg_to_rad(layout.slope_along_deg)),
                    std::tan(deg_to_rad(layout.slope_across_deg)));
  return [rise](const Point2& p) { return rise.dot(p); };
}

World empty_world(const std::vector<Polyline>& lines, double top, const OrchardConfig& config,
                  const std::function<double(const Point2&)>& height, std::uint64_t seed) {
  MapBox box(Point2(0.0, 0.0));
  if (!lines.empty()) box.setEmpty();
  for (const Polyline& line : lines) {
    for (const Point2& p : line) box.extend(p);
  }
  const Point2 margin = Point2::Constant(kMargin);
  World world({box.min() - margin, box.max() + margin}, std::max(top, kAgentHeight), height);
  world.set_grass(internal::grass_heights(config, seed), config.grass_area_density_1pm);
  return world;
}

double top_of(const OrchardConfig& config) {
  double top = std::max({config.canopy_high_m, config.post_height_m, config.trunk_height_m});
  for (const double wire : config.wire_heights_m) top = std::max(top, wire);
  return top;
}

std::vector<Polyline> meant(const std::vector<Polyline>& lines, const OrchardConfig& config) {
  std::vector<Polyline> swung;
  for (const Polyline& line : lines) {
    Polyline& points = swung.emplace_back();
    for (const Station& station : internal::stations(line, 1.0, config)) {
      points.push_back(station.position);
    }
  }
  return swung;
}

}  // namespace

CanopyStrip cut_strip(std::span<const Eigen::Vector3f> points, double heading_rad, double offset_m,
                      double half_width_m) {
  const auto c = static_cast<float>(std::cos(heading_rad));
  const auto s = static_cast<float>(std::sin(heading_rad));
  CanopyStrip strip;
  float first = std::numeric_limits<float>::infinity();
  for (const Eigen::Vector3f& p : points) {
    if (!p.allFinite() || static_cast<double>(p.z()) < kStripGround) continue;
    const Eigen::Vector3f turned(c * p.x() + s * p.y(),
                                 c * p.y() - s * p.x() - static_cast<float>(offset_m), p.z());
    if (static_cast<double>(std::abs(turned.y())) > half_width_m) continue;
    first = std::min(first, turned.x());
    strip.push_back(turned);
  }
  for (Eigen::Vector3f& p : strip) p.x() -= first;
  return strip;
}

LidarScene LidarScene::orchard(const Farm& farm, const Ground& ground, const OrchardConfig& config,
                               std::uint64_t seed) {
  std::vector<Polyline> lines;
  for (const RowParcel& parcel : farm.row_parcels) {
    for (Polyline& line : lines_beside(parcel)) lines.push_back(std::move(line));
  }
  double last = 0.0;
  const auto height = [&](const Point2& p) { return last = ground.height(p).value_or(last); };
  World world = empty_world(lines, top_of(config), config, height, seed);
  Planter planter(world, config, seed);
  for (const Polyline& line : lines) planter.plant(line);
  LidarScene scene;
  scene.lines_ = meant(lines, config);
  scene.plants_ = planter.plants();
  scene.world_ = std::make_shared<const World>(std::move(world));
  return scene;
}

LidarScene LidarScene::rows(const RowLayout& layout, const OrchardConfig& config,
                            std::uint64_t seed) {
  const std::vector<Polyline> lines = lines_of(layout);
  World world = empty_world(lines, top_of(config), config, slope_of(layout), seed);
  Planter planter(world, config, seed);
  for (const Polyline& line : lines) planter.plant(line);
  LidarScene scene;
  scene.lines_ = meant(lines, config);
  scene.plants_ = planter.plants();
  scene.world_ = std::make_shared<const World>(std::move(world));
  return scene;
}

LidarScene LidarScene::tiled(const RowLayout& layout, std::span<const CanopyStrip> strips,
                             const OrchardConfig& config, std::uint64_t seed) {
  const std::vector<Polyline> lines = lines_of(layout);
  World world = empty_world(lines, kTiledHeight, config, slope_of(layout), seed);
  Planter planter(world, config, seed);
  for (const Polyline& line : lines) planter.tile(line, strips);
  LidarScene scene;
  scene.lines_ = meant(lines, config);
  scene.world_ = std::make_shared<const World>(std::move(world));
  return scene;
}

void LidarScene::set_agents(std::span<const Agent> agents) {
  agents_.assign(agents.begin(), agents.end());
  bodies_.clear(world_->blocks());
  for (std::size_t i = 0; i < agents.size(); ++i) {
    for (const internal::Body& body : internal::bodies_of(agents[i], static_cast<int>(i))) {
      world_->insert(body, bodies_);
    }
  }
}

Eigen::Isometry3d LidarScene::pose_on_ground(const Pose2& pose) const {
  const TerrainSample below = ground(pose.position());
  const Eigen::Vector3d up =
      Eigen::Vector3d(-below.gradient.x(), -below.gradient.y(), 1.0).normalized();
  const Eigen::Vector3d ahead(pose.heading().x(), pose.heading().y(),
                              below.gradient.dot(pose.heading()));
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  T_map_base.linear().col(0) = ahead.normalized();
  T_map_base.linear().col(1) = up.cross(ahead.normalized());
  T_map_base.linear().col(2) = up;
  T_map_base.translation() = Eigen::Vector3d(pose.x, pose.y, below.height);
  return T_map_base;
}

}  // namespace headland
