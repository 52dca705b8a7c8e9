// SPDX-License-Identifier: Apache-2.0
// The numbers of TourModel's tour problem.
#include <algorithm>
#include <cmath>

#include "global_planner/mission/internal/tour_model.hpp"

namespace headland::mission {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kPointsToFull = 4;    // of a charging function where the power falls
constexpr double kIdleTime = 1e-3;  // weight of all vehicles' time beside the last one's
// Of a second [J, km]: among plans of equal cost the quicker one, with charges no longer than
// needed.
constexpr double kTieBreak = 1e-3;

// Energy by charging time: the curve's corners, and points between where the power changes. The
// chords lie below the curve, so that the plan never counts on more than there is.
ChargeFunction charge_function(const ChargeCurve& curve, double capacity) {
  ChargeFunction function;
  std::vector<double> socs{0.0};
  const auto add_until = [&](double soc, int steps) {
    const double from = socs.back();
    for (int i = 1; i <= steps; ++i) socs.push_back(from + (soc - from) * i / steps);
  };
  for (const ChargePoint& point : curve.points()) {
    if (point.soc <= socs.back() || point.soc >= 1.0) continue;
    add_until(point.soc, curve.power(socs.back()) == curve.power(point.soc) ? 1 : kPointsToFull);
  }
  add_until(1.0, curve.power(socs.back()) == curve.power(1.0) ? 1 : kPointsToFull);
  for (const double soc : socs) {
    function.points.push_back({curve.time(0.0, soc, capacity), soc * capacity});
  }
  return function;
}

// In the objective's unit.
double dearest_leg(const TourProblem& problem, double per_s) {
  double most = 1.0;
  const auto count = [&](const TourLeg& leg) {
    if (std::isfinite(leg.cost)) most = std::max(most, leg.cost + per_s * leg.duration_s);
  };
  for (const TourProfile& profile : problem.profiles) {
    std::for_each(profile.ways.begin(), profile.ways.end(), count);
    for (const auto& modes : profile.work) std::for_each(modes.begin(), modes.end(), count);
  }
  return most;
}

}  // namespace

TourLeg TourModel::tour_leg(const DriveCost& cost) const {
  if (!std::isfinite(cost.energy_j)) return {kInfinity, 0.0, 0.0, 0.0};
  CostWeights weights = mission_->config.cost_weights();
  weights.per_s = 0.0;  // time counts by the vehicles' durations
  return {cost.value(weights), cost.duration_s, margined(cost.energy_j), margined(cost.peak_j)};
}

TourProfile TourModel::tour_profile(const Profile& profile) const {
  TourProfile result;
  const int count = base_sites() + static_cast<int>(cuts_.size());
  result.ways.reserve(static_cast<std::size_t>(count) * static_cast<std::size_t>(count));
  for (int from = 0; from < count; ++from) {
    for (int to = 0; to < count; ++to) result.ways.push_back(tour_leg(way(profile, from, to)));
  }
  for (const std::vector<DriveCost>& modes : profile.work) {
    result.work.emplace_back();
    for (const DriveCost& cost : modes) result.work.back().push_back(tour_leg(cost));
  }
  return result;
}

TourVehicle TourModel::tour_vehicle(int v) const {
  const MissionVehicle& given = mission_->vehicles[static_cast<std::size_t>(v)];
  const Battery& battery = given.vehicle.battery;
  TourVehicle vehicle;
  vehicle.profile = profile_of_vehicle_[static_cast<std::size_t>(v)];
  vehicle.start = start(v);
  vehicle.finish = finish(v);
  vehicle.battery_j = battery.capacity_j();
  vehicle.start_energy_j = given.soc * battery.capacity_j();
  vehicle.reserve_j = battery.reserve_j();
  vehicle.finish_energy_j = battery.reserve_j() + margined(escape_j(v, finish(v)));
  vehicle.latest_s = given.shift_s / (1.0 + mission_->config.planner.time_margin_ratio);
  for (const Charger& c : mission_->farm.chargers) {
    vehicle.charging.push_back(
        charge_function(lower(c.curve, battery.acceptance()), battery.capacity_j()));
  }
  return vehicle;
}

const TaskTerms& TourModel::terms_of(const ModelTask& task) const {
  return task.visit >= 0 ? mission_->visits[static_cast<std::size_t>(task.visit)].terms
                         : mission_->row_terms[static_cast<std::size_t>(task.row)];
}

void TourModel::build_problem() {
  problem_.sites = base_sites() + static_cast<int>(cuts_.size());
  for (const Profile& profile : profiles_) problem_.profiles.push_back(tour_profile(profile));
  for (int c = 0; c < chargers(); ++c) {
    problem_.stations.push_back(
        {charger(c), mission_->farm.chargers[static_cast<std::size_t>(c)].slots});
  }
  for (int v = 0; v < vehicles(); ++v) problem_.vehicles.push_back(tour_vehicle(v));
  const CostWeights weights = mission_->config.cost_weights();
  const double per_s = weights.per_s;
  problem_.duration_weight = (vehicles() == 1 ? per_s : kIdleTime * per_s) +
                             kTieBreak * (weights.per_j + kTieBreak * weights.per_m);
  problem_.span_weight = vehicles() == 1 ? 0.0 : per_s;

  const double most = dearest_leg(problem_, per_s);
  double least_value = kInfinity;
  for (const ModelTask& task : tasks_) least_value = std::min(least_value, terms_of(task).value);
  for (const ModelTask& task : tasks_) {
    const TaskTerms& terms = terms_of(task);
    TourTask work;
    if (task.visit >= 0) {
      work.modes = {{visit(task.visit), visit(task.visit)}};
    } else {
      for (const int entry : {0, 1}) {
        const int at_begin = cut_site(task.row, task.begin, entry);
        const int at_end = cut_site(task.row, task.end, entry);
        work.modes.push_back(entry == 0 ? TourMode{at_begin, at_end} : TourMode{at_end, at_begin});
      }
    }
    work.earliest_s = terms.earliest_s;
    work.latest_s = terms.latest_s / (1.0 + mission_->config.planner.time_margin_ratio);
    if (mission_->config.allow_dropping) {
      // Any task is worth more than all driving: it is left out only where it cannot be done.
      work.reward =
          terms.value / least_value * most * 10.0 * static_cast<double>(tasks_.size() + 1);
    }
    problem_.tasks.push_back(std::move(work));
  }
}

}  // namespace headland::mission
