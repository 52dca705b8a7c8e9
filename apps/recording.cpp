// SPDX-License-Identifier: Apache-2.0
#include "apps/recording.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/mcap_writer.hpp"

namespace headland::apps {
namespace {

constexpr double kPathSpacing = 0.5;  // of the planned path's poses [m]

constexpr const char* kTime =
    R"("timestamp":{"type":"object","title":"time","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}})";
constexpr const char* kPose =
    R"({"type":"object","title":"foxglove.Pose","properties":{"position":{"type":"object","title":"foxglove.Vector3","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},"orientation":{"type":"object","title":"foxglove.Quaternion","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"},"w":{"type":"number"}}}}})";

std::string schema(const char* title, const std::string& properties) {
  return fmt::format(R"({{"title":"{}","type":"object","properties":{{{},{}}}}})", title, kTime,
                     properties);
}

std::string stamp_text(std::uint64_t ns) {
  return fmt::format(R"("timestamp":{{"sec":{},"nsec":{}}},"frame_id":"map")", ns / 1'000'000'000,
                     ns % 1'000'000'000);
}

std::string pose_text(double x, double y, double yaw) {
  return fmt::format(
      R"({{"position":{{"x":{:.4f},"y":{:.4f},"z":0}},"orientation":{{"x":0,"y":0,"z":{:.6f},"w":{:.6f}}}}})",
      x, y, std::sin(0.5 * yaw), std::cos(0.5 * yaw));
}

std::string path_text(const VehiclePlan& plan) {
  std::string poses;
  for (const PlanStage& stage : plan.stages) {
    for (const PathSample& sample : stage.path.sample(kPathSpacing)) {
      poses +=
          (poses.empty() ? "" : ",") + pose_text(sample.pose.x, sample.pose.y, sample.pose.yaw);
    }
  }
  return fmt::format(R"({{{},"poses":[{}]}})", stamp_text(0), poses);
}

}  // namespace

std::string run_mcap(const Run& run, const VehiclePlan& plan, const Farm& farm, double period) {
  McapWriter writer(fmt::format("headland {}", HEADLAND_VERSION));
  const std::string frame = R"("frame_id":{"type":"string"})";
  const auto path =
      writer.add_channel("/plan", "foxglove.PosesInFrame",
                         schema("foxglove.PosesInFrame",
                                frame + R"(,"poses":{"type":"array","items":)" + kPose + "}"));
  const auto pose =
      writer.add_channel("/pose", "foxglove.PoseInFrame",
                         schema("foxglove.PoseInFrame", frame + R"(,"pose":)" + kPose));
  const auto fix = writer.add_channel(
      "/fix", "foxglove.LocationFix",
      schema(
          "foxglove.LocationFix",
          frame +
              R"(,"latitude":{"type":"number"},"longitude":{"type":"number"},"altitude":{"type":"number"})"));
  const auto state = writer.add_channel(
      "/state", "headland.TrackingState",
      schema(
          "headland.TrackingState",
          R"("speed_mps":{"type":"number"},"steering_rad":{"type":"number"},"cross_track_m":{"type":"number"},"soc":{"type":"number"},"s_m":{"type":"number"},"leg":{"type":"string"},"leg_kind":{"type":"string"})"));

  writer.write(path, 0, path_text(plan));
  for (const int tick : trace_ticks(run.trace, period)) {
    const TraceRow& row = run.trace[static_cast<std::size_t>(tick)];
    const auto ns = static_cast<std::uint64_t>(std::llround(row.t_s * 1e9));
    const PlanLeg& leg = plan.legs[static_cast<std::size_t>(row.leg)];
    const LatLon place = farm.frame.to_wgs84({row.x_m, row.y_m});
    writer.write(pose, ns,
                 fmt::format(R"({{{},"pose":{}}})", stamp_text(ns),
                             pose_text(row.x_m, row.y_m, row.yaw_rad)));
    writer.write(fix, ns,
                 fmt::format(R"({{{},"latitude":{:.9f},"longitude":{:.9f},"altitude":0}})",
                             stamp_text(ns), place.lat_deg, place.lon_deg));
    writer.write(
        state, ns,
        fmt::format(
            R"({{{},"speed_mps":{:.3f},"steering_rad":{:.4f},"cross_track_m":{:.5f},"soc":{:.5f},"s_m":{:.2f},"leg":{},"leg_kind":"{}"}})",
            stamp_text(ns), row.speed_mps, row.steering_rad, row.cross_track_m, row.soc, row.s_m,
            nlohmann::json(leg.id).dump(), config::enum_name(leg.kind)));
  }
  return writer.finish();
}

}  // namespace headland::apps
