// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/internal/plan_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace headland::mission {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// One vehicle's tour under construction.
class TourBuilder {
 public:
  TourBuilder(const TourModel& model, int vehicle) : model_(model), v_(vehicle) {
    const MissionVehicle& given = model.mission().vehicles[static_cast<std::size_t>(vehicle)];
    plan_.id = given.id;
    plan_.vehicle = given.vehicle;
    plan_.start = given.start;
    plan_.shift_s = given.shift_s;
    plan_.start_soc = given.soc;
    plan_.min_soc = given.soc;
    soc_ = given.soc;
    site_ = model.start(vehicle);
  }

  void follow(const TourRoute& route) {
    plan_.stages.emplace_back();
    for (const TourStop& stop : route.stops) {
      if (stop.task >= 0) {
        do_task(stop);
      } else {
        charge(stop);
      }
    }
    drive_to(model_.finish(v_));
    if (plan_.stages.back().path.empty() && plan_.stages.size() > 1) plan_.stages.pop_back();
    plan_.finish_s = route.finish_s;
  }

  VehiclePlan finish() {
    set_margin();
    return std::move(plan_);
  }

 private:
  Battery battery() const { return plan_.vehicle.battery; }

  void do_task(const TourStop& stop) {
    const ModelTask& task = model_.tasks()[static_cast<std::size_t>(stop.task)];
    const TourMode& mode = model_.problem()
                               .tasks[static_cast<std::size_t>(stop.task)]
                               .modes[static_cast<std::size_t>(stop.mode)];
    const bool in_one_go = site_ == mode.entry && task.row >= 0;
    drive_to(mode.entry);
    const DriveCost cost = model_.work_cost(v_, stop.task, stop.mode);
    const double wait = stop.begin_s - stop.arrival_s;
    if (task.visit >= 0) {
      stand(LegKind::kTask, model_.leg_id(stop.task), cost, wait);
      plan_.legs.back().visit = task.visit;
      plan_.legs.back().earliest_s =
          model_.mission().visits[static_cast<std::size_t>(task.visit)].terms.earliest_s;
    } else if (in_one_go && !plan_.legs.empty() && plan_.legs.back().kind == LegKind::kRow) {
      prolong_row(stop, task, cost);
    } else {
      if (wait > 0.0) {
        stand(LegKind::kTask, fmt::format("wait until {:.0f} s", stop.begin_s), {}, wait);
        plan_.legs.back().earliest_s = stop.begin_s;
      }
      add_leg(LegKind::kRow, model_.leg_id(stop.task), model_.work_path(v_, stop.task, stop.mode),
              cost);
      mark_part(task, stop.mode, true);
    }
    site_ = mode.exit;
  }

  // The next part of the row at whose cut the vehicle has arrived at work.
  void prolong_row(const TourStop& stop, const ModelTask& task, const DriveCost& cost) {
    PlanLeg& leg = plan_.legs.back();
    const Path path = model_.work_path(v_, stop.task, stop.mode);
    plan_.stages.back().path.append(path, static_cast<int>(plan_.legs.size()) - 1);
    leg.cost += cost;
    draw(cost);
    leg.soc_end = soc_;
    time_ += cost.duration_s;
    mark_part(task, stop.mode, false);
  }

  void mark_part(const ModelTask& task, int mode, bool first) {
    PlanLeg& leg = plan_.legs.back();
    const Row& row =
        model_.mission().farm.row(model_.mission().rows[static_cast<std::size_t>(task.row)]);
    const double length_m = length(row.line);
    if (first) leg.from_m = (mode == 0 ? task.begin : task.end) * length_m;
    leg.to_m = (mode == 0 ? task.end : task.begin) * length_m;
    const bool whole = std::abs(std::abs(leg.to_m - leg.from_m) - length_m) < 1e-9;
    if (whole) leg.from_m = leg.to_m = 0.0;
  }

  void drive_to(int site) {
    const Path path = model_.way_path(v_, site_, site);
    if (!path.empty()) {
      add_leg(model_.way_kind(v_, site_, site),
              model_.site_name(site_) + " to " + model_.site_name(site), path,
              model_.way_cost(v_, site_, site));
    }
    site_ = site;
  }

  void charge(const TourStop& stop) {
    const TourStation& station = model_.problem().stations[static_cast<std::size_t>(stop.station)];
    drive_to(station.site);
    const Charger& charger = model_.mission().farm.chargers[static_cast<std::size_t>(stop.station)];
    if (stop.end_j <= stop.arrival_j) return;  // merely driven through
    DriveCost cost;
    cost.duration_s = stop.end_s - stop.begin_s;
    // For as long as the solver says. The battery is fuller than with the solver's margin: it ends
    // at least as full.
    const ChargeCurve curve = lower(charger.curve, battery().acceptance());
    soc_ = curve.soc_after(soc_, cost.duration_s, battery().capacity_j());
    stand(LegKind::kCharge, charger.id, cost, stop.begin_s - stop.arrival_s);
  }

  // A leg without a path: the stage ends before it.
  void stand(LegKind kind, const std::string& id, const DriveCost& cost, double wait) {
    plan_.stages.back().stop_leg = static_cast<int>(plan_.legs.size());
    time_ += wait;
    draw(cost);
    PlanLeg leg{kind, id, cost, soc_};
    leg.begin_s = time_;
    leg.wait_s = wait;
    plan_.legs.push_back(std::move(leg));
    starts_.push_back(site_);
    plan_.stages.emplace_back();
    time_ += cost.duration_s;
  }

  void add_leg(LegKind kind, const std::string& id, const Path& path, const DriveCost& cost) {
    plan_.stages.back().path.append(path, static_cast<int>(plan_.legs.size()));
    draw(cost);
    PlanLeg leg{kind, id, cost, soc_};
    leg.cusps = static_cast<int>(path.segments().size()) - 1;
    leg.begin_s = time_;
    plan_.legs.push_back(std::move(leg));
    starts_.push_back(site_);
    time_ += cost.duration_s;
  }

  void draw(const DriveCost& cost) {
    const double capacity = battery().capacity_j();
    plan_.energy_j += cost.energy_j;
    plan_.min_soc = std::min(plan_.min_soc, soc_ - cost.peak_j / capacity);
    soc_ = std::min(1.0, soc_ - cost.energy_j / capacity);
  }

  // From the end of the plan: what has to be had at the beginning of each leg to reach a charger,
  // by the plan or from the leg's end straight away. Along a leg the margin can only grow: what is
  // driven is no longer needed.
  void set_margin() {
    const double capacity = battery().capacity_j();
    const double reserve = battery().reserve_j();
    const bool idle = plan_.legs.empty();
    double need = idle ? 0.0 : model_.escape_j(v_, model_.finish(v_));
    double margin = soc_ * capacity - reserve - need;
    for (auto k = static_cast<int>(plan_.legs.size()) - 1; k >= 0; --k) {
      const auto i = static_cast<std::size_t>(k);
      const PlanLeg& leg = plan_.legs[i];
      const double begin_soc = k == 0 ? plan_.start_soc : plan_.legs[i - 1].soc_end;
      if (leg.kind == LegKind::kCharge) {
        need = 0.0;
      } else {
        DriveCost rest = leg.cost;
        rest += DriveCost{0.0, 0.0, 0.0, need};
        need = rest.peak_j;
      }
      margin = std::min(margin, begin_soc * capacity - reserve - need);
      if (leg.kind != LegKind::kRow) need = std::min(need, model_.escape_j(v_, starts_[i]));
    }
    plan_.min_margin_j = margin;
  }

  const TourModel& model_;
  int v_;
  VehiclePlan plan_;
  std::vector<int> starts_;  // site where each leg begins
  int site_;
  double soc_ = 1.0;
  double time_ = 0.0;
};

void add_totals(MissionPlan& plan) {
  plan.min_margin_j = kInfinity;
  for (const VehiclePlan& vehicle : plan.vehicles) {
    for (const PlanLeg& leg : vehicle.legs) {
      switch (leg.kind) {
        case LegKind::kRow:
          plan.work_m += leg.cost.length_m;
          break;
        case LegKind::kTurn:
          plan.turn_m += leg.cost.length_m;
          break;
        case LegKind::kCharge:
          ++plan.charge_stops;
          break;
        case LegKind::kTransit:
        case LegKind::kTask:
          plan.transit_m += leg.cost.length_m;
          break;
      }
    }
    plan.makespan_s = std::max(plan.makespan_s, vehicle.finish_s);
    plan.min_margin_j = std::min(plan.min_margin_j, vehicle.min_margin_j);
  }
}

// What the mission asks for: energy and length of all legs, and the time until the last vehicle is
// done.
double objective_value(const TourModel& model, const MissionPlan& plan) {
  const CostWeights weights = model.mission().config.cost_weights();
  double value = weights.per_s * plan.makespan_s;
  for (const VehiclePlan& vehicle : plan.vehicles) {
    for (const PlanLeg& leg : vehicle.legs) {
      value += weights.per_j * leg.cost.energy_j + weights.per_m * leg.cost.length_m;
    }
  }
  return value;
}

// The solver's cost also counts the vehicles' time a little, to settle ties: what that can come to.
double tie_breaks(const TourModel& model, const MissionPlan& plan) {
  const auto vehicles = static_cast<double>(plan.vehicles.size());
  const double asked = vehicles == 1 ? model.mission().config.cost_weights().per_s : 0.0;
  return (model.problem().duration_weight - asked) * vehicles * plan.makespan_s;
}

// Where the battery would fall below its reserve without the charge at `leg`: a text.
std::string charge_reason(const VehiclePlan& plan, std::size_t leg) {
  const Battery& battery = plan.vehicle.battery;
  const double arrival = leg == 0 ? plan.start_soc : plan.legs[leg - 1].soc_end;
  double soc = arrival;
  double driven = 0.0;
  std::string need = "it is needed to reach a charger from the finish";
  for (std::size_t k = leg + 1; k < plan.legs.size(); ++k) {
    const PlanLeg& next = plan.legs[k];
    if (next.kind == LegKind::kCharge) {
      need = fmt::format(
          "without it the next charge, at {}, would begin with a smaller margin "
          "than the plan keeps",
          next.id);
      break;
    }
    if (soc - next.cost.peak_j / battery.capacity_j() < battery.reserve_soc) {
      need = fmt::format(
          "without it the charge would fall below the reserve of {:.0f} % {:.0f} m "
          "on, in '{}'",
          100.0 * battery.reserve_soc, driven, next.id);
      break;
    }
    soc -= next.cost.energy_j / battery.capacity_j();
    driven += next.cost.length_m;
  }
  const PlanLeg& charge = plan.legs[leg];
  return fmt::format("{} charges {:.2f} kWh at {} ({:.0f} to {:.0f} %): {}", plan.id,
                     (charge.soc_end - arrival) * battery.capacity_j() / 3.6e6, charge.id,
                     100.0 * arrival, 100.0 * charge.soc_end, need);
}

void add_reasons(MissionPlan& plan) {
  for (std::size_t v = 0; v < plan.vehicles.size(); ++v) {
    const VehiclePlan& vehicle = plan.vehicles[v];
    for (std::size_t leg = 0; leg < vehicle.legs.size(); ++leg) {
      if (vehicle.legs[leg].kind != LegKind::kCharge) continue;
      plan.reasons.push_back(
          {static_cast<int>(v), static_cast<int>(leg), charge_reason(vehicle, leg)});
    }
  }
  for (const DroppedWork& work : plan.dropped) {
    plan.reasons.push_back({-1, -1, work.id + " is left out: " + work.reason});
  }
}

}  // namespace

MissionPlan build_plan(const TourModel& model, const TourSolution& solution) {
  MissionPlan plan;
  plan.objective = model.mission().config.objective;
  double lost = 0.0;
  for (const DroppedTask& dropped : solution.dropped) {
    lost += model.problem().tasks[static_cast<std::size_t>(dropped.task)].reward;
    plan.dropped.push_back({model.task_name(dropped.task), model.named(dropped.reason, false)});
  }
  plan.proven = solution.optimal;
  for (int v = 0; v < static_cast<int>(model.mission().vehicles.size()); ++v) {
    TourBuilder tour(model, v);
    for (const TourRoute& route : solution.routes) {
      if (route.vehicle == v && !route.stops.empty()) tour.follow(route);
    }
    plan.vehicles.push_back(tour.finish());
  }
  add_totals(plan);
  plan.value = objective_value(model, plan);
  plan.lower_bound = std::min(plan.value, solution.lower_bound - lost - tie_breaks(model, plan));
  add_reasons(plan);
  return plan;
}

}  // namespace headland::mission
