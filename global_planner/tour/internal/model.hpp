// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "global_planner/tour/internal/energy_curve.hpp"
#include "global_planner/tour/tour_problem.hpp"

namespace headland::tour {

/// A task in one of its modes.
struct Visit {
  int task = 0;
  int mode = 0;

  friend bool operator==(const Visit&, const Visit&) = default;
};

/// Vehicles that are alike but for their number.
struct VehicleKind {
  TourVehicle vehicle;
  std::vector<int> members;    ///< indices of vehicles, ascending
  BatteryLimits battery;       ///< floor with an allowance for rounding
  double start_j = kNever;     ///< at most full
  double finish_need_j = 0.0;  ///< at the finish, at least
  std::vector<int> stations;   ///< those at which it can charge
  /// No way by way of a station is cheaper, shorter or easier than the way itself, so that stations
  /// are of use only for their energy.
  bool detours_never_pay = true;
};

/// The problem, and what every part of the search asks of it again and again.
class Model {
 public:
  explicit Model(const TourProblem& problem);

  const TourProblem& problem() const { return *problem_; }
  int tasks() const { return static_cast<int>(problem_->tasks.size()); }
  const TourTask& task(int index) const { return problem_->tasks[static_cast<std::size_t>(index)]; }
  const TourMode& mode(Visit visit) const {
    return task(visit.task).modes[static_cast<std::size_t>(visit.mode)];
  }
  int modes(int index) const { return static_cast<int>(task(index).modes.size()); }

  const std::vector<VehicleKind>& kinds() const { return kinds_; }
  const VehicleKind& kind(int index) const { return kinds_[static_cast<std::size_t>(index)]; }
  const TourLeg& way(int kind_index, int from, int to) const {
    return problem_->way(kind(kind_index).vehicle.profile, from, to);
  }
  const TourLeg& work(int kind_index, Visit visit) const {
    const auto profile = static_cast<std::size_t>(kind(kind_index).vehicle.profile);
    return problem_->profiles[profile]
        .work[static_cast<std::size_t>(visit.task)][static_cast<std::size_t>(visit.mode)];
  }
  int station_site(int station) const {
    return problem_->stations[static_cast<std::size_t>(station)].site;
  }

  /// Neither cost nor feasibility depends on time: batteries are always charged full.
  bool timeless() const { return timeless_; }
  /// Some task has a window; otherwise all times may be shifted together.
  bool windows() const { return windows_; }
  /// Time is worth `duration_price()` whenever it is spent, and bounds nothing.
  bool time_is_cost() const { return time_is_cost_; }
  /// Price of a vehicle's second in the search: the duration's weight and, for a single vehicle,
  /// the span's; several vehicles share it. [objective's unit / s]
  double duration_price() const { return duration_price_; }
  /// What a leg is worth in the search, but for charging and waiting.
  double price(const TourLeg& leg) const {
    return leg.cost + (duration_price_ + tie_price_) * leg.duration_s;
  }
  /// Most modes of any task.
  int most_modes() const { return most_modes_; }
  /// Vehicles may have to queue: charging takes time and some station has fewer slots than comers.
  bool may_queue() const { return may_queue_; }
  /// Differences below these are rounding.
  double cost_slack() const { return cost_slack_; }
  double time_slack() const { return time_slack_; }

  /// Driving time as the labels count it.
  double duration(const TourLeg& leg) const { return timeless_ ? 0.0 : leg.duration_s; }
  double earliest(const TourTask& t) const { return timeless_ ? 0.0 : t.earliest_s; }

 private:
  void group_vehicles();
  void classify_time();
  void measure();
  bool detours_never_pay(const VehicleKind& kind) const;

  const TourProblem* problem_;
  std::vector<VehicleKind> kinds_;
  bool timeless_ = false;
  bool windows_ = false;
  bool time_is_cost_ = false;
  bool may_queue_ = false;
  double duration_price_ = 0.0;
  double tie_price_ = 0.0;  // of time, where ways cost nothing
  int most_modes_ = 1;
  double cost_slack_ = 0.0;
  double time_slack_ = 0.0;
};

}  // namespace headland::tour
