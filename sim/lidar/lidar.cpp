// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/lidar.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace headland {
namespace {

// Reflectivity at 905 nm by Surface: typical figures of vegetation, soil, bark, wood, steel and
// clothes or wool.
constexpr std::array<double, kSurfaces> kReflectivity = {0.0, 0.25, 0.4, 0.5, 0.3, 0.35, 0.4, 0.45};
constexpr double kDark = 0.1;  // reflectivity at which far_dark_m holds

double reflectivity(Surface surface) { return kReflectivity[static_cast<std::size_t>(surface)]; }

bool is_porous(Surface surface) {
  return surface == Surface::kCanopy || surface == Surface::kGrass;
}

}  // namespace

LidarSimulator::LidarSimulator(const LidarConfig& config, const SensorMount& mount,
                               std::uint64_t seed)
    : config_(config), T_base_sensor_(mount.pose()), random_(seed, "sim/lidar") {
  const int lasers = config.lasers_count;
  for (int i = 0; i < lasers; ++i) {
    const double share = lasers > 1 ? static_cast<double>(i) / (lasers - 1) : 0.0;
    const double elevation =
        deg_to_rad(config.lowest_deg + share * (config.highest_deg - config.lowest_deg));
    elevations_.push_back({std::cos(elevation), std::sin(elevation)});
  }
  // One in the middle, the others about it where they stand for equal areas of the disc.
  sub_rays_.push_back({0.0, 0.0});
  const int around = config.sub_rays_count - 1;
  const double radius = 0.35 * config.divergence_rad;
  for (int i = 0; i < around; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / around;
    sub_rays_.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
}

double LidarSimulator::duration() const {
  return (config_.view_end_deg - config_.view_begin_deg) / 360.0 / config_.rate_hz;
}

LidarSimulator::Beam LidarSimulator::beam(int laser, double azimuth) const {
  const auto& [c, s] = elevations_[static_cast<std::size_t>(laser)];
  const double x = std::cos(azimuth);
  const double y = std::sin(azimuth);
  return {{c * x, c * y, s}, {-y, x, 0.0}, {-s * x, -s * y, c}};
}

void LidarSimulator::scan(const LidarScene& scene,
                          const std::function<Eigen::Isometry3d(double)>& T_map_base, double time_s,
                          LidarScan& out) {
  out.time_s = time_s;
  out.points.clear();
  truth_.clear();
  const double view = config_.view_end_deg - config_.view_begin_deg;
  const int firings = static_cast<int>(std::round(view / config_.azimuth_step_deg));
  const double firing_s = config_.azimuth_step_deg / 360.0 / config_.rate_hz;
  const double spin = -deg_to_rad(config_.azimuth_step_deg) / firing_s;  // [rad/s]
  for (int firing = 0; firing < firings; ++firing) {
    const double begin = firing * firing_s;
    const Eigen::Isometry3d T_map_sensor = T_map_base(begin) * T_base_sensor_;
    for (int laser = 0; laser < config_.lasers_count; ++laser) {
      const double offset = begin + laser * config_.laser_interval_s;
      const Beam shot = beam(laser, deg_to_rad(config_.view_end_deg) + spin * offset);
      shoot(scene, T_map_sensor, shot, time_s + offset);
      Echo echo = chosen();
      if (!read(echo)) continue;
      out.points.push_back({(echo.range * shot.direction).cast<float>(),
                            static_cast<float>(std::min(1.0, echo.energy)),
                            static_cast<float>(offset), static_cast<std::uint16_t>(laser)});
      truth_.push_back(echo.truth);
    }
  }
}

// Sends the beam's sub-rays and keeps what comes back of each, by range.
void LidarSimulator::shoot(const LidarScene& scene, const Eigen::Isometry3d& T_map_sensor,
                           const Beam& beam, double time) {
  parts_count_ = 0;
  Ray ray;
  ray.origin = T_map_sensor.translation();
  ray.max_range = config_.far_m;
  const auto rays = static_cast<double>(sub_rays_.size());
  ray.width_rad = config_.divergence_rad / std::sqrt(rays);
  for (const auto& [left, up] : sub_rays_) {
    const Eigen::Vector3d direction = beam.direction + left * beam.left + up * beam.up;
    ray.direction = T_map_sensor.linear() * direction.normalized();
    ray.depth = -std::log(1.0 - random_.uniform());
    ray.chance = random_.uniform();
    const RayHit hit = scene.trace(ray);
    if (hit.surface == Surface::kNone) continue;
    Echo part{hit.range, reflectivity(hit.surface) / rays, {hit.surface, hit.agent}};
    // Leaves hang at all angles.
    part.energy *= is_porous(hit.surface) ? random_.uniform(0.3, 1.0) : hit.cosine;
    if (hit.surface == Surface::kCanopy && config_.wind_m > 0.0) {
      const Eigen::Vector3d place = ray.origin + hit.range * ray.direction;
      const double phase = 2.0 * std::numbers::pi * config_.wind_hz * time + place.x() + place.y();
      part.range += config_.wind_m * std::sin(phase) * ray.direction.y();
    }
    int slot = parts_count_++;
    for (; slot > 0 && parts_[static_cast<std::size_t>(slot - 1)].range > part.range; --slot) {
      parts_[static_cast<std::size_t>(slot)] = parts_[static_cast<std::size_t>(slot - 1)];
    }
    parts_[static_cast<std::size_t>(slot)] = part;
  }
}

// Joins parts without a gap between them into echoes and picks one by the return mode.
LidarSimulator::Echo LidarSimulator::chosen() const {
  Echo echo;
  Echo current;
  double largest = 0.0;  // part of the current echo
  const auto close = [&] {
    if (current.energy <= 0.0) return;
    current.range /= current.energy;
    const bool better = config_.return_mode == ReturnMode::kStrongest
                            ? current.energy > echo.energy
                            : config_.return_mode == ReturnMode::kLast || echo.energy <= 0.0;
    if (better) echo = current;
  };
  for (int i = 0; i < parts_count_; ++i) {
    const Echo& part = parts_[static_cast<std::size_t>(i)];
    if (i == 0 || part.range - parts_[static_cast<std::size_t>(i - 1)].range > config_.echo_gap_m) {
      close();
      current = {};
      largest = 0.0;
    }
    current.range += part.energy * part.range;
    current.energy += part.energy;
    if (part.energy > largest) {
      largest = part.energy;
      current.truth = part.truth;
    }
  }
  close();
  return echo;
}

// What the receiver makes of an echo: weak ones are lost, ranges are noisy and rounded.
bool LidarSimulator::read(Echo& echo) {
  const bool stray = random_.uniform() < config_.stray_probability;
  const bool lost = random_.uniform() < config_.dropout_probability;
  const double noise = random_.normal();
  const double gain = 1.0 + 0.2 * random_.normal();
  if (stray) {
    echo = {random_.uniform(config_.near_m, config_.stray_far_m), 0.02, {}};
  } else {
    const double reach = echo.range / config_.far_dark_m;
    if (lost || gain * echo.energy < kDark * reach * reach || echo.energy <= 0.0) return false;
    const double dark = config_.noise_ratio * (1.0 - std::min(1.0, echo.energy));
    echo.range += noise * (config_.noise_m + dark * echo.range);
  }
  if (config_.resolution_m > 0.0) {
    echo.range = std::round(echo.range / config_.resolution_m) * config_.resolution_m;
  }
  return echo.range >= config_.near_m && echo.range <= config_.far_m;
}

std::function<Eigen::Isometry3d(double)> linear_motion(const Eigen::Isometry3d& begin,
                                                       const Eigen::Isometry3d& end,
                                                       double duration) {
  const Eigen::Vector3d velocity = (end.translation() - begin.translation()) / duration;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(begin.linear().transpose() * end.linear()));
  const Eigen::Vector3d axis = turn.axis();
  const double rate = turn.angle() / duration;
  return [begin, velocity, axis, rate](double t) {
    Eigen::Isometry3d pose = begin;
    pose.translation() += t * velocity;
    pose.linear() = begin.linear() * Eigen::AngleAxisd(rate * t, axis).toRotationMatrix();
    return pose;
  };
}

}  // namespace headland
