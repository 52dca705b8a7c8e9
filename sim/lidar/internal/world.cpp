// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/internal/world.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/base/random.hpp"

namespace headland::internal {
namespace {

constexpr int kVoxelsPerLayer = World::kSide * World::kSide;

template <class T>
std::uint64_t hash_of(const std::vector<T>& values) {
  return fnv1a({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

}  // namespace

void BodyIndex::clear(int blocks) {
  head.assign(static_cast<std::size_t>(blocks), -1);
  bodies.clear();
  links.clear();
}

void BodyIndex::add(std::int32_t block, std::int32_t body) {
  auto& first = head[static_cast<std::size_t>(block)];
  links.emplace_back(body, first);
  first = static_cast<std::int32_t>(links.size()) - 1;
}

World::World(const MapBox& box, double top, const std::function<double(const Point2&)>& height)
    : origin_(box.min()),
      columns_(std::max(1, static_cast<int>(std::ceil((box.max().x() - box.min().x()) / kBlock)))),
      rows_(std::max(1, static_cast<int>(std::ceil((box.max().y() - box.min().y()) / kBlock)))),
      layers_(std::max(1, static_cast<int>(std::ceil(top / kVoxel - 1e-9)))),
      tallest_(layers_ * kVoxel) {
  corners_.reserve(static_cast<std::size_t>((columns_ + 1) * (rows_ + 1)));
  for (int row = 0; row <= rows_; ++row) {
    for (int column = 0; column <= columns_; ++column) {
      const Point2 p = origin_ + kBlock * Point2(column, row);
      corners_.push_back(static_cast<float>(height(p)));
    }
  }
  const auto [low, high] = std::minmax_element(corners_.begin(), corners_.end());
  flat_ = *low == *high && *low == 0.0f;
  highest_ = static_cast<double>(*high) + tallest_;
  volume_.assign(static_cast<std::size_t>(blocks()), -1);
  fixed_.clear(blocks());
}

void World::set_grass(std::vector<float> heights, double area_density) {
  grass_ = std::move(heights);
  grass_top_ = area_density > 0.0 ? *std::max_element(grass_.begin(), grass_.end()) : 0.0;
  grass_rate_ = kLeafProjection * area_density;
}

void World::insert(const Body& body, BodyIndex& index) const {
  const auto number = static_cast<std::int32_t>(index.bodies.size());
  index.bodies.push_back(body);
  // Blocks whose middle lies within reach of the segment: a few too many do no harm.
  const double reach = body.radius + 0.5 * kBlock * std::sqrt(2.0);
  const Point2 a = (body.a.head<2>() - origin_) / kBlock;
  const Point2 b = (body.b.head<2>() - origin_) / kBlock;
  const Point2 margin = Point2::Constant(body.radius / kBlock);
  const Point2 low = a.cwiseMin(b) - margin;
  const Point2 high = a.cwiseMax(b) + margin;
  const auto bound = [](double value, int count) {
    return static_cast<int>(std::clamp(std::floor(value), -1.0, static_cast<double>(count)));
  };
  for (int row = std::max(0, bound(low.y(), rows_));
       row <= std::min(rows_ - 1, bound(high.y(), rows_)); ++row) {
    for (int column = std::max(0, bound(low.x(), columns_));
         column <= std::min(columns_ - 1, bound(high.x(), columns_)); ++column) {
      const Point2 middle(column + 0.5, row + 0.5);
      if (kBlock * distance_to_segment(middle, a, b) <= reach)
        index.add(block(column, row), number);
    }
  }
}

std::uint8_t* World::voxel(const Point2& p, double z) {
  const Point2 place = (p - origin_) / kVoxel;
  const int x = static_cast<int>(std::floor(place.x()));
  const int y = static_cast<int>(std::floor(place.y()));
  const int layer = static_cast<int>(std::floor(z / kVoxel));
  if (x < 0 || y < 0 || x >= columns_ * kSide || y >= rows_ * kSide) return nullptr;
  if (layer < 0 || layer >= layers_) return nullptr;
  auto& first = volume_[static_cast<std::size_t>(block(x / kSide, y / kSide))];
  if (first < 0) {
    first = static_cast<std::int32_t>(voxels_.size() / kVoxelsPerLayer);
    voxels_.resize(voxels_.size() + static_cast<std::size_t>(layers_ * kVoxelsPerLayer), 0);
  }
  const int within = (y % kSide) * kSide + x % kSide;
  return &voxels_[static_cast<std::size_t>(first + layer) * kVoxelsPerLayer +
                  static_cast<std::size_t>(within)];
}

double World::height_in(int column, int row, double x, double y) const {
  const double u = (x - origin_.x()) / kBlock - column;
  const double v = (y - origin_.y()) / kBlock - row;
  const double south = corner(column, row) + u * (corner(column + 1, row) - corner(column, row));
  const double north =
      corner(column, row + 1) + u * (corner(column + 1, row + 1) - corner(column, row + 1));
  return south + v * (north - south);
}

TerrainSample World::ground(const Point2& p) const {
  if (flat_) return {};
  const Point2 place = (p - origin_) / kBlock;
  const int column = static_cast<int>(std::clamp(place.x(), 0.0, columns_ - 1.0));
  const int row = static_cast<int>(std::clamp(place.y(), 0.0, rows_ - 1.0));
  const double step = 0.25 * kBlock;
  const auto height = [&](double dx, double dy) {
    return height_in(column, row, p.x() + dx, p.y() + dy);
  };
  return {height(0.0, 0.0),
          {(height(step, 0.0) - height(-step, 0.0)) / (2.0 * step),
           (height(0.0, step) - height(0.0, -step)) / (2.0 * step)}};
}

std::uint64_t World::fingerprint() const {
  std::uint64_t hash = hash_of(corners_);
  const auto mix = [&](std::uint64_t other) { hash = (hash ^ other) * 0x100000001b3ULL; };
  mix(hash_of(volume_));
  mix(hash_of(voxels_));
  mix(hash_of(grass_));
  std::vector<double> numbers;
  for (const Body& body : fixed_.bodies) {
    for (const double value : {body.a.x(), body.a.y(), body.a.z(), body.b.x(), body.b.y(),
                               body.b.z(), body.radius, static_cast<double>(body.surface)}) {
      numbers.push_back(value);
    }
  }
  mix(hash_of(numbers));
  return hash;
}

}  // namespace headland::internal
