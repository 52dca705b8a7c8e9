// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/config/visit.hpp"

namespace headland {

/// How the state and the slip are taken to change beside what the motion model and the commands
/// say: random walks. Those of pose and slip go with the distance driven, so that a vehicle that
/// stands forgets nothing; those of speed and turn with the time.
struct EstimationConfig {
  double position_drift_m = 0.003;
  double heading_drift_deg = 0.1;
  double speed_walk_mps = 0.1;
  double turn_walk_deg = 0.5;
  double yaw_rate_walk_radps = 0.05;
  double loss_walk_ratio = 0.005;
  double side_walk_deg = 0.15;
  double offset_walk_deg = 0.08;
  double first_loss_ratio = 0.1;
  double first_side_deg = 3.0;
  double first_offset_deg = 2.0;
  double first_position_m = 0.05;
  double first_heading_deg = 1.0;
  double least_position_m = 0.003;
  double least_heading_deg = 0.1;
  double least_speed_mps = 0.01;
  double least_turn_deg = 0.1;
  double least_yaw_rate_radps = 0.01;
  double most_loss_ratio = 0.6;
  double most_side_deg = 20.0;
  double most_offset_deg = 12.0;
  double most_delay_s = 0.5;
  double coasting_after_s = 2.0;

  template <class V>
  void visit(V& v) {
    v("position_drift_m", position_drift_m, config::kNonNegative,
      "Of the position after one metre, beside the slip [m]");
    v("heading_drift_deg", heading_drift_deg, config::kNonNegative,
      "Of the heading after one metre, beside the slip [deg]");
    v("speed_walk_mps", speed_walk_mps, config::kPositive,
      "Of the wheels' speed against the commands after one second [m/s]");
    v("turn_walk_deg", turn_walk_deg, config::kPositive,
      "Of the steering angle against the commands after one second [deg]");
    v("yaw_rate_walk_radps", yaw_rate_walk_radps, config::kPositive,
      "Of a differential vehicle's yaw rate against the commands after one second [rad/s]");
    v("loss_walk_ratio", loss_walk_ratio, config::kPositive,
      "Of the longitudinal slip after one metre");
    v("side_walk_deg", side_walk_deg, config::kPositive, "Of the side slip after one metre [deg]");
    v("offset_walk_deg", offset_walk_deg, config::kPositive,
      "Of the steering offset after one metre [deg]");
    v("first_loss_ratio", first_loss_ratio, config::kPositive,
      "Standard deviation of the longitudinal slip at the start");
    v("first_side_deg", first_side_deg, config::kPositive, "Of the side slip at the start [deg]");
    v("first_offset_deg", first_offset_deg, config::kPositive,
      "Of the steering offset at the start [deg]");
    v("first_position_m", first_position_m, config::kPositive, "Of the position at the start [m]");
    v("first_heading_deg", first_heading_deg, config::kPositive,
      "Of the heading at the start [deg]");
    v("least_position_m", least_position_m, config::kPositive,
      "No position is trusted more than this, however exact: the model is not [m]");
    v("least_heading_deg", least_heading_deg, config::kPositive, "No heading likewise [deg]");
    v("least_speed_mps", least_speed_mps, config::kPositive, "No wheel speed likewise [m/s]");
    v("least_turn_deg", least_turn_deg, config::kPositive,
      "No steering angle likewise, nor in degrees a second a yaw rate of wheels [deg]");
    v("least_yaw_rate_radps", least_yaw_rate_radps, config::kPositive,
      "No gyroscope likewise [rad/s]");
    v("most_loss_ratio", most_loss_ratio, config::Range{0.0, 0.9},
      "Bound of the longitudinal slip, both ways");
    v("most_side_deg", most_side_deg, config::Range{0.0, 60.0},
      "Bound of the side slip, both ways [deg]");
    v("most_offset_deg", most_offset_deg, config::Range{0.0, 60.0},
      "Bound of the steering offset, both ways [deg]");
    v("most_delay_s", most_delay_s, config::Range{0.0, 10.0},
      "Measurements that come later than this are not used [s]");
    v("coasting_after_s", coasting_after_s, config::kPositive,
      "Without a position for this long the estimate counts as coasting [s]");
  }
};

}  // namespace headland
