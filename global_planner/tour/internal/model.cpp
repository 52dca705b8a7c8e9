// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/model.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace headland::tour {
namespace {

constexpr double kRounding = 1e-10;  // share of a typical value that sums may be off by
constexpr double kTiePrice = 1e-6;   // of a second

bool same(const ChargeFunction& a, const ChargeFunction& b) {
  return std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                    [](const auto& p, const auto& q) {
                      return p.time_s == q.time_s && p.energy_j == q.energy_j;
                    });
}

bool alike(const TourVehicle& a, const TourVehicle& b) {
  const auto fields = [](const TourVehicle& v) {
    return std::tie(v.profile, v.start, v.finish, v.load_capacity, v.battery_j, v.start_energy_j,
                    v.reserve_j, v.finish_energy_j, v.earliest_s, v.latest_s, v.fixed_cost);
  };
  return fields(a) == fields(b) && std::equal(a.charging.begin(), a.charging.end(),
                                              b.charging.begin(), b.charging.end(), same);
}

bool takes_time(const ChargeFunction& f) { return !f.points.empty() && f.points.back().time_s > 0; }

VehicleKind kind_of(const TourVehicle& vehicle) {
  VehicleKind kind;
  kind.vehicle = vehicle;
  const double allowance = std::isfinite(vehicle.battery_j) ? kRounding * vehicle.battery_j : 0.0;
  kind.battery = {vehicle.reserve_j - allowance, vehicle.battery_j};
  kind.start_j = std::min(vehicle.start_energy_j, vehicle.battery_j);
  kind.finish_need_j = std::max(vehicle.reserve_j, vehicle.finish_energy_j) - allowance;
  const int stations =
      std::isfinite(vehicle.battery_j) ? static_cast<int>(vehicle.charging.size()) : 0;
  for (int s = 0; s < stations; ++s) {
    if (!vehicle.charging[static_cast<std::size_t>(s)].points.empty()) kind.stations.push_back(s);
  }
  return kind;
}

}  // namespace

Model::Model(const TourProblem& problem) : problem_(&problem) {
  group_vehicles();
  classify_time();
  measure();
  for (VehicleKind& kind : kinds_) kind.detours_never_pay = detours_never_pay(kind);
}

void Model::group_vehicles() {
  for (int v = 0; v < static_cast<int>(problem_->vehicles.size()); ++v) {
    const TourVehicle& vehicle = problem_->vehicles[static_cast<std::size_t>(v)];
    auto kind = std::find_if(kinds_.begin(), kinds_.end(),
                             [&](const VehicleKind& k) { return alike(k.vehicle, vehicle); });
    if (kind == kinds_.end()) kind = kinds_.insert(kind, kind_of(vehicle));
    kind->members.push_back(v);
  }
}

void Model::classify_time() {
  const auto& p = *problem_;
  windows_ = std::any_of(p.tasks.begin(), p.tasks.end(), [](const TourTask& t) {
    return t.earliest_s > 0.0 || t.latest_s < kNever;
  });
  const bool deadline = std::any_of(p.vehicles.begin(), p.vehicles.end(),
                                    [](const auto& v) { return v.latest_s < kNever; });
  const bool one = p.vehicles.size() == 1;
  const auto fleet = static_cast<double>(std::max<std::size_t>(1, p.vehicles.size()));
  duration_price_ = p.duration_weight + p.span_weight / fleet;
  const bool bounds_nothing = !windows_ && !deadline;
  timeless_ = bounds_nothing && duration_price_ == 0.0;
  time_is_cost_ = bounds_nothing && (one || p.span_weight == 0.0);
  if (timeless_) return;
  for (int s = 0; s < static_cast<int>(p.stations.size()); ++s) {
    int comers = 0;
    for (const TourVehicle& vehicle : p.vehicles) {
      const auto station = static_cast<std::size_t>(s);
      comers += station < vehicle.charging.size() && takes_time(vehicle.charging[station]);
    }
    may_queue_ = may_queue_ || comers > p.stations[static_cast<std::size_t>(s)].slots;
  }
}

// The scale of a whole tour: every site left by its cheapest way.
void Model::measure() {
  double cost = 0.0;
  double time = 0.0;
  for (const TourProfile& profile : problem_->profiles) {
    for (int a = 0; a < problem_->sites; ++a) {
      double least_cost = kNever;
      double least_time = kNever;
      for (int b = 0; b < problem_->sites; ++b) {
        const TourLeg& leg = profile.ways[static_cast<std::size_t>(a * problem_->sites + b)];
        if (a == b || !(leg.cost < kNever)) continue;
        least_cost = std::min(least_cost, std::abs(leg.cost));
        least_time = std::min(least_time, leg.duration_s);
      }
      if (least_cost < kNever) cost += least_cost;
      if (least_time < kNever) time += least_time;
    }
  }
  for (const TourTask& task : problem_->tasks) {
    if (task.latest_s < kNever) time = std::max(time, task.latest_s);
  }
  for (const TourVehicle& vehicle : problem_->vehicles) {
    if (vehicle.latest_s < kNever) time = std::max(time, vehicle.latest_s);
  }
  cost_slack_ = kRounding * cost;
  if (cost == 0.0 && duration_price_ == 0.0) tie_price_ = kTiePrice;
  for (const TourTask& task : problem_->tasks) {
    most_modes_ = std::max(most_modes_, static_cast<int>(task.modes.size()));
  }
  time_slack_ = kRounding * time;
}

bool Model::detours_never_pay(const VehicleKind& kind) const {
  const int profile = kind.vehicle.profile;
  const double energy_slack =
      std::isfinite(kind.battery.full_j) ? kRounding * kind.battery.full_j : 0.0;
  for (const int station : kind.stations) {
    const int s = station_site(station);
    for (int a = 0; a < problem_->sites; ++a) {
      const TourLeg& to = problem_->way(profile, a, s);
      if (!(to.cost < kNever)) continue;
      for (int b = 0; b < problem_->sites; ++b) {
        const TourLeg& from = problem_->way(profile, s, b);
        const TourLeg& direct = problem_->way(profile, a, b);
        if (a == b || a == s || b == s || !(from.cost < kNever)) continue;
        if (direct.cost > to.cost + from.cost + cost_slack_) return false;
        if (duration(direct) > duration(to) + duration(from) + time_slack_) return false;
        if (direct.energy_j > to.energy_j + from.energy_j + energy_slack) return false;
        if (direct.peak_j > std::max(to.peak_j, to.energy_j + from.peak_j) + energy_slack) {
          return false;
        }
      }
    }
  }
  return true;
}

}  // namespace headland::tour
