// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace headland {
namespace {

// How far along the polyline [m] the search follows the drive, and how far off it gives up.
constexpr double kFollow = 3.0;
constexpr double kFound = 1.0;

double distance_to_segment(const Point2& p, const Point2& a, const Point2& b) {
  const Point2 along = b - a;
  const double length2 = along.squaredNorm();
  const double u = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - u * along).norm();
}

struct Nearest {
  std::size_t segment = 0;
  double distance = std::numeric_limits<double>::infinity();
};

// Over the segments [first, last).
Nearest nearest_segment(const Point2& p, std::span<const Point2> w, std::size_t first,
                        std::size_t last) {
  Nearest best;
  for (std::size_t i = first; i < last; ++i) {
    const double distance = distance_to_segment(p, w[i], w[i + 1]);
    if (distance < best.distance) best = {i, distance};
  }
  return best;
}

// For every i the lowest value between it and the nearest strictly higher value before it (or the
// start). A stack of falling values keeps it linear.
std::vector<double> lowest_before_higher(std::span<const double> x) {
  std::vector<double> lowest(x.size());
  std::vector<std::size_t> higher;
  for (std::size_t i = 0; i < x.size(); ++i) {
    lowest[i] = x[i];
    while (!higher.empty() && x[higher.back()] <= x[i]) {
      lowest[i] = std::min(lowest[i], lowest[higher.back()]);
      higher.pop_back();
    }
    higher.push_back(i);
  }
  return lowest;
}

double rms(double sum_of_squares, int count) {
  return count > 0 ? std::sqrt(sum_of_squares / count) : 0.0;
}

}  // namespace

std::vector<PathError> errors_from_path(std::span<const Point2> positions, const Path& path,
                                        double window, double start_s) {
  std::vector<PathError> errors;
  errors.reserve(positions.size());
  double s = start_s;
  for (const Point2& p : positions) {
    const Projection nearest =
        path.project(p, std::max(0.0, s - window), std::min(path.length(), s + window));
    s = nearest.s;
    errors.push_back({s, nearest.lateral_error, nearest.distance, path.at(s).leg});
  }
  return errors;
}

std::vector<double> deviations_from_polyline(std::span<const Point2> positions,
                                             std::span<const Point2> waypoints) {
  std::vector<double> deviations;
  if (waypoints.size() < 2) return deviations;
  deviations.reserve(positions.size());
  const std::size_t segments = waypoints.size() - 1;
  std::size_t at = 0;
  for (const Point2& p : positions) {
    std::size_t first = at;
    for (double back = 0.0; first > 0 && back < kFollow; --first) {
      back += (waypoints[first] - waypoints[first - 1]).norm();
    }
    std::size_t last = at;
    for (double ahead = 0.0; last < segments && ahead < kFollow; ++last) {
      ahead += (waypoints[last + 1] - waypoints[last]).norm();
    }
    Nearest nearest = nearest_segment(p, waypoints, first, last);
    if (nearest.distance > kFound) nearest = nearest_segment(p, waypoints, 0, segments);
    at = nearest.segment;
    deviations.push_back(nearest.distance);
  }
  return deviations;
}

int count_peaks(std::span<const double> curve, double prominence) {
  const std::size_t n = curve.size();
  if (n < 3) return 0;
  const std::vector<double> before = lowest_before_higher(curve);
  const std::vector<double> mirrored(curve.rbegin(), curve.rend());
  const std::vector<double> after = lowest_before_higher(mirrored);
  int count = 0;
  std::size_t i = 1;
  while (i + 1 < n) {
    std::size_t end = i;  // of the plateau that begins at i
    while (end + 1 < n && curve[end + 1] == curve[i]) ++end;
    if (end + 1 < n && curve[i] > curve[i - 1] && curve[end] > curve[end + 1]) {
      const double base = std::max(before[i], after[n - 1 - end]);
      if (curve[i] - base >= prominence) ++count;
    }
    i = end + 1;
  }
  return count;
}

RelativeAccuracy relative_accuracy(std::span<const double> deviations, double prominence) {
  RelativeAccuracy result;
  for (const double d : deviations) result.atd_m += d;
  result.atd_m /= std::max(1.0, static_cast<double>(deviations.size()));
  result.oscillation_count = count_peaks(deviations, prominence);
  const double product = result.atd_m * std::max(1, result.oscillation_count);
  result.ra_1pm = product > 0.0 ? 1.0 / product : 0.0;
  return result;
}

TrackingMetrics tracking_metrics(std::span<const PathError> errors,
                                 std::span<const LegKind> kinds) {
  TrackingMetrics m;
  double row = 0.0;
  double turn = 0.0;
  double all = 0.0;
  int rows = 0;
  int turns = 0;
  std::vector<double> deviations;
  deviations.reserve(errors.size());
  for (const PathError& e : errors) {
    const double square = e.distance_m * e.distance_m;
    const auto leg = static_cast<std::size_t>(std::max(e.leg, 0));
    const LegKind kind = leg < kinds.size() ? kinds[leg] : LegKind::kTransit;
    all += square;
    if (kind == LegKind::kRow) row += square, ++rows;
    if (kind == LegKind::kTurn) turn += square, ++turns;
    m.max_m = std::max(m.max_m, e.distance_m);
    deviations.push_back(e.distance_m);
  }
  m.row_rms_m = rms(row, rows);
  m.turn_rms_m = rms(turn, turns);
  m.overall_rms_m = rms(all, static_cast<int>(errors.size()));
  const RelativeAccuracy ra = relative_accuracy(deviations, kWaveProminence);
  m.atd_m = ra.atd_m;
  m.oscillation_count = ra.oscillation_count;
  m.ra_1pm = ra.ra_1pm;
  return m;
}

}  // namespace headland
