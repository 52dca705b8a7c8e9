// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/geometry/path.hpp"
#include "core/model/drive_cost.hpp"

namespace headland {

/// Deviation of one driven position from a path.
struct PathError {
  double s = 0.0;           ///< driven distance of the path's nearest point [m]
  double lateral_m = 0.0;   ///< [m], positive: left of the path's heading
  double distance_m = 0.0;  ///< [m], >= 0
  int leg = 0;              ///< of the path
};

/// Smallest rise that makes a peak, of a curve as the processor rounds it [m]: without it, the last
/// bits of a straight drive count as oscillations.
inline constexpr double kRoundingProminence = 1e-9;
/// Smallest rise of an oscillation that a machine can have [m]: our own rule.
inline constexpr double kWaveProminence = 1e-3;

/// Errors of the positions of a drive against the exact path. The nearest point is sought within
/// `window` [m] of the last one (`start_s` at first), so that neighbouring rows and the way back
/// after a cusp are not mistaken for the way forth. O(positions).
std::vector<PathError> errors_from_path(std::span<const Point2> positions, const Path& path,
                                        double window = 2.0, double start_s = 0.0);

/// Distances [m] to the polyline through `waypoints`: the "trajectory deviation" of (004), whose
/// planned trajectory is its waypoints. The search runs along with the drive, and over all of the
/// polyline where that finds nothing within 1 m.
std::vector<double> deviations_from_polyline(std::span<const Point2> positions,
                                             std::span<const Point2> waypoints);

/// Peaks of a curve: maxima (a plateau is one), not at its ends, that rise by at least `prominence`
/// above the higher of the two lowest points which separate them from higher ground or the curve's
/// end. O(n).
int count_peaks(std::span<const double> curve, double prominence);

/// (004) Sec. 3: average trajectory deviation, oscillating factor, relative accuracy.
struct RelativeAccuracy {
  double atd_m = 0.0;         ///< mean deviation [m]
  int oscillation_count = 0;  ///< OF: peaks of the deviation
  double ra_1pm = 0.0;        ///< 1 / (ATD OF), (004) Eq. 8; an OF of 0 counts as 1 [1/m]
};
RelativeAccuracy relative_accuracy(std::span<const double> deviations, double prominence);

/// The figures of metrics.json; OF by our own rule (kWaveProminence against the exact path).
struct TrackingMetrics {
  double row_rms_m = 0.0;  ///< [m], 0 without rows
  double turn_rms_m = 0.0;
  double overall_rms_m = 0.0;
  double max_m = 0.0;
  double atd_m = 0.0;
  int oscillation_count = 0;
  double ra_1pm = 0.0;
};

/// `kinds`: of the path's legs, by number; a leg beyond them counts in the overall figures only.
TrackingMetrics tracking_metrics(std::span<const PathError> errors, std::span<const LegKind> kinds);

}  // namespace headland
