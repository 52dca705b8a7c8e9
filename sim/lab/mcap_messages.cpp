// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/mcap_messages.hpp"

#include <cmath>

#include <fmt/format.h>

namespace headland {
namespace {

// Field names as in the Foxglove schemas (https://docs.foxglove.dev, PoseInFrame, LocationFix).
constexpr std::string_view kPoseInFrame = R"({"type":"object","title":"foxglove.PoseInFrame",
"properties":{"timestamp":{"type":"object","title":"time","properties":{
"sec":{"type":"integer","minimum":0},"nsec":{"type":"integer","minimum":0,"maximum":999999999}}},
"frame_id":{"type":"string"},"pose":{"type":"object","title":"foxglove.Pose","properties":{
"position":{"type":"object","title":"foxglove.Vector3","properties":{
"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},
"orientation":{"type":"object","title":"foxglove.Quaternion","properties":{
"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"},"w":{"type":"number"}}}}}}})";

constexpr std::string_view kLocationFix = R"({"type":"object","title":"foxglove.LocationFix",
"properties":{"timestamp":{"type":"object","title":"time","properties":{
"sec":{"type":"integer","minimum":0},"nsec":{"type":"integer","minimum":0,"maximum":999999999}}},
"frame_id":{"type":"string"},"latitude":{"type":"number"},"longitude":{"type":"number"},
"altitude":{"type":"number"},"position_covariance":{"type":"array","items":{"type":"number"},
"minItems":9,"maxItems":9},"position_covariance_type":{"type":"integer"}}})";

constexpr std::string_view kVehicleState = R"({"type":"object","title":"headland.VehicleState",
"properties":{"time_s":{"type":"number"},"s_m":{"type":"number"},"error_m":{"type":"number"},
"steering_deg":{"type":"number"},"speed_mps":{"type":"number"},"soc":{"type":"number"},
"leg":{"type":"integer"}}})";

std::string timestamp(RunTime time) {
  return fmt::format(R"("timestamp":{{"sec":{},"nsec":{}}})", time.count() / 1'000'000'000,
                     time.count() % 1'000'000'000);
}

// JSON has no NaN.
std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.10g}", value) : "null";
}

}  // namespace

const McapSchema kPoseInFrameSchema{"foxglove.PoseInFrame", kPoseInFrame};
const McapSchema kLocationFixSchema{"foxglove.LocationFix", kLocationFix};
const McapSchema kVehicleStateSchema{"headland.VehicleState", kVehicleState};

std::string pose_in_frame_json(RunTime time, const Pose2& T_map_base) {
  return fmt::format(R"({{{},"frame_id":"map","pose":{{"position":{{"x":{},"y":{},"z":0}},)"
                     R"("orientation":{{"x":0,"y":0,"z":{},"w":{}}}}}}})",
                     timestamp(time), number(T_map_base.x), number(T_map_base.y),
                     number(std::sin(T_map_base.yaw / 2.0)),
                     number(std::cos(T_map_base.yaw / 2.0)));
}

std::string location_fix_json(RunTime time, LatLon position) {
  return fmt::format(R"({{{},"frame_id":"map","latitude":{},"longitude":{},"altitude":0,)"
                     R"("position_covariance":[0,0,0,0,0,0,0,0,0],"position_covariance_type":0}})",
                     timestamp(time), number(position.lat_deg), number(position.lon_deg));
}

std::string vehicle_state_json(RunTime time, const McapVehicleState& state) {
  return fmt::format(
      R"({{"time_s":{},"s_m":{},"error_m":{},"steering_deg":{},"speed_mps":{},"soc":{},"leg":{}}})",
      number(1e-9 * static_cast<double>(time.count())), number(state.s_m), number(state.error_m),
      number(state.steering_deg), number(state.speed_mps), number(state.soc), state.leg);
}

}  // namespace headland
