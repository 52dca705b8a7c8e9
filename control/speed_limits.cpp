// SPDX-License-Identifier: Apache-2.0
#include "control/speed_limits.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "core/model/steering_rate.hpp"

namespace headland {
namespace {

constexpr double kUnlimited = 1000.0;  // what the configuration takes for no limit
constexpr double kCut = 0.25;          // zones along clothoids are no longer [m] ...
constexpr double kLeastCuts = 8.0;     // ... and no fewer
constexpr double kTurnCut = 0.04;      // on slopes they turn by no more than this [rad]
constexpr double kCrawl = 1e-3;        // no limit on power asks for less [m/s]

// The speed that legs and gear allow on a piece [m/s].
double wanted_speed(const Reference& reference, const Vehicle& vehicle, const PathPiece& piece) {
  const auto leg = static_cast<std::size_t>(std::max(piece.leg, 0));
  const double speed = leg < reference.leg_speed.size() ? reference.leg_speed[leg] : 0.0;
  const bool capped = piece.gear == Gear::kReverse && vehicle.reverse_speed_mps > 0.0;
  return capped ? std::min(speed, vehicle.reverse_speed_mps) : speed;
}

// Calls use(begin, end) for the stretches of a piece [m driven], each no longer than `step`.
template <class Use>
void cut(const PathPiece& piece, double step, const Use& use) {
  double parts = std::max(1.0, std::ceil(piece.length / step));
  if (piece.sharpness != 0.0) {
    parts = std::max({parts, kLeastCuts, std::ceil(piece.length / kCut)});
  }
  for (double i = 0.0; i < parts; i += 1.0) {
    use(piece.length * i / parts, piece.length * (i + 1.0) / parts);
  }
}

double most_curvature(const PathPiece& piece, double begin, double end) {
  return std::max(std::abs(piece.curvature_at(begin)), std::abs(piece.curvature_at(end)));
}

void sort_by_begin(std::vector<SpeedZone>& zones) {
  std::stable_sort(zones.begin(), zones.end(),
                   [](const SpeedZone& a, const SpeedZone& b) { return a.begin_s < b.begin_s; });
}

// The least speed at each place, as disjoint zones in order.
std::vector<SpeedZone> envelope(std::vector<SpeedZone> zones) {
  sort_by_begin(zones);
  std::vector<double> borders;
  for (const SpeedZone& zone : zones) {
    borders.push_back(zone.begin_s);
    borders.push_back(zone.end_s);
  }
  std::sort(borders.begin(), borders.end());
  const auto faster = [](const SpeedZone& a, const SpeedZone& b) { return a.speed > b.speed; };
  std::priority_queue<SpeedZone, std::vector<SpeedZone>, decltype(faster)> open(faster);
  std::vector<SpeedZone> lowest;
  auto next = zones.begin();
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    const double begin = borders[i];
    const double end = borders[i + 1];
    for (; next != zones.end() && next->begin_s <= begin; ++next) open.push(*next);
    while (!open.empty() && open.top().end_s <= begin) open.pop();
    if (open.empty() || !(begin < end)) continue;
    const double speed = open.top().speed;
    if (!lowest.empty() && lowest.back().end_s == begin && lowest.back().speed == speed) {
      lowest.back().end_s = end;
    } else {
      lowest.push_back({begin, end, speed});
    }
  }
  return lowest;
}

// At the constant speed v.
DriveStep at_speed(DriveStep step, double v) {
  step.speed_mps = v;
  step.speed_before_mps = v;
  step.duration_s = step.distance_m / v;
  return step;
}

}  // namespace

std::vector<SpeedZone> steering_zones(const Reference& reference, const Vehicle& vehicle,
                                      const SpeedLimitConfig& config) {
  const SteeringPace pace{config.steering_use_ratio, config.step_error_m, config.least_speed_ratio};
  std::vector<SpeedZone> zones;
  double s = 0.0;
  const PathPiece* before = nullptr;
  for (const PathPiece& piece : reference.path.pieces()) {
    const double wanted = wanted_speed(reference, vehicle, piece);
    if (before != nullptr && before->gear == piece.gear) {
      const auto slow =
          slow_at_step(vehicle, before->end_curvature(), piece.curvature, wanted, pace);
      if (slow) zones.push_back({s - 0.5 * slow->length, s + 0.5 * slow->length, slow->speed});
    }
    const auto slow =
        slow_on_ramp(vehicle, piece.curvature, piece.end_curvature(), piece.length, wanted, pace);
    if (slow) zones.push_back({s, s + slow->length, slow->speed});
    before = &piece;
    s += piece.length;
  }
  sort_by_begin(zones);
  return zones;
}

std::vector<SpeedZone> speed_zones(const Reference& reference, const Vehicle& vehicle,
                                   const SpeedLimitConfig& config) {
  std::vector<SpeedZone> zones = steering_zones(reference, vehicle, config);
  zones.insert(zones.end(), reference.zones.begin(), reference.zones.end());
  double s = 0.0;
  for (const PathPiece& piece : reference.path.pieces()) {
    if (piece.gear == Gear::kReverse && vehicle.reverse_speed_mps > 0.0) {
      zones.push_back({s, s + piece.length, vehicle.reverse_speed_mps});
    }
    const double wanted = wanted_speed(reference, vehicle, piece);
    const auto slower = [&](double begin, double end) {
      const double curvature = most_curvature(piece, begin, end);
      if (wanted * wanted * curvature <= config.max_lateral_mps2) return;
      zones.push_back({s + begin, s + end, std::sqrt(config.max_lateral_mps2 / curvature)});
    };
    if (config.max_lateral_mps2 < kUnlimited) cut(piece, piece.length, slower);
    s += piece.length;
  }
  return envelope(std::move(zones));
}

double speed_within_power(const EnergyModel& model, DriveStep step, double power, double wanted) {
  const auto allowed = [&](double v) { return wheel_power(model, at_speed(step, v)) <= power; };
  if (allowed(wanted)) return wanted;
  double slow = std::min(kCrawl, wanted);
  double fast = wanted;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (slow + fast);
    (allowed(middle) ? slow : fast) = middle;
  }
  return slow;
}

// Base power over the speed falls and resistance rises with it, both convex: a golden section
// search finds the one minimum.
double economic_speed(const EnergyModel& model, DriveStep step, double least, double most) {
  const auto energy = [&](double v) { return step_energy(model, at_speed(step, v)); };
  constexpr double kGolden = 0.6180339887498949;
  double a = least;
  double b = most;
  for (int i = 0; i < 30; ++i) {
    const double lower = b - kGolden * (b - a);
    const double upper = a + kGolden * (b - a);
    if (energy(lower) < energy(upper)) {
      b = upper;
    } else {
      a = lower;
    }
  }
  const double inside = 0.5 * (a + b);
  return energy(most) <= energy(inside) ? most : inside;
}

std::vector<SpeedZone> energy_zones(const Reference& reference, const Vehicle& vehicle,
                                    const SpeedLimitConfig& config, const Ground& ground) {
  const EnergyModel& model = vehicle.energy;
  if (model.drive_power_w <= 0.0 && config.economy_ratio <= 0.0) return {};
  std::vector<SpeedZone> zones;
  double s = 0.0;
  for (const PathPiece& piece : reference.path.pieces()) {
    const double wanted = wanted_speed(reference, vehicle, piece);
    const auto leg = static_cast<std::size_t>(std::max(piece.leg, 0));
    const auto add = [&](double begin, double end) {
      const Point2 from = piece.pose_at(begin).position();
      const Point2 to = piece.pose_at(end).position();
      const auto low = ground.height(from);
      const auto high = ground.height(to);
      DriveStep step;
      step.distance_m = end - begin;
      step.rise_m = low && high ? *high - *low : 0.0;
      step.curvature_1pm = most_curvature(piece, begin, end);
      step.soil = soil_resistance(ground.soil(0.5 * (from + to)));
      step.working = leg < reference.leg_working.size() && reference.leg_working[leg];
      double speed = wanted;
      if (config.economy_ratio > 0.0) {
        const double best = economic_speed(model, step, config.least_speed_ratio * wanted, wanted);
        speed += config.economy_ratio * (best - wanted);
      }
      if (model.drive_power_w > 0.0) {
        speed = speed_within_power(model, step, model.drive_power_w, speed);
      }
      if (speed < wanted) zones.push_back({s + begin, s + end, speed});
    };
    double step = std::min(ground.step(), piece.length);
    const double bend = most_curvature(piece, 0.0, piece.length);
    if (!ground.flat() && bend * step > kTurnCut) step = kTurnCut / bend;
    if (wanted > 0.0) cut(piece, step, add);
    s += piece.length;
  }
  return envelope(std::move(zones));
}

}  // namespace headland
