// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/metrics.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

// The definition, by walking outwards from every peak.
int peaks_by_definition(const std::vector<double>& x, double prominence) {
  int count = 0;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    std::size_t end = i;
    while (end + 1 < x.size() && x[end + 1] == x[i]) ++end;
    if (!(x[i] > x[i - 1]) || end + 1 >= x.size() || !(x[end + 1] < x[i])) continue;
    double left = x[i];
    for (std::size_t j = i + 1; j-- > 0 && x[j] <= x[i];) left = std::min(left, x[j]);
    double right = x[i];
    for (std::size_t j = end; j < x.size() && x[j] <= x[i]; ++j) right = std::min(right, x[j]);
    if (x[i] - std::max(left, right) >= prominence) ++count;
  }
  return count;
}

TEST(CountPeaks, CountsTheWavesOfASine) {
  std::vector<double> curve;
  for (int i = 0; i <= 1000; ++i) curve.push_back(std::sin(2.0 * kPi * 10.0 * i / 1000.0));
  EXPECT_EQ(count_peaks(curve, 0.0), 10);
  EXPECT_EQ(count_peaks(curve, 1.5), 9);  // the first peak rises by 1 only above the start
}

TEST(CountPeaks, LeavesOutRipplesBelowTheProminence) {
  std::vector<double> curve;
  for (int i = 0; i <= 1000; ++i) {
    curve.push_back(0.010 * std::sin(2.0 * kPi * 5.0 * i / 1000.0) +
                    0.0001 * std::sin(2.0 * kPi * 100.0 * i / 1000.0));
  }
  EXPECT_EQ(count_peaks(curve, 0.001), 5);
  EXPECT_GT(count_peaks(curve, kRoundingProminence), 10);
}

TEST(CountPeaks, CountsAPlateauOnceAndNoEnds) {
  EXPECT_EQ(count_peaks(std::vector<double>{0, 1, 1, 1, 0}, 0.0), 1);
  EXPECT_EQ(count_peaks(std::vector<double>{2, 1, 0, 1, 2}, 0.0), 0);
  EXPECT_EQ(count_peaks(std::vector<double>{0, 1, 1}, 0.0), 0);
  EXPECT_EQ(count_peaks(std::vector<double>{1, 1, 0}, 0.0), 0);
  EXPECT_EQ(count_peaks(std::vector<double>{0, 1}, 0.0), 0);
  EXPECT_EQ(count_peaks(std::vector<double>{}, 0.0), 0);
}

TEST(CountPeaks, AgreesWithTheDefinitionOnRandomCurves) {
  RandomStream random(5, "test");
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<double> curve;
    for (int i = 0; i < 60; ++i) {
      // Coarse values, so that plateaus and equal peaks occur.
      curve.push_back(trial % 2 == 0 ? random.index(6) : random.uniform());
    }
    for (const double prominence : {0.0, 0.3, 2.0}) {
      ASSERT_EQ(count_peaks(curve, prominence), peaks_by_definition(curve, prominence)) << trial;
    }
  }
}

TEST(RelativeAccuracyOf, IsOneOverTheProductOfMeanAndPeaks) {  // (004) Eq. 8
  const std::vector<double> deviations = {0.0, 0.02, 0.0, 0.04, 0.0};
  const RelativeAccuracy ra = relative_accuracy(deviations, kRoundingProminence);
  EXPECT_NEAR(ra.atd_m, 0.012, 1e-15);
  EXPECT_EQ(ra.oscillation_count, 2);
  EXPECT_NEAR(ra.ra_1pm, 1.0 / 0.024, 1e-9);
}

TEST(RelativeAccuracyOf, StaysFiniteWithoutPeaks) {
  EXPECT_NEAR(relative_accuracy(std::vector<double>{0.1, 0.1}, 0.0).ra_1pm, 10.0, 1e-12);
  EXPECT_EQ(relative_accuracy(std::vector<double>{0.0, 0.0}, 0.0).ra_1pm, 0.0);
  EXPECT_EQ(relative_accuracy({}, 0.0).ra_1pm, 0.0);
}

TEST(DeviationsFromPolyline, AreDistancesToItsSegmentsNotItsCorners) {
  const std::vector<Point2> line = {{0, 0}, {10, 0}, {10, 10}};
  const std::vector<Point2> driven = {{1, 0.3}, {4, -0.2}, {10.5, 0.5}, {9.0, 5.0}, {10.0, 11.0}};
  const std::vector<double> d = deviations_from_polyline(driven, line);
  ASSERT_EQ(d.size(), driven.size());
  EXPECT_NEAR(d[0], 0.3, 1e-12);
  EXPECT_NEAR(d[1], 0.2, 1e-12);
  EXPECT_NEAR(d[2], 0.5, 1e-12);
  EXPECT_NEAR(d[3], 1.0, 1e-12);
  EXPECT_NEAR(d[4], 1.0, 1e-12);
}

TEST(DeviationsFromPolyline, AreTheGlobalDistancesWhereTheDriveLeftThePath) {
  std::vector<Point2> line;
  for (int i = 0; i <= 400; ++i) line.emplace_back(0.25 * i, 0.0);
  const std::vector<Point2> driven = {{0.0, 0.1}, {50.0, 3.0}, {99.0, 0.2}, {1.0, 0.4}};
  const std::vector<double> d = deviations_from_polyline(driven, line);
  EXPECT_NEAR(d[1], 3.0, 1e-12);
  EXPECT_NEAR(d[2], 0.2, 1e-12);
  EXPECT_NEAR(d[3], 0.4, 1e-12);
}

TEST(DeviationsFromPolyline, ShowTheScallopsOfAnArcsWaypoints) {
  // Radius 5 m, chords of 0.33 m: a sagitta of 2.7 mm each, though the drive is on the arc.
  std::vector<Point2> waypoints;
  std::vector<Point2> driven;
  for (double a = 0.0; a < 3.0; a += 0.066) waypoints.emplace_back(5 * cos(a), 5 * sin(a));
  for (double a = 0.0; a < 2.9; a += 0.002) driven.emplace_back(5 * cos(a), 5 * sin(a));
  const std::vector<double> d = deviations_from_polyline(driven, waypoints);
  EXPECT_NEAR(*std::max_element(d.begin(), d.end()), 5.0 * (1.0 - std::cos(0.033)), 1e-5);
  EXPECT_NEAR(count_peaks(d, kRoundingProminence), 2.9 / 0.066, 1.0);
}

// A row, a turn to the left, a row back.
Path hairpin() {
  Path path;
  path.append_straight({0.0, 0.0, 0.0}, 20.0, 0);
  path.append({path.end_pose(), 0.5, 2.0 * kPi, Gear::kForward, 1});
  path.append_straight(path.end_pose(), 20.0, 2);
  return path;
}
const std::vector<LegKind> kKinds = {LegKind::kRow, LegKind::kTurn, LegKind::kRow};

TEST(ErrorsFromPath, AreSignedLeftPositiveAndKeepToTheirRow) {
  const Path path = hairpin();
  std::vector<Point2> driven;
  // Between the rows, nearer to the second one; only the first is within the window.
  for (double x = 0.0; x <= 18.0; x += 0.5) driven.emplace_back(x, 2.5);
  for (const PathError& e : errors_from_path(driven, path)) {
    EXPECT_EQ(e.leg, 0);
    EXPECT_NEAR(e.lateral_m, 2.5, 1e-9);
    EXPECT_NEAR(e.distance_m, 2.5, 1e-9);
  }
}

TEST(TrackingMetricsOf, SeparateRowsAndTurns) {
  const Path path = hairpin();
  std::vector<Point2> driven;
  for (const PathSample& sample : path.sample(0.1)) {
    const double off = sample.leg == 1 ? -0.2 : 0.1;
    driven.push_back(sample.pose.position() + off * sample.pose.left());
  }
  const TrackingMetrics m = tracking_metrics(errors_from_path(driven, path), kKinds);
  EXPECT_NEAR(m.row_rms_m, 0.1, 2e-3);
  EXPECT_NEAR(m.turn_rms_m, 0.2, 2e-3);
  EXPECT_GT(m.overall_rms_m, m.row_rms_m);
  EXPECT_LT(m.overall_rms_m, m.turn_rms_m);
  EXPECT_NEAR(m.max_m, 0.2, 2e-3);
}

TEST(TrackingMetricsOf, ArePerfectOnThePathAndEmptyWithoutADrive) {
  const Path path = hairpin();
  std::vector<Point2> driven;
  for (const PathSample& sample : path.sample(0.1)) driven.push_back(sample.pose.position());
  const TrackingMetrics m = tracking_metrics(errors_from_path(driven, path), kKinds);
  EXPECT_LT(m.max_m, 1e-9);
  EXPECT_EQ(m.oscillation_count, 0);
  EXPECT_EQ(tracking_metrics({}, kKinds).overall_rms_m, 0.0);
}

TEST(TrackingMetricsOf, CountWavesOfAMachineAndNotOfTheProcessor) {
  const Path path = hairpin();
  std::vector<Point2> driven;
  for (double x = 0.0; x <= 19.0; x += 0.05) {
    driven.emplace_back(x, 0.01 + 0.005 * std::sin(2.0 * kPi * x) + 1e-5 * std::sin(50.0 * x));
  }
  EXPECT_EQ(tracking_metrics(errors_from_path(driven, path), kKinds).oscillation_count, 19);
}

}  // namespace
}  // namespace headland
