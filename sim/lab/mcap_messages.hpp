// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/geometry/pose2.hpp"
#include "core/world/geodesy.hpp"
#include "sim/lab/mcap_writer.hpp"

namespace headland {

/// A message type: the name and JSON Schema that McapWriter::add_channel takes.
struct McapSchema {
  std::string_view name;
  std::string_view json_schema;
};

/// foxglove.PoseInFrame, foxglove.LocationFix (viewers know these by name), and our own state.
extern const McapSchema kPoseInFrameSchema;
extern const McapSchema kLocationFixSchema;
extern const McapSchema kVehicleStateSchema;

/// What a run measures of a vehicle at each step.
struct McapVehicleState {
  double s_m = 0.0;           ///< driven distance [m]
  double error_m = 0.0;       ///< cross-track, left positive [m]
  double steering_deg = 0.0;  ///< left positive [deg]
  double speed_mps = 0.0;     ///< [m/s]
  double soc = 0.0;           ///< state of charge, 0 to 1
  int leg = 0;
};

std::string pose_in_frame_json(RunTime time, const Pose2& T_map_base);
std::string location_fix_json(RunTime time, LatLon position);
std::string vehicle_state_json(RunTime time, const McapVehicleState& state);

}  // namespace headland
