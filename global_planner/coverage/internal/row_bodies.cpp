// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/internal/row_bodies.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "global_planner/coverage/internal/row_line.hpp"

namespace headland::coverage {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Point2 along(const Polyline& line, double part) {
  double left = part * length(line);
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double step = (line[i] - line[i - 1]).norm();
    if (left <= step && step > 0.0) return line[i - 1] + left / step * (line[i] - line[i - 1]);
    left -= step;
  }
  return line.back();
}

double distance(const Point2& p, const Polyline& line) {
  double least = kInfinity;
  for (std::size_t i = 1; i < line.size(); ++i) {
    least = std::min(least, distance_to_segment(p, line[i - 1], line[i]));
  }
  return least;
}

// Distance from the middle parts of a row to the nearest other one, up to `most`.
double nearest_neighbour(const std::vector<RowBody>& bodies, std::size_t row, double most) {
  double nearest = most;
  for (const double part : {0.25, 0.5, 0.75}) {
    const Point2 p = along(bodies[row].line, part);
    for (std::size_t other = 0; other < bodies.size(); ++other) {
      if (other != row) nearest = std::min(nearest, distance(p, bodies[other].line));
    }
  }
  return nearest;
}

}  // namespace

Result<RowBodies> row_bodies(const Farm& farm, const std::vector<RowRef>& rows,
                             const Footprint& outline, double margin) {
  RowBodies result;
  result.parcels.resize(farm.row_parcels.size());
  std::vector<double> spacings;
  const auto add = [&](RowRef ref) {
    result.bodies.push_back({simplified(farm.row(ref).line, kSurveyTolerance), 0.0});
    spacings.push_back(farm.row_parcels[static_cast<std::size_t>(ref.parcel)].row_spacing_m);
  };
  std::set<std::pair<int, int>> given;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    add(rows[r]);
    result.parcels[static_cast<std::size_t>(rows[r].parcel)].push_back(static_cast<int>(r));
    given.emplace(rows[r].parcel, rows[r].row);
  }
  for (const RowRef ref : farm.all_rows()) {
    if (given.count({ref.parcel, ref.row}) == 0) add(ref);
  }
  result.margin = margin;
  for (std::size_t b = 0; b < result.bodies.size(); ++b) {
    const double lone = outline.width_m + 2.0 * margin + kSlit;
    const double spacing =
        nearest_neighbour(result.bodies, b, spacings[b] > 0.0 ? spacings[b] : lone);
    if (b < rows.size() && outline.width_m > spacing) {
      return fail(ErrorCode::kTurnDoesNotFit,
                  fmt::format("row {} is {:.2f} m wide, the vehicle {:.2f} m",
                              farm.row_name(rows[b]), spacing, outline.width_m),
                  "use a narrower vehicle, or correct row_spacing_m");
    }
    result.bodies[b].spacing = std::max(spacing, 0.1);
    result.widest = std::max(result.widest, spacing);
    if (b < rows.size()) {
      result.margin = std::min(result.margin, 0.5 * (spacing - outline.width_m));
    }
  }
  return result;
}

}  // namespace headland::coverage
