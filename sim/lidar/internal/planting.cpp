// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/internal/planting.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace headland::internal {
namespace {

constexpr double kStep = 0.1;       // between stations [m]: half a voxel
constexpr double kOutline = 0.4;    // length over which the canopy keeps its width [m]
constexpr double kNarrowest = 0.5;  // width of the canopy at its thinnest, over the full one
constexpr double kThickest = 4.0;   // densest clump over the mean
constexpr double kInGround = -0.2;  // where trunks and posts begin [m]
constexpr int kTilePoint = 12;      // what a point of a scan adds to its voxel, in density steps

const Station& at(const std::vector<Station>& row, double s) {
  const double index = std::round((s - row.front().s) / kStep);
  const double last = static_cast<double>(row.size() - 1);
  return row[static_cast<std::size_t>(std::clamp(index, 0.0, last))];
}

}  // namespace

std::vector<Station> stations(const Polyline& line, double step, const OrchardConfig& config) {
  std::vector<Station> row;
  double before = 0.0;  // length of the segments passed
  double s = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Point2 way = line[i + 1] - line[i];
    const double length = way.norm();
    if (!(length > 0.0)) continue;
    const Point2 along = way / length;
    const Point2 left(-along.y(), along.x());
    for (; s <= before + length + 1e-9; s += step) {
      const double swing = config.curvature_amplitude_m *
                           std::sin(2.0 * std::numbers::pi * s / config.curvature_wavelength_m);
      row.push_back({s, line[i] + (s - before) * along + swing * left, left});
    }
    before += length;
  }
  return row;
}

Planter::Planter(World& world, const OrchardConfig& config, std::uint64_t seed)
    : world_(world),
      config_(config),
      places_(seed, "sim/lidar/places"),
      leaves_(seed, "sim/lidar/leaves"),
      tiles_(seed, "sim/lidar/tiles") {}

void Planter::plant(const Polyline& line) {
  const std::vector<Station> row = stations(line, kStep, config_);
  if (row.empty()) return;
  set_plants(row);
  set_posts(row);
  set_canopy(row);
}

void Planter::set_plants(const std::vector<Station>& row) {
  alive_.clear();
  const double pitch = config_.trunk_pitch_m;
  for (int slot = 0; (slot + 0.5) * pitch <= row.back().s; ++slot) {
    const double s = (slot + 0.5) * pitch + config_.pitch_jitter_m * places_.normal();
    const double across = config_.lateral_jitter_m * places_.normal();
    alive_.push_back(places_.uniform() >= config_.missing_ratio);
    if (!alive_.back()) continue;
    const Station& station = at(row, s);
    const Point2 p = station.position + across * station.left;
    plants_.push_back(p);
    if (config_.trunk_radius_m <= 0.0) continue;
    const double radius = config_.trunk_radius_m * places_.uniform(0.8, 1.2);
    world_.add({{p.x(), p.y(), kInGround},
                {p.x(), p.y(), config_.trunk_height_m},
                radius,
                Surface::kTrunk,
                -1});
  }
}

void Planter::set_posts(const std::vector<Station>& row) {
  const int spans = std::max(1, static_cast<int>(std::round(row.back().s / config_.post_pitch_m)));
  Point2 before = row.front().position;
  for (int i = 0; i <= spans; ++i) {
    const Station& station = at(row, row.back().s * i / spans);
    const Point2 p =
        station.position + 0.5 * config_.lateral_jitter_m * places_.normal() * station.left;
    if (config_.post_radius_m > 0.0) {
      world_.add({{p.x(), p.y(), kInGround},
                  {p.x(), p.y(), config_.post_height_m},
                  config_.post_radius_m,
                  Surface::kPost,
                  -1});
    }
    if (i > 0) set_wires(before, p);
    before = p;
  }
}

void Planter::set_wires(const Point2& from, const Point2& to) {
  if (config_.wire_radius_m <= 0.0) return;
  for (const double z : config_.wire_heights_m) {
    world_.add(
        {{from.x(), from.y(), z}, {to.x(), to.y(), z}, config_.wire_radius_m, Surface::kWire, -1});
  }
}

// Leaves come in clumps of a voxel's size whose density is spread as an exponential about the mean.
// Each place half a voxel from the next adds its share to the voxel that it lies in.
void Planter::set_canopy(const std::vector<Station>& row) {
  const double step = 0.5 * World::kVoxel;
  const int wide = static_cast<int>(std::ceil(2.0 * config_.canopy_half_width_m / step));
  const int high =
      static_cast<int>(std::ceil((config_.canopy_high_m - config_.canopy_low_m) / step));
  std::vector<double> clumps(static_cast<std::size_t>((wide / 2 + 1) * (high / 2 + 1)));
  double outline = 1.0;
  double outline_end = 0.0;
  for (std::size_t k = 0; k < row.size(); ++k) {
    const Station& station = row[k];
    if (station.s >= outline_end) {
      outline = leaves_.uniform(kNarrowest, 1.0);
      outline_end += kOutline;
    }
    if (k % 2 == 0) {
      for (double& clump : clumps) {
        clump = std::min(kThickest, -std::log(1.0 - leaves_.uniform()));
      }
    }
    for (int i = 0; i < wide; ++i) {
      const double across = (i + 0.5) * step - config_.canopy_half_width_m;
      const Point2 p = station.position + across * station.left;
      for (int j = 0; j < high; ++j) {
        const double z = config_.canopy_low_m + (j + 0.5) * step;
        const double mean = density(station.s, across, z, outline);
        if (mean <= 0.0) continue;
        fill(p, z, mean * clumps[static_cast<std::size_t>(i / 2 * (high / 2 + 1) + j / 2)] / 8.0);
      }
    }
  }
}

// Mean density of the canopy at a place.
double Planter::density(double s, double across, double z, double outline) const {
  const double slots = s / config_.trunk_pitch_m;
  const auto slot = static_cast<std::size_t>(slots);
  if (slot < alive_.size() && !alive_[slot]) return 0.0;
  const double half_height = 0.5 * (config_.canopy_high_m - config_.canopy_low_m);
  const double up = (z - config_.canopy_low_m) / half_height - 1.0;
  const double side = across / config_.canopy_half_width_m;
  if (std::abs(up) > 0.5 + 0.5 * outline || std::abs(side) > outline) return 0.0;
  const double apart = 2.0 * std::abs(slots - static_cast<double>(slot) - 0.5);  // 1: half way
  const double wood = std::abs(side) < 0.5 ? config_.branch_area_density_1pm : 0.0;
  return (config_.leaf_area_density_1pm + wood) * (1.0 - config_.crown_ratio * apart * apart);
}

// Adds to the density of a voxel, in its steps, rounded by chance so that the mean stays.
void Planter::fill(const Point2& p, double z, double area_density) {
  std::uint8_t* voxel = world_.voxel(p, z);
  if (voxel == nullptr) return;
  const double stored = *voxel + area_density / World::kDensityStep + leaves_.uniform();
  *voxel = static_cast<std::uint8_t>(std::min(stored, 255.0));
}

void Planter::tile(const Polyline& line, std::span<const std::vector<Eigen::Vector3f>> strips) {
  const std::vector<Station> row = stations(line, kStep, config_);
  if (row.empty() || strips.empty()) return;
  for (double s = 0.0; s < row.back().s;) {
    const auto& strip =
        strips[static_cast<std::size_t>(tiles_.index(static_cast<int>(strips.size())))];
    const bool turned = tiles_.uniform() < 0.5;
    double length = kStep;
    for (const Eigen::Vector3f& p : strip) length = std::max(length, static_cast<double>(p.x()));
    for (const Eigen::Vector3f& p : strip) {
      const double along =
          s + (turned ? length - static_cast<double>(p.x()) : static_cast<double>(p.x()));
      if (along > row.back().s) continue;
      const Station& station = at(row, along);
      const double across = turned ? -static_cast<double>(p.y()) : static_cast<double>(p.y());
      std::uint8_t* voxel =
          world_.voxel(station.position + across * station.left, static_cast<double>(p.z()));
      if (voxel != nullptr) *voxel = static_cast<std::uint8_t>(std::min(255, *voxel + kTilePoint));
    }
    s += length;
  }
}

std::vector<float> grass_heights(const OrchardConfig& config, std::uint64_t seed) {
  RandomStream stream(seed, "sim/lidar/grass");
  constexpr int kSide = World::kGrassSide;
  std::vector<float> heights(static_cast<std::size_t>(kSide * kSide));
  for (float& height : heights) {
    height = static_cast<float>(stream.uniform(config.grass_low_m, config.grass_high_m));
  }
  return heights;
}

}  // namespace headland::internal
