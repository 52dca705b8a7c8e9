// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/impossible.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "global_planner/tour/internal/itinerary.hpp"

namespace headland::tour {
namespace {

constexpr double kJoulesPerWattHour = 3600.0;

bool passable(const TourLeg& leg) { return leg.cost < kNever; }

// The least energy missing from a drive that begins with `available_j` at `from`, does the visit
// and ends at `to` with `left_j`; infinity if there is no such way.
double shortage(const Model& model, int kind_index, int from, double available_j, Visit visit,
                int to, double left_j) {
  const VehicleKind& kind = model.kind(kind_index);
  const TourLeg& there = model.way(kind_index, from, model.mode(visit).entry);
  const TourLeg& work = model.work(kind_index, visit);
  const TourLeg& back = model.way(kind_index, model.mode(visit).exit, to);
  double need = left_j;
  for (const TourLeg* leg : {&back, &work, &there}) {
    if (!passable(*leg)) return kNever;
    need = std::max(need + leg->energy_j, kind.battery.floor_j + leg->peak_j);
  }
  return need - available_j;
}

// Over all places to come from (the start, or a station with a full battery) and to go to.
double least_shortage(const Model& model, int kind_index, Visit visit) {
  const VehicleKind& kind = model.kind(kind_index);
  double least = kNever;
  const auto to_all = [&](int from, double available) {
    const auto to = [&](int site, double left) {
      least = std::min(least, shortage(model, kind_index, from, available, visit, site, left));
    };
    to(kind.vehicle.finish, kind.finish_need_j);
    for (const int s : kind.stations) to(model.station_site(s), kind.battery.floor_j);
  };
  to_all(kind.vehicle.start, kind.start_j);
  for (const int s : kind.stations) {
    const auto& points = kind.vehicle.charging[static_cast<std::size_t>(s)].points;
    to_all(model.station_site(s), std::min(kind.battery.full_j, points.back().energy_j));
  }
  return least;
}

// Why one kind of vehicle cannot do the task.
struct Reason {
  enum Kind { kNone, kNoWay, kLoad, kTime, kEnergy, kBoth } kind = kNoWay;
  double missing_j = kNever;
};

Reason reason_of(const Model& model, int kind_index, int task) {
  const VehicleKind& kind = model.kind(kind_index);
  if (model.task(task).demand > kind.vehicle.load_capacity) return {Reason::kLoad, kNever};
  Crossing crossing(model, kind_index, Crossing::Effort::kExact);
  Reason reason;
  for (int m = 0; m < model.modes(task); ++m) {
    const Visit visit{task, m};
    if (best_itinerary(model, crossing, kind_index, {visit})) return {Reason::kNone, 0.0};
    const TourLeg& there = model.way(kind_index, kind.vehicle.start, model.mode(visit).entry);
    const TourLeg& work = model.work(kind_index, visit);
    const TourLeg& back = model.way(kind_index, model.mode(visit).exit, kind.vehicle.finish);
    if (!passable(there) || !passable(work) || !passable(back)) continue;
    const double begin =
        std::max(kind.vehicle.earliest_s + there.duration_s, model.task(task).earliest_s);
    const bool late =
        begin > model.task(task).latest_s + model.time_slack() ||
        begin + work.duration_s + back.duration_s > kind.vehicle.latest_s + model.time_slack();
    if (late) {
      reason.kind = std::max(reason.kind, Reason::kTime);
      continue;
    }
    const double missing = least_shortage(model, kind_index, visit);
    if (missing > 0.0) {
      reason.kind = std::max(reason.kind, Reason::kEnergy);
      reason.missing_j = std::min(reason.missing_j, missing);
    } else {
      reason.kind = Reason::kBoth;
    }
  }
  return reason;
}

}  // namespace

std::optional<Error> why_impossible(const Model& model, int task) {
  Reason nearest;  // the one that lacks least
  for (int k = 0; k < static_cast<int>(model.kinds().size()); ++k) {
    const Reason reason = reason_of(model, k, task);
    if (reason.kind == Reason::kNone) return {};
    if (reason.kind == Reason::kEnergy && nearest.kind == Reason::kEnergy) {
      nearest.missing_j = std::min(nearest.missing_j, reason.missing_j);
    } else if (reason.kind > nearest.kind) {
      nearest = reason;
    }
  }
  const auto error = [&](ErrorCode code, const std::string& what) {
    return Error{code, fmt::format("task {}: {}", task, what), "leave the task out", {}};
  };
  switch (nearest.kind) {
    case Reason::kLoad:
      return error(
          ErrorCode::kTaskDoesNotFit,
          fmt::format("its load of {} is more than any vehicle holds", model.task(task).demand));
    case Reason::kTime:
      return error(ErrorCode::kTaskDoesNotFit, "no vehicle gets there and back in time");
    case Reason::kEnergy:
      return error(ErrorCode::kEnergyInfeasible,
                   fmt::format("no vehicle reaches it and a charger again: short of {:.4g} Wh",
                               nearest.missing_j / kJoulesPerWattHour));
    case Reason::kBoth:
      return error(ErrorCode::kEnergyInfeasible,
                   "no vehicle reaches it: chargers lie too far apart, or charging takes too long");
    default:
      return error(ErrorCode::kNoPath, "no vehicle has a way to it and back");
  }
}

}  // namespace headland::tour
