// SPDX-License-Identifier: Apache-2.0
#include "apps/report.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/output_files.hpp"
#include "apps/packed_numbers.hpp"
#include "apps/report_page.hpp"
#include "apps/report_terrain.hpp"

namespace headland {
namespace {

using Json = nlohmann::ordered_json;

// Decimals of each column; more would be noise that makes the page large.
constexpr double kMillimetres = 1e3;
constexpr double kSocSteps = 1e5;

Json rounded(double value, double steps) {
  if (!std::isfinite(value)) return nullptr;
  const double result = std::round(value * steps) / steps;
  return result == 0.0 ? Json(0) : Json(result);  // no "-0.0"
}

Json six_digits(double value) {
  if (!std::isfinite(value)) return nullptr;
  if (value == 0.0) return 0;
  if (value == std::round(value) && std::abs(value) < 1e15) {
    return static_cast<std::int64_t>(value);
  }
  const double steps = std::pow(10.0, 5.0 - std::floor(std::log10(std::abs(value))));
  const double result = std::round(value * steps) / steps;
  return std::isfinite(result) ? result : value;
}

Json to_json(const ReportValue& value) {
  if (const double* number = std::get_if<double>(&value)) return six_digits(*number);
  return std::get<std::string>(value);
}

Json to_json(const Point2& p) {
  return Json::array({rounded(p.x(), kMillimetres), rounded(p.y(), kMillimetres)});
}

Json to_json(const Polyline& line) {
  Json points = Json::array();
  for (const Point2& p : line) points.push_back(to_json(p));
  return points;
}

Json to_json(const ReportFeature& feature) {
  Json json = {{"kind", feature.kind}};
  if (!feature.id.empty()) json["id"] = feature.id;
  if (!feature.name.empty()) json["name"] = feature.name;
  switch (feature.shape) {
    case ReportFeature::Shape::kPoint:
      json["type"] = "Point";
      json["coordinates"] = to_json(feature.rings.at(0).at(0));
      break;
    case ReportFeature::Shape::kPoints:
      json["type"] = "MultiPoint";
      json["coordinates"] = to_json(feature.rings.at(0));
      break;
    case ReportFeature::Shape::kLine:
      json["type"] = "LineString";
      json["coordinates"] = to_json(feature.rings.at(0));
      break;
    case ReportFeature::Shape::kPolygon:
      json["type"] = "Polygon";
      json["coordinates"] = Json::array();
      for (const Polyline& ring : feature.rings) json["coordinates"].push_back(to_json(ring));
      break;
  }
  if (feature.vehicle) json["vehicle"] = *feature.vehicle;
  if (feature.leg) json["leg"] = *feature.leg;
  if (!feature.leg_kind.empty()) json["leg_kind"] = feature.leg_kind;
  if (feature.t_s) json["t_s"] = rounded(*feature.t_s, kMillimetres);
  return json;
}

template <class T>
Json picked(const std::vector<T>& column, const std::vector<int>& indices, double steps) {
  Json values = Json::array();
  if (column.empty()) return values;
  for (const int i : indices) {
    const T value = column[static_cast<std::size_t>(i)];
    if constexpr (std::is_integral_v<T>) {
      values.push_back(value);
    } else {
      values.push_back(rounded(value, steps));
    }
  }
  return values;
}

std::optional<Error> uneven(const ReportSeries& series) {
  const std::size_t size = series.s_m.size();
  for (const std::size_t other :
       {series.x_m.size(), series.y_m.size(), series.error_m.size(), series.steering_deg.size(),
        series.soc.size(), series.speed_mps.size(), series.leg.size(), series.t_s.size(),
        series.yaw_rad.size(), series.clearance_m.size()}) {
    if (other != size && other != 0) {
      return Error{ErrorCode::kInternal,
                   fmt::format("a report column has {} values, s_m has {}", other, size),
                   {}};
    }
  }
  return std::nullopt;
}

std::optional<Error> check(const ReportScene& scene) {
  for (const ReportVehicle& vehicle : scene.vehicles) {
    if (auto error = uneven(vehicle.series)) return error;
  }
  if (!scene.terrain) return std::nullopt;
  const ReportTerrain& terrain = *scene.terrain;
  if (static_cast<std::size_t>(terrain.columns) * static_cast<std::size_t>(terrain.rows) ==
      terrain.heights_m.size()) {
    return std::nullopt;
  }
  return Error{ErrorCode::kInternal,
               fmt::format("a report's terrain has {} heights, its grid {} x {}",
                           terrain.heights_m.size(), terrain.columns, terrain.rows),
               {}};
}

Json to_json(const ReportSeries& series, int most) {
  const std::vector<int> indices =
      thin_out(static_cast<int>(series.s_m.size()), series.error_m, most);
  return {{"s_m", picked(series.s_m, indices, kMillimetres)},
          {"x_m", picked(series.x_m, indices, kMillimetres)},
          {"y_m", picked(series.y_m, indices, kMillimetres)},
          {"error_m", picked(series.error_m, indices, 1e4)},
          {"steering_deg", picked(series.steering_deg, indices, 1e2)},
          {"soc", picked(series.soc, indices, kSocSteps)},
          {"speed_mps", picked(series.speed_mps, indices, 1e3)},
          {"leg", picked(series.leg, indices, 1.0)},
          {"t_s", picked(series.t_s, indices, 1e2)},
          {"yaw_rad", picked(series.yaw_rad, indices, 1e3)},
          {"clearance_m", picked(series.clearance_m, indices, 1e2)}};
}

Json to_json(const ReportStop& stop) {
  return {{"s_m", rounded(stop.s_m, kMillimetres)},
          {"soc_from", rounded(stop.soc_from, kSocSteps)},
          {"soc_to", rounded(stop.soc_to, kSocSteps)},
          {"name", stop.name}};
}

Json to_json(const ReportReason& reason) {
  Json json = {{"text", reason.text}};
  if (reason.vehicle >= 0) json["vehicle"] = reason.vehicle;
  if (reason.leg >= 0) json["leg"] = reason.leg;
  return json;
}

Json to_json(const ReportTerrain& terrain) {
  const PackedNumbers packed = pack(terrain.heights_m);
  return {{"south_west_m", to_json(terrain.south_west)},
          {"cell_m", six_digits(terrain.cell_m)},
          {"columns", terrain.columns},
          {"rows", terrain.rows},
          {"low_m", rounded(packed.low, kMillimetres)},
          {"high_m", rounded(packed.high, kMillimetres)},
          {"heights", packed.base64}};
}

// The positions of all tracks, one after the other, as x, y, x, y, ...
Json to_json(const ReportAgents& agents) {
  Json tracks = Json::array();
  std::vector<double> places_m;
  for (const ReportAgent& agent : agents.tracks) {
    tracks.push_back({agent.first, agent.positions.size(), rounded(agent.radius_m, kMillimetres)});
    for (const Point2& p : agent.positions) places_m.insert(places_m.end(), {p.x(), p.y()});
  }
  const PackedNumbers packed = pack(places_m);
  return {{"start_s", rounded(agents.start_s, kMillimetres)},
          {"period_s", rounded(agents.period_s, kMillimetres)},
          {"tracks", std::move(tracks)},
          {"low_m", packed.low},
          {"high_m", packed.high},
          {"positions", packed.base64}};
}

Json to_json(const Footprint& outline) {
  return {{"front_m", rounded(outline.front_m, kMillimetres)},
          {"rear_m", rounded(outline.rear_m, kMillimetres)},
          {"width_m", rounded(outline.width_m, kMillimetres)}};
}

Json to_json(const ReportTable& table) {
  Json columns = Json::array();
  for (const auto& column : table.columns) {
    columns.push_back({{"name", column.name}, {"unit", column.unit}});
  }
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    Json cells = Json::array();
    for (const ReportValue& cell : row) cells.push_back(to_json(cell));
    rows.push_back(std::move(cells));
  }
  return {{"title", table.title}, {"columns", std::move(columns)}, {"rows", std::move(rows)}};
}

Json to_json(const ReportPlot& plot) {
  Json all = Json::array();
  for (const auto& series : plot.series) {
    const auto size = static_cast<int>(std::min(series.x.size(), series.y.size()));
    Json x = Json::array();
    Json y = Json::array();
    for (const int i : thin_out(size, series.y, kMaxReportPoints)) {
      x.push_back(six_digits(series.x[static_cast<std::size_t>(i)]));
      y.push_back(six_digits(series.y[static_cast<std::size_t>(i)]));
    }
    all.push_back({{"name", series.name},
                   {"x", std::move(x)},
                   {"y", std::move(y)},
                   {"style", series.points ? "points" : "line"}});
  }
  return {{"title", plot.title},
          {"x_label", plot.x_label},
          {"y_label", plot.y_label},
          {"log_y", plot.log_y},
          {"series", std::move(all)}};
}

Json to_json(const ReportTile& tile) {
  return {{"label", tile.label},
          {"value", to_json(tile.value)},
          {"unit", tile.unit},
          {"hint", tile.hint}};
}

Json to_json(const ReportEpisode& episode);

template <class T>
Json all_of(const std::vector<T>& items) {
  Json array = Json::array();
  for (const T& item : items) array.push_back(to_json(item));
  return array;
}

Json to_json(const ReportVehicle& vehicle, int most_points) {
  Json json = {{"name", vehicle.name},
               {"series", to_json(vehicle.series, most_points)},
               {"stops", all_of(vehicle.stops)}};
  if (vehicle.outline) json["outline"] = to_json(*vehicle.outline);
  if (vehicle.reserve_soc) json["reserve_soc"] = rounded(*vehicle.reserve_soc, kSocSteps);
  return json;
}

Json vehicles_json(const std::vector<ReportVehicle>& vehicles) {
  constexpr int kLeastPoints = 1000;
  const int share = kMaxReportPoints / std::max(1, static_cast<int>(vehicles.size()));
  Json array = Json::array();
  for (const ReportVehicle& vehicle : vehicles) {
    array.push_back(to_json(vehicle, std::max(share, kLeastPoints)));
  }
  return array;
}

Json to_json(const ReportScene& scene) {
  Json json = {{"map", {{"features", all_of(scene.features)}}},
               {"vehicles", vehicles_json(scene.vehicles)}};
  if (scene.in_base) json["in_base"] = true;
  if (scene.terrain) json["terrain"] = to_json(*scene.terrain);
  if (!scene.agents.tracks.empty()) json["agents"] = to_json(scene.agents);
  return json;
}

Json to_json(const ReportEpisode& episode) {
  return {{"name", episode.name}, {"note", episode.note}, {"scene", to_json(episode.scene)}};
}

std::string_view name_of(ReportKind kind) {
  switch (kind) {
    case ReportKind::kPlan:
      return "plan";
    case ReportKind::kRun:
      return "run";
    case ReportKind::kStudy:
      return "study";
    case ReportKind::kScan:
      return "scan";
  }
  return "?";
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace

ReportFeature ReportFeature::point(std::string kind, std::string name, const Point2& position) {
  return {.kind = std::move(kind),
          .name = std::move(name),
          .rings = {{position}},
          .shape = Shape::kPoint};
}

ReportFeature ReportFeature::points(std::string kind, Polyline points) {
  return {.kind = std::move(kind), .rings = {std::move(points)}, .shape = Shape::kPoints};
}

ReportFeature ReportFeature::line(std::string kind, std::string name, Polyline line) {
  return {.kind = std::move(kind),
          .name = std::move(name),
          .rings = {std::move(line)},
          .shape = Shape::kLine};
}

ReportFeature ReportFeature::polygon(std::string kind, std::string name, const Polygon& polygon) {
  ReportFeature feature{.kind = std::move(kind), .name = std::move(name), .rings = {polygon.outer}};
  feature.shape = Shape::kPolygon;
  feature.rings.insert(feature.rings.end(), polygon.holes.begin(), polygon.holes.end());
  return feature;
}

std::vector<int> thin_out(int size, const std::vector<double>& values, int count) {
  std::vector<int> kept;
  if (size <= count) {
    kept.resize(static_cast<std::size_t>(size));
    std::iota(kept.begin(), kept.end(), 0);
    return kept;
  }
  const int stretches = (count - 1) / 2;  // two of each, and the last sample
  const auto border = [&](int i) {
    return static_cast<int>(static_cast<std::int64_t>(size) * i / stretches);
  };
  for (int i = 0; i < stretches; ++i) {
    int extreme = border(i);
    for (int j = border(i) + 1; j < border(i + 1) && !values.empty(); ++j) {
      if (std::abs(values[static_cast<std::size_t>(j)]) >
          std::abs(values[static_cast<std::size_t>(extreme)])) {
        extreme = j;
      }
    }
    kept.push_back(border(i));
    if (extreme != border(i)) kept.push_back(extreme);
  }
  if (kept.back() != size - 1) kept.push_back(size - 1);
  return kept;
}

Result<std::string> report_json(const Report& report) {
  if (auto error = check(report)) return tl::unexpected<Error>(std::move(*error));
  for (const ReportEpisode& episode : report.episodes) {
    if (auto error = check(episode.scene)) return tl::unexpected<Error>(std::move(*error));
  }
  Json json = {{"title", report.title},
               {"kind", name_of(report.kind)},
               {"status", report.status},
               {"version", report.version},
               {"seed", report.seed},
               {"config_hash", report.config_hash},
               {"config_yaml", report.config_yaml},
               {"tiles", all_of(report.tiles)},
               {"why", all_of(report.why)},
               {"tables", all_of(report.tables)},
               {"plots", all_of(report.plots)},
               {"episodes", all_of(report.episodes)}};
  json.update(to_json(static_cast<const ReportScene&>(report)));
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string report_html(std::string_view title, std::string_view json) {
  std::string safe_title = replaced(std::string(title), "&", "&amp;");
  safe_title = replaced(std::move(safe_title), "<", "&lt;");
  // "</script" or "<!--" inside a text would end or change the element that holds the JSON.
  const std::string safe_json = replaced(std::string(json), "<", "\\u003c");
  const auto& page = report_page();
  std::string html;
  html.reserve(page.before_title.size() + page.before_data.size() + page.after_data.size() +
               safe_title.size() + safe_json.size());
  html.append(page.before_title).append(safe_title).append(page.before_data);
  html.append(safe_json).append(page.after_data);
  return html;
}

Result<void> write_report(const Report& report, const std::filesystem::path& directory,
                          std::map<std::string, std::string> files,
                          const std::vector<std::string>& kept) {
  const auto json = report_json(report);
  if (!json) return tl::unexpected<Error>(json.error());
  files["report.json"] = *json + "\n";
  files["report.html"] = report_html(report.title, *json);
  return apps::write_files(directory, files, kept);
}

}  // namespace headland
