// SPDX-License-Identifier: Apache-2.0
#include "perception/rows/row_detector.hpp"

#include <algorithm>
#include <cmath>

#include "perception/rows/internal/line_motion.hpp"

namespace headland {
namespace {

constexpr int kGroundIterations = 150;
constexpr int kLeastPoints = 100;
constexpr int kLeastGroundCells = 12;  // of a metre
constexpr int kLeastLanePoints = 20;
constexpr double kNearAhead = 4.0;      // [m]
constexpr double kBehindSensor = 1.0;   // [m]
constexpr double kBeside = 0.0;         // [m]
constexpr double kBesideSensor = 0.75;  // [m]
constexpr double kWidestHeading = 0.6;  // of a lane the robot drives in [rad]

internal::ColumnConfig columns_of(const RowDetectorConfig& config) {
  internal::ColumnConfig columns;
  columns.behind_m = std::max(config.search.behind_m, config.refine.behind_m) + 2.0;
  columns.ahead_m = std::max(config.search.ahead_m, config.refine.ahead_m) + 2.0;
  columns.aside_m = 2.2 * config.row_width_m + 1.0;
  columns.low_m = config.low_m;
  columns.high_m = config.high_m;
  return columns;
}

RowEndConfig end_of(const RowDetectorConfig& config) {
  RowEndConfig end = config.row_end;
  end.low_m = std::max(end.low_m, config.low_m);
  return end;
}

}  // namespace

RowDetector::RowDetector(const RowDetectorConfig& config)
    : config_(config),
      published_(config.published, config.row_width_m),
      columns_(columns_of(config)),
      search_(config.search),
      refine_(config.refine),
      tracker_(config.tracker),
      end_finder_(end_of(config), {config.sensor_x_m, config.sensor_y_m, config.sensor_z_m}) {}

void RowDetector::reset() { *this = RowDetector(RowDetectorConfig(config_)); }

// A lane starts with both rows beside the robot and ahead of it; one row anywhere near is enough to
// go on.
RowDetector::Sight RowDetector::judged(const LaneFit& fit, double first_visible_m) const {
  Sight sight{RowStatus::kValid, fit, RowSides::kNone};
  const bool right = fit.stations[0] >= config_.least_stations_count;
  const bool left = fit.stations[1] >= config_.least_stations_count;
  if (left && right) sight.sides = RowSides::kBoth;
  if (left != right) sight.sides = left ? RowSides::kLeft : RowSides::kRight;
  const bool starts = !tracker_.is_known();
  const bool has_support = starts ? left && right : left || right;
  const double weaker = left && right ? std::min(fit.support[0], fit.support[1])
                                      : std::max(fit.support[0], fit.support[1]);
  const auto starts_beside = [&](std::size_t side) {
    return fit.near_stations[side] >= config_.near_stations_count &&
           fit.begins_m[side] <= first_visible_m;
  };
  const auto goes_on = [&](std::size_t side) { return fit.begins_m[side] < kNearAhead; };
  const bool is_at_robot = starts ? starts_beside(0) && starts_beside(1) : goes_on(0) || goes_on(1);
  if (!has_support) {
    sight.status = RowStatus::kNoLane;
  } else if (!search_.is_wide_enough(fit.width_m, config_.row_width_m)) {
    sight.status = RowStatus::kWidthOff;
  } else if (fit.inside > config_.inside_limit_ratio * weaker ||
             std::abs(fit.heading_rad) > kWidestHeading ||
             std::abs(fit.offset_m) > 0.5 * fit.width_m) {
    sight.status = RowStatus::kNotALane;
  } else if (!is_at_robot) {
    sight.status = RowStatus::kNotAtRobot;
  }
  return sight;
}

RowDetector::Sight RowDetector::look(const std::vector<LidarPoint>& points_base) {
  ground_.reset();
  const auto is_finite = [](const LidarPoint& point) { return point.position.allFinite(); };
  const auto finite = std::count_if(points_base.begin(), points_base.end(), is_finite);
  if (finite < kLeastPoints) return {RowStatus::kNoPoints, {}, RowSides::kNone};
  internal::PlaneFitConfig plane;
  plane.iterations = kGroundIterations;
  plane.inlier_m = config_.ground_inlier_m;
  plane.height_prior_m = config_.ground_height_m;
  plane.steepest_rad = deg_to_rad(config_.ground_slope_deg);
  plane.below_weight = 1.0;
  plane.least_inliers = kLeastGroundCells;
  ground_ = internal::fit_ground(points_base, plane, ground_points_);
  if (!ground_) return {RowStatus::kNoGround, {}, RowSides::kNone};
  const auto columns = columns_.fill(points_base, *ground_);
  const bool is_known = tracker_.is_known();
  const double expected_heading = is_known ? tracker_.lane().heading_rad : 0.0;
  const double expected_width = is_known ? tracker_.lane().width_m : config_.row_width_m;
  const auto start = search_.search(columns, config_.row_width_m, expected_heading);
  if (!start) return {RowStatus::kNoLane, {}, RowSides::kNone};
  const Sight sight =
      judged(refine_.refine(columns, *start, expected_width), first_visible(points_base));
  if (sight.status == RowStatus::kValid && !has_ground_in_lane(points_base, sight.fit)) {
    return {RowStatus::kNoGround, {}, RowSides::kNone};
  }
  return sight;
}

// Where rows beside the robot are seen from on: at the robot, or ahead of a sensor that looks
// ahead.
double RowDetector::first_visible(const std::vector<LidarPoint>& points_base) const {
  const auto behind = std::count_if(points_base.begin(), points_base.end(), [&](const auto& point) {
    return point.position.x() < config_.sensor_x_m - kBehindSensor;
  });
  return behind >= kLeastPoints ? kBeside : std::max(0.0, config_.sensor_x_m) + kBesideSensor;
}

// A plane without a point between the rows is a slice through their canopy.
bool RowDetector::has_ground_in_lane(const std::vector<LidarPoint>& points_base,
                                     const LaneFit& fit) const {
  const double c = std::cos(fit.heading_rad);
  const double s = std::sin(fit.heading_rad);
  int count = 0;
  for (const LidarPoint& point : points_base) {
    const Eigen::Vector3d p = point.position.cast<double>();
    const double across = c * p.y() - s * p.x() - fit.offset_m;
    if (std::abs(across) > 0.25 * fit.width_m) continue;
    count += std::abs(ground_->height(p)) <= config_.ground_inlier_m ? 1 : 0;
  }
  return count >= kLeastLanePoints;
}

void RowDetector::go_on(const Pose2& moved, double dt_s) {
  if (!tracker_.is_known()) {
    end_finder_.move(moved.x);
    return;
  }
  end_finder_.move(internal::motion_in_row(tracker_.lane().heading_rad, moved).x());
  tracker_.predict(moved, dt_s);
  if (!tracker_.is_fresh()) {
    tracker_.reset();
    end_finder_.reset(true);
  }
}

RowEstimate RowDetector::outcome(const Sight& sight, RowStatus status) const {
  RowEstimate result;
  const RowEnd end = end_finder_.end();
  if (tracker_.is_valid()) {
    result = tracker_.lane();
    result.valid = true;
    status = RowStatus::kValid;
    result.sides = sight.sides;
    result.row_end = end;
  }
  result.status = status;
  return result;
}

RowEstimate RowDetector::update_joint(const std::vector<LidarPoint>& points_base) {
  const Sight sight = look(points_base);
  RowStatus status = sight.status;
  const bool starts = !tracker_.is_known();
  if (status == RowStatus::kValid) {
    status = tracker_.correct(sight.fit);
    if (starts) end_finder_.reset();
    if (status != RowStatus::kJump) {
      end_finder_.update(points_base, *ground_, tracker_.lane());
    }
  }
  const RowEnd end = end_finder_.end();
  if (end.seen && end.distance_m < end.deviation_m) {
    tracker_.reset();
    if (status == RowStatus::kValid || status == RowStatus::kUnconfirmed) {
      status = RowStatus::kBehindRowEnd;
    }
  }
  return outcome(sight, status);
}

RowEstimate RowDetector::update(const std::vector<LidarPoint>& points_base, const Pose2& moved,
                                double time_s) {
  RowEstimate refused;
  refused.status = RowStatus::kTimeBackwards;
  if (!std::isfinite(time_s) || (last_time_s_ && time_s < *last_time_s_)) return refused;
  const double dt = last_time_s_ ? time_s - *last_time_s_ : 0.0;
  last_time_s_ = time_s;
  const bool is_finite =
      std::isfinite(moved.x) && std::isfinite(moved.y) && std::isfinite(moved.yaw);
  // Without odometry nothing is known of what was known.
  if (!is_finite) {
    tracker_.reset();
    end_finder_.reset();
  }
  const Pose2 step = is_finite ? moved : Pose2{};
  if (config_.mode == RowMode::kPublished) return published_.update(points_base, step, time_s);
  go_on(step, dt);
  return update_joint(points_base);
}

}  // namespace headland
