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

// The channels and messages of one vehicle.
class VehicleRecorder {
 public:
  VehicleRecorder(McapWriter& writer, const VehiclePlan& plan, const Farm& farm)
      : writer_(writer), plan_(plan), farm_(farm) {
    const std::string frame = R"("frame_id":{"type":"string"})";
    const auto channel = [&](const char* topic, const char* name, const std::string& properties) {
      return writer.add_channel("/" + plan.id + topic, name, schema(name, properties));
    };
    path_ = channel("/plan", "foxglove.PosesInFrame",
                    frame + R"(,"poses":{"type":"array","items":)" + kPose + "}");
    pose_ = channel("/pose", "foxglove.PoseInFrame", frame + R"(,"pose":)" + kPose);
    fix_ = channel(
        "/fix", "foxglove.LocationFix",
        frame +
            R"(,"latitude":{"type":"number"},"longitude":{"type":"number"},"altitude":{"type":"number"})");
    state_ = channel(
        "/state", "headland.TrackingState",
        R"("speed_mps":{"type":"number"},"steering_rad":{"type":"number"},"cross_track_m":{"type":"number"},"soc":{"type":"number"},"s_m":{"type":"number"},"leg":{"type":"string"},"leg_kind":{"type":"string"})");
  }

  void write_plan() { writer_.write(path_, 0, path_text(plan_)); }

  void write(const TraceRow& row) {
    const auto ns = static_cast<std::uint64_t>(std::llround(row.t_s * 1e9));
    const PlanLeg& leg = plan_.legs[static_cast<std::size_t>(row.leg)];
    const LatLon place = farm_.frame.to_wgs84({row.x_m, row.y_m});
    writer_.write(pose_, ns,
                  fmt::format(R"({{{},"pose":{}}})", stamp_text(ns),
                              pose_text(row.x_m, row.y_m, row.yaw_rad)));
    writer_.write(fix_, ns,
                  fmt::format(R"({{{},"latitude":{:.9f},"longitude":{:.9f},"altitude":0}})",
                              stamp_text(ns), place.lat_deg, place.lon_deg));
    writer_.write(
        state_, ns,
        fmt::format(
            R"({{{},"speed_mps":{:.3f},"steering_rad":{:.4f},"cross_track_m":{:.5f},"soc":{:.5f},"s_m":{:.2f},"leg":{},"leg_kind":"{}"}})",
            stamp_text(ns), row.speed_mps, row.steering_rad, row.cross_track_m, row.soc, row.s_m,
            nlohmann::json(leg.id).dump(), config::enum_name(leg.kind)));
  }

 private:
  McapWriter& writer_;
  const VehiclePlan& plan_;
  const Farm& farm_;
  std::uint16_t path_ = 0;
  std::uint16_t pose_ = 0;
  std::uint16_t fix_ = 0;
  std::uint16_t state_ = 0;
};

}  // namespace

std::string run_mcap(const FleetRun& run, const std::vector<VehiclePlan>& plans, const Farm& farm,
                     double period) {
  McapWriter writer(fmt::format("headland {}", HEADLAND_VERSION));
  std::vector<VehicleRecorder> recorders;
  for (const VehiclePlan& plan : plans) recorders.emplace_back(writer, plan, farm);
  for (VehicleRecorder& recorder : recorders) recorder.write_plan();
  for (const FleetTick& at : fleet_ticks(run, period)) {
    recorders[at.vehicle].write(run.vehicles[at.vehicle].trace[at.tick]);
  }
  return writer.finish();
}

}  // namespace headland::apps
