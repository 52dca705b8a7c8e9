// SPDX-License-Identifier: Apache-2.0
#include "core/model/charge_curve.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"

namespace headland {
namespace {

// Slope of the power below which it counts as constant [W per unit of soc].
constexpr double kFlat = 1e-9;

}  // namespace

ChargeCurve::ChargeCurve(std::vector<ChargePoint> points) : points_(std::move(points)) {
  HEADLAND_CHECK(!points_.empty(), "a charging curve without points");
  for (std::size_t i = 1; i < points_.size(); ++i) {
    HEADLAND_CHECK(points_[i].soc >= points_[i - 1].soc, "charging curve: points out of order");
  }
}

ChargeCurve ChargeCurve::cc_cv(double power_w, double cv_soc, double end_ratio) {
  if (cv_soc >= 1.0) return ChargeCurve(power_w);
  return ChargeCurve({{0.0, power_w}, {cv_soc, power_w}, {1.0, end_ratio * power_w}});
}

double ChargeCurve::power(double soc) const {
  const auto above = std::upper_bound(points_.begin(), points_.end(), soc,
                                      [](double s, const ChargePoint& p) { return s < p.soc; });
  if (above == points_.begin()) return points_.front().power_w;
  if (above == points_.end()) return points_.back().power_w;
  const ChargePoint& a = *(above - 1);
  return a.power_w + (above->power_w - a.power_w) * (soc - a.soc) / (above->soc - a.soc);
}

double ChargeCurve::max_power() const {
  double most = 0.0;
  for (const ChargePoint& p : points_) most = std::max(most, p.power_w);
  return most;
}

double ChargeCurve::time(double from_soc, double to_soc, double capacity) const {
  double total = 0.0;
  double soc = from_soc;
  while (soc < to_soc) {
    const auto above = std::upper_bound(points_.begin(), points_.end(), soc,
                                        [](double s, const ChargePoint& p) { return s < p.soc; });
    const double end = above == points_.end() ? to_soc : std::min(to_soc, above->soc);
    const double p0 = power(soc);
    const double p1 = above == points_.end() || above == points_.begin()
                          ? p0
                          : p0 + (above->power_w - p0) * (end - soc) / (above->soc - soc);
    const double slope = (p1 - p0) / (end - soc);
    total += std::abs(slope) < kFlat ? (end - soc) / p0 : std::log(p1 / p0) / slope;
    soc = end;
  }
  return total * capacity;
}

double ChargeCurve::soc_after(double from_soc, double time, double capacity) const {
  double soc = from_soc;
  double left = time / capacity;
  while (left > 0.0 && soc < 1.0) {
    const auto above = std::upper_bound(points_.begin(), points_.end(), soc,
                                        [](double s, const ChargePoint& p) { return s < p.soc; });
    const double end = above == points_.end() ? 1.0 : std::min(1.0, above->soc);
    const double p0 = power(soc);
    const double p1 = above == points_.end() || above == points_.begin()
                          ? p0
                          : p0 + (above->power_w - p0) * (end - soc) / (above->soc - soc);
    const double slope = (p1 - p0) / (end - soc);
    const bool flat = std::abs(slope) < kFlat;
    const double needed = flat ? (end - soc) / p0 : std::log(p1 / p0) / slope;
    if (needed > left) return soc + (flat ? p0 * left : p0 / slope * std::expm1(slope * left));
    left -= needed;
    soc = end;
  }
  return std::min(soc, 1.0);
}

ChargeCurve lower(const ChargeCurve& a, const ChargeCurve& b) {
  std::vector<double> socs{0.0, 1.0};
  for (const ChargePoint& p : a.points_) socs.push_back(p.soc);
  for (const ChargePoint& p : b.points_) socs.push_back(p.soc);
  std::sort(socs.begin(), socs.end());
  socs.erase(std::unique(socs.begin(), socs.end()), socs.end());
  std::vector<ChargePoint> points;
  for (std::size_t i = 0; i < socs.size(); ++i) {
    if (i > 0) {
      // Where the two cross between their points.
      const double d0 = a.power(socs[i - 1]) - b.power(socs[i - 1]);
      const double d1 = a.power(socs[i]) - b.power(socs[i]);
      if (d0 * d1 < 0.0) {
        const double soc = socs[i - 1] + (socs[i] - socs[i - 1]) * d0 / (d0 - d1);
        points.push_back({soc, a.power(soc)});
      }
    }
    points.push_back({socs[i], std::min(a.power(socs[i]), b.power(socs[i]))});
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
