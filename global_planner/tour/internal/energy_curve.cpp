// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/energy_curve.hpp"

#include <algorithm>
#include <cstddef>

namespace headland::tour {
namespace {

CurvePoint at_energy(const CurvePoint& a, const CurvePoint& b, double energy) {
  return {energy,
          a.time_s + (b.time_s - a.time_s) * (energy - a.energy_j) / (b.energy_j - a.energy_j)};
}
CurvePoint at_time(const CurvePoint& a, const CurvePoint& b, double time) {
  return {a.energy_j + (b.energy_j - a.energy_j) * (time - a.time_s) / (b.time_s - a.time_s), time};
}

// Keeps energies up to `most`; those above are cut off, or, as here, lost without gain in time.
void keep_up_to_energy(EnergyCurve& curve, double most) {
  if (curve.back().energy_j <= most) return;
  if (curve.front().energy_j >= most) {
    curve.resize(1);
    curve.front().energy_j = most;
    return;
  }
  while (curve[curve.size() - 2].energy_j >= most) curve.pop_back();
  curve.back() = at_energy(curve[curve.size() - 2], curve.back(), most);
}

// Segment of `points` (by energy) that holds `energy`, as the index of its upper end.
std::size_t upper_index(std::span<const CurvePoint> points, double energy) {
  std::size_t i = 0;
  while (i < points.size() && points[i].energy_j < energy) ++i;
  return i;
}

// Gain of arriving with `energy`: the less this is, the earlier one leaves with any more energy.
double head_start(std::span<const CurvePoint> arrival, const ChargeFunction& function,
                  double energy) {
  return time_at(arrival, energy) - charge_time(function, energy);
}

// Along the charge function from where the only point lies on it.
void charge_from_point(EnergyCurve& curve, const ChargeFunction& function, double full) {
  const CurvePoint arrival = curve.front();
  const double offset = arrival.time_s - charge_time(function, arrival.energy_j);
  for (const auto& point : function.points) {
    if (point.energy_j <= arrival.energy_j || point.energy_j >= full) continue;
    curve.push_back({point.energy_j, offset + point.time_s});
  }
  curve.push_back({full, offset + charge_time(function, full)});
}

}  // namespace

bool need_energy(EnergyCurve& curve, double energy_j) {
  if (!(curve.back().energy_j >= energy_j)) return false;
  const std::size_t i = upper_index(curve, energy_j);
  if (i == 0) return true;
  if (curve[i].energy_j == energy_j) {
    curve.erase(curve.begin(), curve.begin() + static_cast<std::ptrdiff_t>(i));
    return true;
  }
  curve[i - 1] = at_energy(curve[i - 1], curve[i], energy_j);
  curve.erase(curve.begin(), curve.begin() + static_cast<std::ptrdiff_t>(i - 1));
  return true;
}

bool drive(EnergyCurve& curve, const TourLeg& leg, double duration_s,
           const BatteryLimits& battery) {
  if (!need_energy(curve, battery.floor_j + std::max(leg.peak_j, leg.energy_j))) return false;
  for (CurvePoint& point : curve) {
    point.energy_j -= leg.energy_j;
    point.time_s += duration_s;
  }
  keep_up_to_energy(curve, battery.full_j);
  return true;
}

bool wait_window(EnergyCurve& curve, double earliest_s, double latest_s) {
  if (curve.front().time_s > latest_s || earliest_s > latest_s) return false;
  if (curve.front().time_s < earliest_s) {
    std::size_t i = 0;  // the first point that is late enough
    while (i < curve.size() && curve[i].time_s <= earliest_s) ++i;
    curve[i - 1] = i == curve.size() ? CurvePoint{curve.back().energy_j, earliest_s}
                                     : at_time(curve[i - 1], curve[i], earliest_s);
    curve.erase(curve.begin(), curve.begin() + static_cast<std::ptrdiff_t>(i - 1));
  }
  if (curve.back().time_s > latest_s) {
    while (curve[curve.size() - 2].time_s > latest_s) curve.pop_back();
    curve.back() = at_time(curve[curve.size() - 2], curve.back(), latest_s);
  }
  return true;
}

double time_at(std::span<const CurvePoint> curve, double energy_j) {
  const std::size_t i = upper_index(curve, energy_j);
  if (i == curve.size()) return kNever;
  if (i == 0 || curve[i].energy_j == energy_j) return curve[i].time_s;
  return at_energy(curve[i - 1], curve[i], energy_j).time_s;
}

double charge_time(const ChargeFunction& function, double energy_j) {
  const auto& points = function.points;
  if (energy_j <= points.front().energy_j) return points.front().time_s;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto& a = points[i - 1];
    const auto& b = points[i];
    if (energy_j > b.energy_j) continue;
    return a.time_s + (b.time_s - a.time_s) * (energy_j - a.energy_j) / (b.energy_j - a.energy_j);
  }
  return kNever;
}

double charged_energy(const ChargeFunction& function, double time_s) {
  const auto& points = function.points;
  for (std::size_t i = points.size() - 1; i > 0; --i) {
    const auto& a = points[i - 1];
    const auto& b = points[i];
    if (time_s >= b.time_s) return b.energy_j;
    if (time_s >= a.time_s) {
      return a.energy_j + (b.energy_j - a.energy_j) * (time_s - a.time_s) / (b.time_s - a.time_s);
    }
  }
  return points.front().energy_j;
}

// leave(E) = charge_time(E) + min over e <= E of [arrive(e) - charge_time(e)]: both terms of the
// minimum are linear between the points of curve and function, so a running minimum over those
// points, and the places where a falling stretch undercuts it, is exact.
void charge(EnergyCurve& curve, const ChargeFunction& function, double full_j, bool at_once,
            EnergyCurve& scratch) {
  const double full = std::min(full_j, function.points.back().energy_j);
  if (curve.front().energy_j >= full) return;
  if (at_once || function.points.back().time_s <= 0.0) {
    curve.resize(1);
    curve.front().energy_j = full;
    return;
  }
  if (curve.size() == 1) {
    charge_from_point(curve, function, full);
    return;
  }
  keep_up_to_energy(curve, full);
  EnergyCurve& arrival = scratch;
  arrival = curve;
  EnergyCurve grid(curve);  // energies at which anything bends
  for (const auto& point : function.points) {
    if (point.energy_j > curve.front().energy_j && point.energy_j < full) {
      grid.push_back({point.energy_j, 0.0});
    }
  }
  grid.push_back({full, 0.0});
  std::sort(grid.begin(), grid.end(),
            [](const CurvePoint& a, const CurvePoint& b) { return a.energy_j < b.energy_j; });
  curve.clear();
  double before = 0.0;  // head start at the grid point before
  double best = kNever;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double energy = grid[i].energy_j;
    if (i > 0 && energy <= grid[i - 1].energy_j) continue;
    const double here = head_start(arrival, function, energy);
    if (i > 0 && here < best && before > best) {
      const double share = (before - best) / (before - here);
      const double where = grid[i - 1].energy_j + share * (energy - grid[i - 1].energy_j);
      curve.push_back({where, best + charge_time(function, where)});
    }
    best = std::min(best, here);
    before = here;
    curve.push_back({energy, best + charge_time(function, energy)});
  }
}

double best_arrival(std::span<const CurvePoint> arrival, const ChargeFunction& function,
                    double leave_j) {
  double energy = std::min(arrival.front().energy_j, leave_j);
  double best = head_start(arrival, function, energy);
  const auto consider = [&](double candidate) {
    if (candidate < arrival.front().energy_j) return;
    if (candidate > std::min(leave_j, arrival.back().energy_j)) return;
    const double start = head_start(arrival, function, candidate);
    if (start < best) {
      best = start;
      energy = candidate;
    }
  };
  for (const CurvePoint& point : arrival) consider(point.energy_j);
  for (const auto& point : function.points) consider(point.energy_j);
  consider(leave_j);
  return energy;
}

double least_lead(std::span<const CurvePoint> a, std::span<const CurvePoint> b,
                  double energy_slack_j) {
  if (a.back().energy_j < b.back().energy_j - energy_slack_j) return -kNever;
  const auto lead = [&](double energy) {
    return time_at(b, std::min(energy, b.back().energy_j)) -
           time_at(a, std::min(energy, a.back().energy_j));
  };
  double least = lead(b.back().energy_j);
  for (const CurvePoint& point : b) least = std::min(least, lead(point.energy_j));
  for (const CurvePoint& point : a) {
    if (point.energy_j < b.back().energy_j) least = std::min(least, lead(point.energy_j));
  }
  return least;
}

}  // namespace headland::tour
