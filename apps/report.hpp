// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/polygon.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

/// A number (in the unit stated beside it) or a word; a number that is not finite is shown as "–".
using ReportValue = std::variant<double, std::string>;

/// A figure of the summary.
struct ReportTile {
  std::string label;
  ReportValue value;
  std::string unit{};
  std::string hint{};  ///< one line on what it means; may be empty
};

/// One thing on the map. Kinds the page knows: parcel, headland, road, keep_out, row, row_done,
/// gate, poi, charger, plan (the planned path, one feature per leg), goal (to be reached), and what
/// happened at a moment: near_agent, near_robot (by whose doing), near_miss, contact, given_up. In
/// a scan: points_ground, points_low, points_high, lane (the row's middle), lane_side, row_end,
/// cluster, sensor.
struct ReportFeature {
  std::string kind;
  std::string id{};
  std::string name{};
  /// Point, points and line: exactly one list of points. Polygon: the outer ring, then the holes.
  std::vector<Polyline> rings;  ///< [m, map]
  enum class Shape { kPoint, kPoints, kLine, kPolygon } shape = Shape::kLine;
  std::optional<int> vehicle{};  ///< whose plan: an index of Report::vehicles
  std::optional<int> leg{};      ///< of the plan; legs are the numbers of Path
  std::string leg_kind{};        ///< row, turn, transit, task or charge
  std::optional<double> t_s{};   ///< when it happened, on the clock of the series

  static ReportFeature point(std::string kind, std::string name, const Point2& position);
  static ReportFeature points(std::string kind, Polyline points);
  static ReportFeature line(std::string kind, std::string name, Polyline line);
  static ReportFeature polygon(std::string kind, std::string name, const Polygon& polygon);
};

/// Columns over the driven (or planned) distance, of equal length; a column that was not measured
/// stays empty.
struct ReportSeries {
  std::vector<double> s_m;           ///< driven distance [m], never falling
  std::vector<double> x_m;           ///< east [m, map]
  std::vector<double> y_m;           ///< north [m, map]
  std::vector<double> error_m;       ///< cross-track, left positive [m]
  std::vector<double> steering_deg;  ///< left positive [deg]
  std::vector<double> soc;           ///< state of charge, 0 to 1
  std::vector<double> speed_mps;     ///< [m/s]
  std::vector<int> leg;
  std::vector<double> t_s{};          ///< since the start; with yaw_rad: the drive can be played
  std::vector<double> yaw_rad{};      ///< counter-clockwise from east
  std::vector<double> clearance_m{};  ///< to the nearest agent, outline to outline
};

/// A charge on the way.
struct ReportStop {
  double s_m = 0.0;       ///< driven distance [m]
  double soc_from = 0.0;  ///< on arrival
  double soc_to = 0.0;    ///< on leaving
  std::string name;       ///< of the charger
};

struct ReportVehicle {
  std::string name;
  std::optional<double> reserve_soc{};
  ReportSeries series{};
  std::vector<ReportStop> stops{};
  std::optional<Footprint> outline{};
};

/// Somebody who is seen for a while, once a period.
struct ReportAgent {
  double radius_m = 0.3;
  int first = 0;  ///< the period of the first position
  std::vector<Point2> positions{};
};

struct ReportAgents {
  double start_s = 0.0;  ///< on the clock of the series
  double period_s = 1.0;
  std::vector<ReportAgent> tracks{};
};

/// Heights under the map, on a grid of points.
struct ReportTerrain {
  Point2 south_west{0.0, 0.0};  ///< the first grid point [m, map]
  double cell_m = 1.0;          ///< between grid points
  int columns = 0;
  int rows = 0;
  std::vector<double> heights_m;  ///< row by row from the south-west; NaN: none [m]
};

/// Why a leg is there, or a task is not.
struct ReportReason {
  int vehicle = -1;  ///< in Report::vehicles; -1: of none
  int leg = -1;      ///< -1: of none
  std::string text;
};

struct ReportTable {
  struct Column {
    std::string name;
    std::string unit{};
  };
  std::string title;
  /// A column named "leg" makes its numbers links to that leg on the map: of the vehicle that a
  /// column named "vehicle" names, or of the first.
  std::vector<Column> columns;
  std::vector<std::vector<ReportValue>> rows;
};

struct ReportPlot {
  struct Series {
    std::string name;
    std::vector<double> x;
    std::vector<double> y;
    bool points = false;  ///< dots instead of a line
  };
  std::string title;
  std::string x_label;  ///< with its unit
  std::string y_label;  ///< with its unit
  bool log_y = false;
  std::vector<Series> series;
};

/// What a map shows, and plays if its vehicles' series have times.
struct ReportScene {
  bool in_base = false;  ///< a vehicle's surroundings, in `base` instead of `map`
  std::vector<ReportFeature> features{};
  std::vector<ReportVehicle> vehicles{};
  std::optional<ReportTerrain> terrain{};
  ReportAgents agents{};
};

/// A drive among others of its kind.
struct ReportEpisode {
  std::string name;
  std::string note;  ///< why it is shown
  ReportScene scene;
};

enum class ReportKind { kPlan, kRun, kStudy, kScan };

/// All that report.html shows. An empty part takes no room on the page.
struct Report : ReportScene {
  std::string title;
  ReportKind kind = ReportKind::kPlan;
  std::string status;  ///< a word: optimal, feasible, completed, failed, ...
  std::string version;
  std::uint64_t seed = 0;
  std::string config_hash;
  std::string config_yaml;
  std::vector<ReportTile> tiles;
  std::vector<ReportReason> why;
  std::vector<ReportTable> tables;
  std::vector<ReportPlot> plots;
  std::vector<ReportEpisode> episodes;
};

/// Series longer than this, over all vehicles together, are thinned out before they are written.
inline constexpr int kMaxReportPoints = 20000;

/// Indices of at most `count` samples that keep the shape of a series: the first and last, and of
/// each of equal stretches the first and the one of largest |value| (`values` may be empty).
/// Requires count >= 4.
std::vector<int> thin_out(int size, const std::vector<double>& values, int count);

/// The report as JSON text: lengths to the millimetre, free numbers to six digits.
/// Error kInternal if the columns of a series, or the heights and their grid, differ in length.
Result<std::string> report_json(const Report& report);

/// The page around a JSON text: one file that needs no network.
std::string report_html(std::string_view title, std::string_view json);

/// Writes report.json and report.html into `directory`, and `files` (name -> content) beside them,
/// each first under a temporary name; `kept` stay as they are (apps/output_files.hpp). Error
/// kFileNotWritable.
Result<void> write_report(const Report& report, const std::filesystem::path& directory,
                          std::map<std::string, std::string> files = {},
                          const std::vector<std::string>& kept = {});

}  // namespace headland
