// SPDX-License-Identifier: Apache-2.0
#include "core/model/charge_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.hpp"

namespace headland {
namespace {

// Power changes linearly in soc: d(soc)/dt = (power + slope (soc - soc0)) / capacity, whose
// solution is an exponential in time, and a logarithm the other way round. Both forms below keep
// their digits as the slope vanishes.

// log(1 + x) / x
double log1p_ratio(double x) { return std::abs(x) < 1e-9 ? 1.0 - 0.5 * x : std::log1p(x) / x; }
// (e^x - 1) / x
double expm1_ratio(double x) { return std::abs(x) < 1e-9 ? 1.0 + 0.5 * x : std::expm1(x) / x; }

// The curve from some soc up to its next point.
struct Stretch {
  double end_soc = std::numeric_limits<double>::infinity();
  double power = 0.0;  // where it begins [W]
  double slope = 0.0;  // [W per unit of soc]
};

Stretch stretch_from(const std::vector<ChargePoint>& points, double soc) {
  const auto next = std::upper_bound(points.begin(), points.end(), soc,
                                     [](double s, const ChargePoint& p) { return s < p.soc; });
  if (next == points.end()) return {.power = points.back().power_w};
  if (next == points.begin()) return {next->soc, next->power_w, 0.0};
  const ChargePoint& last = *(next - 1);
  const double slope = (next->power_w - last.power_w) / (next->soc - last.soc);
  return {next->soc, last.power_w + slope * (soc - last.soc), slope};
}

}  // namespace

ChargeCurve::ChargeCurve(std::vector<ChargePoint> points) : points_(std::move(points)) {
  HEADLAND_CHECK(!points_.empty(), "a charging curve without points");
  for (std::size_t i = 0; i < points_.size(); ++i) {
    HEADLAND_CHECK(points_[i].power_w > 0.0, "charging curve: no power");
    HEADLAND_CHECK(i == 0 || points_[i].soc > points_[i - 1].soc,
                   "charging curve: points out of order");
  }
}

ChargeCurve ChargeCurve::cc_cv(double power_w, double cv_soc, double end_ratio) {
  if (cv_soc >= 1.0) return ChargeCurve(power_w);
  return ChargeCurve({{cv_soc, power_w}, {1.0, end_ratio * power_w}});
}

double ChargeCurve::power(double soc) const { return stretch_from(points_, soc).power; }

double ChargeCurve::max_power() const {
  double most = 0.0;
  for (const ChargePoint& p : points_) most = std::max(most, p.power_w);
  return most;
}

double ChargeCurve::time(double from_soc, double to_soc, double capacity) const {
  double total = 0.0;
  double soc = from_soc;
  while (soc < to_soc) {
    const Stretch stretch = stretch_from(points_, soc);
    const double end = std::min(to_soc, stretch.end_soc);
    const double flat = (end - soc) / stretch.power;  // at constant power
    total += flat * log1p_ratio(stretch.slope * flat);
    soc = end;
  }
  return total * capacity;
}

double ChargeCurve::soc_after(double from_soc, double time, double capacity) const {
  double soc = from_soc;
  double left = time / capacity;
  while (left > 0.0 && soc < 1.0) {
    const Stretch stretch = stretch_from(points_, soc);
    const double end = std::min(1.0, stretch.end_soc);
    const double flat = (end - soc) / stretch.power;
    const double needed = flat * log1p_ratio(stretch.slope * flat);
    if (needed > left) {
      return std::min(end, soc + stretch.power * left * expm1_ratio(stretch.slope * left));
    }
    left -= needed;
    soc = end;
  }
  return std::min(soc, 1.0);
}

ChargeCurve lower(const ChargeCurve& a, const ChargeCurve& b) {
  std::vector<double> socs;
  for (const ChargePoint& p : a.points_) socs.push_back(p.soc);
  for (const ChargePoint& p : b.points_) socs.push_back(p.soc);
  std::sort(socs.begin(), socs.end());
  socs.erase(std::unique(socs.begin(), socs.end()), socs.end());
  std::vector<ChargePoint> points;
  for (std::size_t i = 0; i < socs.size(); ++i) {
    const double soc = socs[i];
    if (i > 0) {
      // Where the two cross between their points.
      const double d0 = a.power(socs[i - 1]) - b.power(socs[i - 1]);
      const double d1 = a.power(soc) - b.power(soc);
      const double crossing = socs[i - 1] + (soc - socs[i - 1]) * d0 / (d0 - d1);
      if (d0 * d1 < 0.0 && crossing > socs[i - 1] && crossing < soc) {
        points.push_back({crossing, a.power(crossing)});
      }
    }
    points.push_back({soc, std::min(a.power(soc), b.power(soc))});
  }
  return ChargeCurve(std::move(points));
}

bool ChargeCurve::concave_energy() const {
  for (std::size_t i = 1; i < points_.size(); ++i) {
    if (points_[i].power_w > points_[i - 1].power_w) return false;
  }
  return true;
}

}  // namespace headland
