// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/config/visit.hpp"
#include "core/world/lidar.hpp"
#include "perception/rows/internal/ground_fit.hpp"
#include "perception/rows/row_line.hpp"

namespace headland {

struct RowEndConfig {
  double bin_m = 0.25;
  double ahead_m = 22.0;
  double behind_m = 10.0;
  double low_m = 0.3;
  double high_m = 2.0;
  double gate_ratio = 0.25;
  double gap_m = 2.5;
  double free_hit_ratio = 0.03;
  double least_hit_ratio = 0.12;
  double rays_weight = 8.0;
  double evidence_weight = 8.0;

  template <class V>
  void visit(V& v) {
    v("bin_m", bin_m, config::Range{0.05, 1.0},
      "Length of row whose rays are counted together [m]");
    v("ahead_m", ahead_m, config::kPositive, "The end is looked for so far ahead [m]");
    v("behind_m", behind_m, config::kPositive, "Rays are remembered so far behind [m]");
    v("low_m", low_m, config::kNonNegative, "Rays count that cross the row above this height [m]");
    v("high_m", high_m, config::kPositive, "and below this one [m]");
    v("gate_ratio", gate_ratio, config::Range{0.05, 0.5},
      "A ray hits the row within this share of the lane's width");
    v("gap_m", gap_m, config::kPositive, "A gap in both rows no longer than this is no end [m]");
    v("free_hit_ratio", free_hit_ratio, config::Range{1e-4, 0.5},
      "Share of rays that hit something where there is no row");
    v("least_hit_ratio", least_hit_ratio, config::Range{1e-3, 0.9},
      "Share of rays that hit the thinnest row");
    v("rays_weight", rays_weight, config::kPositive,
      "As many independent rays a bin counts at most: neighbours pass the same hole");
    v("evidence_weight", evidence_weight, config::kPositive,
      "Logarithm of the odds from which an end is believed");
  }
};

/// Finds the end of both rows before the robot gets there.
///
/// Along the line of each row bins count the rays that end in it and the rays that pass through it
/// at the height of the crop and return from farther on: an end is where rays pass, and not merely
/// where nothing returned. What a row hits is learned from the stretch beside the robot; then the
/// logarithm of the odds "row" against "no row" is summed outwards (Page's CUSUM) over both rows,
/// so that a missing plant on one side is outvoted by the other, and the first fall of more than
/// `evidence_weight` over more than `gap_m` is the end. Rows that start again behind it, the next
/// block's, are not looked at. Odometry carries the bins.
class RowEndFinder {
 public:
  /// The sensor's place in base [m] is where rays start.
  RowEndFinder(const RowEndConfig& config, const Eigen::Vector3d& sensor_base);

  /// Forgets all rays, and the end unless `keep_end`.
  void reset(bool keep_end = false);
  /// The robot went on by so much along the row [m].
  void move(double along_m);
  /// Counts the rays of a scan against the lane it stands in and looks for the end. O(points).
  void update(std::span<const LidarPoint> points_base, const internal::FittedPlane& ground,
              const RowEstimate& lane);
  /// The end as known now.
  RowEnd end() const;

 private:
  struct Bin {
    float hits = 0.0f;
    float passes = 0.0f;
    float hits_m = 0.0f;  // mean place of the hits along the row
  };

  Bin* bin_at(std::size_t side, double u);
  const Bin* bin_at(std::size_t side, double u) const;
  void count_ray(std::size_t side, double u, bool is_hit);
  void count_rays(std::span<const LidarPoint> points_base, const internal::FittedPlane& ground,
                  const RowEstimate& lane);
  double hit_ratio() const;
  double log_odds(const Bin& bin, double hit_ratio) const;
  void look_for_end();

  RowEndConfig config_;
  Eigen::Vector3d sensor_base_;
  double along_m_ = 0.0;  // of the robot since the last reset
  std::array<std::vector<Bin>, 2> bins_;
  std::optional<double> end_along_m_;
  double end_deviation_m_ = 0.0;
};

}  // namespace headland
