// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace headland {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// What one way between two sites, or one piece of work, takes.
struct TourLeg {
  double cost = 0.0;  ///< in the objective's unit; infinity: impossible
  double duration_s = 0.0;
  double energy_j = 0.0;  ///< net drawn; may be negative
  double peak_j = 0.0;    ///< most drawn at any point since its beginning, >= max(0, energy_j)
};

/// How a task may be done: entered at one site, left at another (a row has two such modes; a place
/// to visit one, with the same site twice).
struct TourMode {
  int entry = 0;
  int exit = 0;
};

/// Something to be done once, by one vehicle, in one of its modes.
struct TourTask {
  std::vector<TourMode> modes;  ///< at least one
  double demand = 0.0;          ///< of the vehicle's load capacity
  double reward = kNever;       ///< lost when it is left out; infinity: it must be done
  double earliest_s = 0.0;      ///< work begins no earlier (the vehicle waits)
  double latest_s = kNever;     ///< and no later
};

/// Ways and work as one kind of vehicle drives them.
struct TourProfile {
  std::vector<TourLeg> ways;               ///< from * sites + to
  std::vector<std::vector<TourLeg>> work;  ///< of task, mode; infinite cost: not by this kind
};

struct TourStation {
  int site = 0;
  int slots = 1;  ///< vehicles at a time
};

/// Energy in a battery by charging time, from empty; linear between points. Times and energies rise
/// from {0, 0}; the last point is the full battery. At once: {0, 0}, {0, full}. Need not be
/// concave.
struct ChargeFunction {
  struct Point {
    double time_s = 0.0;
    double energy_j = 0.0;
  };
  std::vector<Point> points;
};

struct TourVehicle {
  int profile = 0;
  int start = 0;   ///< site
  int finish = 0;  ///< site
  double load_capacity = kNever;
  double battery_j = kNever;  ///< full
  double start_energy_j = kNever;
  double reserve_j = 0.0;        ///< never below, at any point
  double finish_energy_j = 0.0;  ///< left at the finish, at least (also >= reserve_j)
  double earliest_s = 0.0;
  double latest_s = kNever;  ///< at the finish
  double fixed_cost = 0.0;   ///< if it is used at all
  /// Of each station; no points: this vehicle cannot charge there. Empty: nowhere.
  std::vector<ChargeFunction> charging;
};

/// One problem for all of it: asymmetric TSP (one vehicle, no limits), several vehicles, electric
/// VRP with partial charging, time windows, orienteering.
///
/// Minimised: costs of ways and work, fixed costs, rewards lost, duration_weight * (sum of the used
/// vehicles' durations, from their earliest_s), span_weight * (latest finish). Waiting and charging
/// draw no energy. Energy beyond a full battery is lost. Between two tasks (and before the first,
/// after the last) any number of stations may be visited.
struct TourProblem {
  int sites = 0;
  std::vector<TourProfile> profiles;
  std::vector<TourTask> tasks;
  std::vector<TourStation> stations;
  std::vector<TourVehicle> vehicles;
  double duration_weight = 0.0;  ///< [objective's unit / s]
  double span_weight = 0.0;      ///< [objective's unit / s]

  const TourLeg& way(int profile, int from, int to) const {
    return profiles[static_cast<std::size_t>(profile)]
        .ways[static_cast<std::size_t>(from) * static_cast<std::size_t>(sites) +
              static_cast<std::size_t>(to)];
  }
};

/// A task done, or a charge.
struct TourStop {
  int task = -1;     ///< -1: a charge
  int mode = 0;      ///< of the task
  int station = -1;  ///< of a charge
  double arrival_s = 0.0;
  double begin_s = 0.0;  ///< of work or charging; later than the arrival if it waits
  double end_s = 0.0;
  double arrival_j = 0.0;  ///< in the battery
  double end_j = 0.0;
};

struct TourRoute {
  int vehicle = 0;
  std::vector<TourStop> stops;
  double cost = 0.0;  ///< ways, work and fixed cost
  double finish_s = 0.0;
  double finish_j = 0.0;  ///< in the battery
  double lowest_j = 0.0;  ///< at any point
};

/// A task left out, and why.
struct DroppedTask {
  int task = 0;
  std::string reason;  ///< such as "no vehicle reaches it and a charger again: short of 320 Wh"
};

struct TourSolution {
  std::vector<TourRoute> routes;  ///< of used vehicles, by vehicle
  std::vector<DroppedTask> dropped;
  double cost = 0.0;         ///< the whole objective
  double lower_bound = 0.0;  ///< no solution costs less
  bool optimal = false;      ///< proven: cost <= lower_bound up to rounding
};

}  // namespace headland
