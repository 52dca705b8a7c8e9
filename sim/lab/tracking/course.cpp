// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/tracking/course.hpp"

#include <algorithm>

namespace headland {

TrackingCourse tracking_course(const TrackingCourseConfig& config, double speed, bool fishtail) {
  TrackingCourse course;
  Path& path = course.reference.path;
  int leg = 0;
  const auto add = [&](double curvature, double length, Gear gear = Gear::kForward,
                       double sharpness = 0.0) {
    if (length > 0.0) path.append({path.end_pose(), curvature, length, gear, leg, sharpness});
  };
  const auto end_leg = [&](LegKind kind, double leg_speed) {
    course.kinds.push_back(kind);
    course.reference.leg_speed.push_back(leg_speed);
    ++leg;
  };
  path.append_straight({}, config.row_m, leg);
  end_leg(LegKind::kRow, speed);

  const double bend = 1.0 / config.turn_radius_m;
  const double ramp = std::min(config.clothoid_m, kPi / bend);  // turns by ramp * bend / 2
  const double sharpness = ramp > 0.0 ? bend / ramp : 0.0;
  const double begin = path.length();
  add(0.0, ramp, Gear::kForward, sharpness);
  add(bend, kPi / bend - ramp);
  add(bend, ramp, Gear::kForward, -sharpness);
  course.mid_turn_s = 0.5 * (begin + path.length());
  end_leg(LegKind::kTurn, speed);
  add(0.0, config.row_m);
  end_leg(LegKind::kRow, speed);
  if (!fishtail) return course;

  const double quarter = 0.5 * kPi * config.fishtail_radius_m;
  course.fishtail_leg = leg;
  add(-1.0 / config.fishtail_radius_m, quarter);
  course.cusps_s.push_back(path.length());
  add(0.0, 2.0 * config.fishtail_radius_m - config.fishtail_apart_m, Gear::kReverse);
  course.cusps_s.push_back(path.length());
  add(-1.0 / config.fishtail_radius_m, quarter);
  end_leg(LegKind::kTurn, std::min(speed, config.fishtail_speed_mps));
  add(0.0, config.row_m);
  end_leg(LegKind::kRow, speed);
  return course;
}

}  // namespace headland
