// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/world/lidar.hpp"
#include "perception/rows/lane_refine.hpp"
#include "perception/rows/lane_search.hpp"
#include "perception/rows/published_rows.hpp"
#include "perception/rows/row_end.hpp"
#include "perception/rows/row_line.hpp"
#include "perception/rows/row_tracker.hpp"

namespace headland {

enum class RowMode : std::int8_t {
  kJoint,     ///< ours: joint search, robust refinement, filter over time, row end
  kPublished  ///< seed 000's recipe as published
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::RowMode> {
  static constexpr std::pair<headland::RowMode, std::string_view> values[] = {
      {headland::RowMode::kJoint, "joint"}, {headland::RowMode::kPublished, "published"}};
};

namespace headland {

struct RowDetectorConfig {
  RowMode mode = RowMode::kJoint;
  double row_width_m = 3.8;
  double sensor_x_m = 0.0;
  double sensor_y_m = 0.0;
  double sensor_z_m = 1.5;
  double ground_inlier_m = 0.12;
  double ground_height_m = 0.5;
  double ground_slope_deg = 20.0;
  double low_m = 0.3;
  double high_m = 2.0;
  int least_stations_count = 6;
  int near_stations_count = 4;
  double inside_limit_ratio = 0.5;
  LaneSearchConfig search;
  LaneRefineConfig refine;
  RowTrackerConfig tracker;
  RowEndConfig row_end;
  PublishedRowsConfig published;

  template <class V>
  void visit(V& v) {
    v("mode", mode, "Which detector");
    v("row_width_m", row_width_m, config::Range{0.3, 20.0}, "Between neighbouring rows [m]");
    v("sensor_x_m", sensor_x_m, config::Range{-20.0, 20.0}, "The lidar ahead of base [m]");
    v("sensor_y_m", sensor_y_m, config::Range{-20.0, 20.0}, "to the left of base [m]");
    v("sensor_z_m", sensor_z_m, config::Range{-5.0, 20.0}, "above base [m]");
    v("ground_inlier_m", ground_inlier_m, config::kPositive, "Of the ground's plane [m]");
    v("ground_height_m", ground_height_m, config::kPositive,
      "The ground lies within this of base's height [m]");
    v("ground_slope_deg", ground_slope_deg, config::Range{1.0, 60.0},
      "The ground is inclined no more than this against base [deg]");
    v("low_m", low_m, config::kNonNegative, "Lower above the ground it is grass [m]");
    v("high_m", high_m, config::kPositive, "Higher points are left out [m]");
    v("least_stations_count", least_stations_count, config::Range{2, 1000},
      "Stations of a row that must hold something");
    v("near_stations_count", near_stations_count, config::Range{1, 1000},
      "and as many of the first four metres ahead of the robot, for a lane to start");
    v("inside_limit_ratio", inside_limit_ratio, config::kPositive,
      "What stands in the lane, against what stands in the weaker row, at most");
    v("search", search, "Which lines are looked at");
    v("refine", refine, "How lines are fitted");
    v("tracker", tracker, "The filter over time");
    v("row_end", row_end, "The end of both rows");
    v("published", published, "Seed 000's recipe");
  }
};

/// Where are the rows beside the robot and where do they end? Scan by scan, with odometry.
///
/// Ground plane near base's height; columns of the crop's height band above it; joint search for
/// heading and both lines (`LaneSearch`); reweighted least squares (`LaneRefine`); a filter over
/// time (`RowTracker`); the rows' end (`RowEndFinder`). It abstains, with the reason, where the
/// lane's width, emptiness or support at the robot does not hold, beyond the rows' end, and when
/// nothing confirmed the lines for a second or two metres. A lane starts with both rows in sight,
/// one is enough to go on. Deterministic; not thread-safe.
class RowDetector {
 public:
  explicit RowDetector(const RowDetectorConfig& config);

  /// A scan in `base` (a full turn or less of one, deskewed), taken at `time_s` [s]; `moved` is the
  /// pose of this base in the base of the last scan, by odometry. A scan with time running
  /// backwards is refused and changes nothing. O(points); does not allocate once it has seen as
  /// many points (`joint`).
  RowEstimate update(const std::vector<LidarPoint>& points_base, const Pose2& moved, double time_s);
  /// Forgets everything.
  void reset();

 private:
  struct Sight {
    RowStatus status = RowStatus::kNoPoints;
    LaneFit fit;
    RowSides sides = RowSides::kNone;
  };

  RowEstimate update_joint(const std::vector<LidarPoint>& points_base);
  Sight look(const std::vector<LidarPoint>& points_base);
  Sight judged(const LaneFit& fit, double first_visible_m) const;
  double first_visible(const std::vector<LidarPoint>& points_base) const;
  bool has_ground_in_lane(const std::vector<LidarPoint>& points_base, const LaneFit& fit) const;
  void go_on(const Pose2& moved, double dt_s);
  RowEstimate outcome(const Sight& sight, RowStatus status) const;

  RowDetectorConfig config_;
  PublishedRows published_;
  internal::ColumnGrid columns_;
  LaneSearch search_;
  LaneRefine refine_;
  RowTracker tracker_;
  RowEndFinder end_finder_;
  std::vector<Eigen::Vector3d> ground_points_;
  std::optional<internal::FittedPlane> ground_;
  std::optional<double> last_time_s_;
};

}  // namespace headland
