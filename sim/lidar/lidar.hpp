// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/base/random.hpp"
#include "core/world/lidar.hpp"
#include "sim/lidar/scene.hpp"

namespace headland {

/// Which echo of a beam that meets several things becomes its point.
enum class ReturnMode : std::int8_t { kStrongest, kFirst, kLast };

/// A spinning lidar; the defaults are an RS-Helios-16P's (16 lasers, 10 Hz, 28 800 shots a turn).
struct LidarConfig {
  int lasers_count = 16;
  double lowest_deg = -15.0;
  double highest_deg = 15.0;
  double azimuth_step_deg = 0.2;
  double view_begin_deg = -180.0;
  double view_end_deg = 180.0;
  double rate_hz = 10.0;
  double laser_interval_s = 1.73e-6;
  int sub_rays_count = 4;
  double divergence_rad = 0.003;
  ReturnMode return_mode = ReturnMode::kStrongest;
  double echo_gap_m = 0.4;
  double near_m = 0.1;
  double far_m = 180.0;
  double far_dark_m = 110.0;
  double resolution_m = 0.0025;
  double noise_m = 0.01;
  double noise_ratio = 0.0002;
  double dropout_probability = 0.005;
  double stray_probability = 0.001;
  double stray_far_m = 15.0;
  double wind_m = 0.0;
  double wind_hz = 0.7;

  template <class V>
  void visit(V& v) {
    visit_beams(v);
    visit_returns(v);
  }

 private:
  template <class V>
  void visit_beams(V& v) {
    v("lasers_count", lasers_count, config::Range{1, 128}, "Lasers, evenly from lowest to highest");
    v("lowest_deg", lowest_deg, config::Range{-90.0, 90.0}, "Elevation of the lowest laser [deg]");
    v("highest_deg", highest_deg, config::Range{-90.0, 90.0}, "Of the highest laser [deg]");
    v("azimuth_step_deg", azimuth_step_deg, config::Range{0.01, 10.0}, "Between firings [deg]");
    v("view_begin_deg", view_begin_deg, config::Range{-180.0, 180.0},
      "Right end of the view, from ahead [deg]");
    v("view_end_deg", view_end_deg, config::Range{-180.0, 180.0}, "Left end of the view [deg]");
    v("rate_hz", rate_hz, config::Range{0.1, 100.0}, "Turns per second [Hz]");
    v("laser_interval_s", laser_interval_s, config::Range{0.0, 1e-3},
      "From a laser's shot to the next laser's in a firing [s]");
    v("sub_rays_count", sub_rays_count, config::Range{1, 9}, "Rays that stand for a beam");
    v("divergence_rad", divergence_rad, config::Range{0.0, 0.1}, "Full angle of a beam [rad]");
  }
  template <class V>
  void visit_returns(V& v) {
    v("return_mode", return_mode, "Which echo counts: strongest, first, last");
    v("echo_gap_m", echo_gap_m, config::kNonNegative,
      "Surfaces nearer to each other make one echo at their mean: mixed pixels [m]");
    v("near_m", near_m, config::kNonNegative, "Least range [m]");
    v("far_m", far_m, config::kPositive, "Largest range [m]");
    v("far_dark_m", far_dark_m, config::kPositive, "Range on a surface of 10 % reflectivity [m]");
    v("resolution_m", resolution_m, config::kNonNegative, "Ranges are multiples of this [m]");
    v("noise_m", noise_m, config::kNonNegative, "Standard deviation of the range [m]");
    v("noise_ratio", noise_ratio, config::kNonNegative,
      "Added to it, per metre of range, on a black surface");
    v("dropout_probability", dropout_probability, config::kFraction, "Of any echo to be lost");
    v("stray_probability", stray_probability, config::kFraction,
      "Of a shot to return from sun or dust where nothing is");
    v("stray_far_m", stray_far_m, config::kPositive, "Largest range of such a point [m]");
    v("wind_m", wind_m, config::Range{0.0, 0.5}, "Leaves swing to either side by this [m]");
    v("wind_hz", wind_hz, config::Range{0.0, 10.0}, "Swings per second [Hz]");
  }
};

/// What a point of a scan truly is.
struct PointTruth {
  Surface surface = Surface::kNone;  ///< of the larger part of the echo; kNone: a stray point
  int agent = -1;                    ///< index in the scene's agents
};

/// A spinning lidar in a scene. Each shot has its own time and pose, so that scans are warped by
/// the motion as real ones are. Deterministic for a seed and a sequence of calls. Does not allocate
/// once `out` is large enough.
class LidarSimulator {
 public:
  /// Requires values within the config's ranges.
  LidarSimulator(const LidarConfig& config, const SensorMount& mount, std::uint64_t seed);

  /// One turn, clockwise from the left end of the view, as the sensor delivers it: points in the
  /// sensor's frame at the time of their shot, by firing and in it from the lowest laser up.
  /// `T_map_base` gives the pose at a time [s] after the scan's first shot; it is asked once a
  /// firing (all lasers shoot within 28 us). `time_s`: of the first shot. About 50 ms.
  void scan(const LidarScene& scene, const std::function<Eigen::Isometry3d(double)>& T_map_base,
            double time_s, LidarScan& out);

  /// What the points of the last scan are, in their order.
  std::span<const PointTruth> truth() const { return truth_; }
  double duration() const;  ///< of a scan, from its first shot to the end of its last firing [s]

 private:
  static constexpr int kMostSubRays = 9;
  // What comes back of a sub-ray, or of all that are so near to each other that they make one.
  struct Echo {
    double range = 0.0;   // [m]
    double energy = 0.0;  // 1: of a white surface at right angles that fills the beam
    PointTruth truth;
  };
  struct Beam {
    Eigen::Vector3d direction;  // in the sensor's frame
    Eigen::Vector3d left;
    Eigen::Vector3d up;
  };

  Beam beam(int laser, double azimuth) const;
  void shoot(const LidarScene& scene, const Eigen::Isometry3d& T_map_sensor, const Beam& beam,
             double time);
  Echo chosen() const;
  bool read(Echo& echo);

  LidarConfig config_;
  Eigen::Isometry3d T_base_sensor_;
  RandomStream random_;
  std::vector<std::array<double, 2>> elevations_;  // cosine and sine by laser
  std::vector<std::array<double, 2>> sub_rays_;    // to the left and up, tangents
  std::array<Echo, kMostSubRays> parts_{};
  int parts_count_ = 0;
  std::vector<PointTruth> truth_;
};

/// Poses from one to another at constant velocity: the straight line between the positions, the
/// shortest turn between the attitudes; goes on beyond both. `duration` > 0 [s].
std::function<Eigen::Isometry3d(double)> linear_motion(const Eigen::Isometry3d& begin,
                                                       const Eigen::Isometry3d& end,
                                                       double duration);

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::ReturnMode> {
  static constexpr std::pair<headland::ReturnMode, std::string_view> values[] = {
      {headland::ReturnMode::kStrongest, "strongest"},
      {headland::ReturnMode::kFirst, "first"},
      {headland::ReturnMode::kLast, "last"}};
};
