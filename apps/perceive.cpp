// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/command.hpp"
#include "apps/output_files.hpp"
#include "apps/report.hpp"
#include "apps/scan_look.hpp"
#include "perception/cloud/cloud_file.hpp"

namespace headland::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPoints = 12000;  // drawn
constexpr double kGround = 0.12;            // points nearer to the plane are drawn as ground [m]
constexpr double kHigh = 1.0;               // above it [m]
constexpr double kDrawnLane = 15.0;         // of the lane, where no end is seen [m]

template <class E>
std::string word(E value) {
  for (const auto& [known, name] : config::EnumNames<E>::values) {
    if (known == value) return std::string(name);
  }
  return "?";
}

Json numbers(const Eigen::Vector3f& p) { return {p.x(), p.y(), p.z()}; }

std::string look_json(const ScanLook& look, const Stamp& stamp) {
  const RowEstimate& row = look.row;
  Json json = {{"status", word(row.status)}};
  json["row"] = {{"valid", row.valid}};
  if (row.valid) {
    json["row"].update({{"offset_m", row.offset_m},
                        {"heading_rad", row.heading_rad},
                        {"left_m", row.left_m},
                        {"right_m", row.right_m},
                        {"width_m", row.width_m},
                        {"row_end_m", row.row_end.seen ? Json(row.row_end.distance_m) : Json()},
                        {"offset_deviation_m", std::sqrt(row.covariance(0, 0))},
                        {"heading_deviation_rad", std::sqrt(row.covariance(1, 1))}});
  }
  const GroundPlane& ground = look.ground;
  json["ground"] = {
      {"valid", ground.valid},
      {"height_m", ground.valid ? Json(-ground.offset_m / ground.normal.z()) : Json()},
      {"normal", {ground.normal.x(), ground.normal.y(), ground.normal.z()}},
      {"inlier_ratio", ground.inlier_ratio},
      {"sensor_height_m", look.sensor_height_m}};
  json["points"] = look.points.size();
  json["clusters"] = Json::array();
  for (const ClusterBox& cluster : look.clusters) {
    json["clusters"].push_back({{"points_count", cluster.points_count},
                                {"centre_m", numbers(cluster.centroid)},
                                {"low_m", numbers(cluster.low)},
                                {"high_m", numbers(cluster.high)}});
  }
  json["timings_ms"] = {{"crop", look.timings.crop_ms},
                        {"ground", look.timings.ground_ms},
                        {"clusters", look.timings.clusters_ms},
                        {"rows", look.timings.rows_ms}};
  json["version"] = stamp.version;
  json["config_hash"] = stamp.config_hash;
  return json.dump(2) + "\n";
}

// At most so many, evenly picked.
Polyline thinned(const Polyline& points, std::size_t most) {
  if (points.size() <= most) return points;
  Polyline some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(points[i * points.size() / most]);
  return some;
}

void add_points(const ScanLook& look, Report& report) {
  Polyline ground;
  Polyline low;
  Polyline high;
  for (std::size_t i = 0; i < look.points.size(); ++i) {
    const Eigen::Vector3d p = look.points[i].position.cast<double>();
    const bool is_ground = look.labels[i] == GroundLabel::kGround;
    (is_ground ? ground : p.z() < kHigh ? low : high).push_back(p.head<2>());
  }
  report.features.push_back(
      ReportFeature::points("points_ground", thinned(ground, kMostPoints / 3)));
  report.features.push_back(ReportFeature::points("points_low", thinned(low, kMostPoints / 3)));
  report.features.push_back(ReportFeature::points("points_high", thinned(high, kMostPoints / 3)));
}

void add_lane(const RowEstimate& row, Report& report) {
  if (!row.valid) return;
  const double end = row.row_end.seen ? row.row_end.distance_m : kDrawnLane;
  const Pose2 T_base_row{-row.offset_m * std::sin(row.heading_rad),
                         row.offset_m * std::cos(row.heading_rad), row.heading_rad};
  const auto line = [&](const char* kind, const char* name, double aside) {
    report.features.push_back(ReportFeature::line(
        kind, name,
        {T_base_row * Point2(-kDrawnLane / 2, aside), T_base_row * Point2(end, aside)}));
  };
  line("lane_side", "left", row.left_m - row.offset_m);
  line("lane_side", "right", row.right_m - row.offset_m);
  line("lane", "", 0.0);
  if (!row.row_end.seen) return;
  report.features.push_back(
      ReportFeature::line("row_end", "end of the row",
                          {T_base_row * Point2(end, row.left_m - row.offset_m),
                           T_base_row * Point2(end, row.right_m - row.offset_m)}));
}

void add_clusters(const ScanLook& look, Report& report) {
  ReportTable table;
  table.title = "Clusters";
  table.columns = {{"points"},      {"ahead", "m"}, {"left", "m"},
                   {"length", "m"}, {"width", "m"}, {"top", "m"}};
  for (const ClusterBox& box : look.clusters) {
    const Eigen::Vector3d low = box.low.cast<double>();
    const Eigen::Vector3d high = box.high.cast<double>();
    Polygon outline;
    outline.outer = {
        {low.x(), low.y()}, {high.x(), low.y()}, {high.x(), high.y()}, {low.x(), high.y()}};
    report.features.push_back(ReportFeature::polygon("cluster", "", outline));
    table.rows.push_back(
        {static_cast<double>(box.points_count), static_cast<double>(box.centroid.x()),
         static_cast<double>(box.centroid.y()), high.x() - low.x(), high.y() - low.y(), high.z()});
  }
  if (!table.rows.empty()) report.tables.push_back(std::move(table));
}

Report look_report(const std::string& file, const ScanLook& look, const Stamp& stamp) {
  Report report;
  report.in_base = true;
  report.title = std::filesystem::path(file).filename().string();
  report.kind = ReportKind::kScan;
  report.status = word(look.row.status);
  report.version = stamp.version;
  report.config_hash = stamp.config_hash;
  report.config_yaml = stamp.config_yaml;
  add_points(look, report);
  add_clusters(look, report);
  add_lane(look.row, report);
  report.features.push_back(ReportFeature::point("sensor", "", {0.0, 0.0}));
  const RowEstimate& row = look.row;
  if (row.valid) {
    report.tiles.push_back({"Middle of the row", row.offset_m, "m", "to the left of the vehicle"});
    report.tiles.push_back(
        {"Heading of the row", rad_to_deg(row.heading_rad), "deg", "to the left"});
    report.tiles.push_back({"Width of the row", row.width_m, "m", ""});
    if (row.row_end.seen)
      report.tiles.push_back({"End of the row", row.row_end.distance_m, "m", "ahead"});
  }
  report.tiles.push_back({"Sensor", look.sensor_height_m, "m", "above the ground"});
  report.tiles.push_back({"Points", static_cast<double>(look.points.size()), "", ""});
  report.tiles.push_back({"Clusters", static_cast<double>(look.clusters.size()), "", ""});
  report.tiles.push_back(
      {"Time", look.timings.ground_ms + look.timings.rows_ms, "ms", "ground and rows of one scan"});
  return report;
}

std::string look_text(const ScanLook& look) {
  const RowEstimate& row = look.row;
  std::string text;
  if (row.valid) {
    text += fmt::format(
        "row        its middle {:.3f} m to the left, heading {:.1f} deg to the left, {:.2f} m "
        "wide\n",
        row.offset_m, rad_to_deg(row.heading_rad), row.width_m);
    text += row.row_end.seen
                ? fmt::format("           ends {:.1f} m ahead\n", row.row_end.distance_m)
                : "           no end in sight\n";
  } else {
    text += fmt::format("row        none: {}\n", word(row.status));
  }
  text += look.ground.valid
              ? fmt::format("ground     {:.2f} m below the sensor, {:.0f} % of low points on it\n",
                            look.sensor_height_m, 100.0 * look.ground.inlier_ratio)
              : "ground     no plane found\n";
  text += fmt::format("clusters   {} of {} points\n", look.clusters.size(), look.points.size());
  return text + fmt::format("time       ground {:.1f} ms, clusters {:.1f} ms, rows {:.1f} ms\n",
                            look.timings.ground_ms, look.timings.clusters_ms, look.timings.rows_ms);
}

}  // namespace

int perceive_command(const CommonOptions& options) {
  if (auto ready = prepare_output(options.out); !ready) {
    return report_error(ready.error(), options);
  }
  const auto node = overrides_only(options);
  if (!node) return report_error(node.error(), options);
  ScanLookConfig config;
  if (auto read = config::read_into(*node, config); !read) {
    return report_error(read.error(), options);
  }
  const auto scan = load_cloud(options.file);
  if (!scan) return report_error(scan.error(), options);
  const ScanLook look = look_at(*scan, config);
  const Stamp stamp = make_stamp(0, config::to_yaml(config));
  const std::string json = look_json(look, stamp);
  const auto written =
      write_report(look_report(options.file, look, stamp), options.out, {{"perceive.json", json}});
  if (!written) return report_error(written.error(), options);
  if (options.json) {
    fmt::print("{}", json);
  } else {
    fmt::print("{}{}", look_text(look), report_line(options.out));
  }
  return 0;
}

}  // namespace headland::apps
