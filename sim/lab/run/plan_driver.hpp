// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/lab/closed_loop.hpp"
#include "sim/lab/run/charger_slots.hpp"
#include "sim/lab/run/senses.hpp"

namespace headland {

/// One vehicle on its plan, tick by tick: tracker, estimator, charger stops, and the local layer
/// where there are agents. All that it is given must outlive it.
class PlanDriver {
 public:
  /// `obstacles`, `predictor`: for the local layer; null: nobody is about. `scene`: what a lidar
  /// sees; null: vehicles do not perceive.
  PlanDriver(int number, const VehiclePlan& plan, const std::vector<Visit>& visits,
             const Farm& farm, const Ground& ground, const SimulationConfig& config,
             ChargerSlots& slots, const ClearanceMap* obstacles, const PredictorFactory& predictor,
             const LidarScene* scene, const RunHooks& hooks);

  bool done() const { return state_ == State::kDone; }
  /// Of the driven length [m].
  double driven() const { return done() ? total_length_ : stage_start_s_ + progress_s_; }
  double total_length() const { return total_length_; }
  const VehicleState& truth() const { return vehicle_.truth(); }
  const Vehicle& vehicle() const { return plan_.vehicle; }

  /// The tick that ends at `time` [s]; `agents` at its begin.
  void step(double time, std::span<const Agent> agents);
  /// What came of the tick; `agents` at its end.
  void count(std::span<const Agent> agents);
  void stop(double time);
  Run finish();

 private:
  enum class State { kDriving, kQueueing, kStanding, kDone };

  const PlanStage& stage() const { return plan_.stages[stage_]; }
  const PlanLeg& stop() const { return plan_.legs[static_cast<std::size_t>(stage().stop_leg)]; }
  void fit_to_legs();
  void begin_stage(double time);
  void follow(const Path& path, double time);
  void observe(double time);
  double row_width(const PlanLeg& leg) const;
  void drive(double time);
  LocalGoal local_goal() const;
  ArbiterView local_view(double time);
  double nearest_s() const;
  bool at_stage_end() const;
  bool take_up_path(double time);
  double spare() const;
  bool may_replan(double time) const;
  void check_reserve(double time);
  void go_on_by(VehiclePlan anew, int first_leg, double ahead, double time);
  void arrive(double time);
  void begin_charge(double time);
  void end_stop(double time);
  bool visited(const Visit& visit) const;
  double planned_duration(const PlanStage& driven) const;
  void record(const Point2& before, Driving driving, double time);
  void give_up(const std::string& why, double time);
  void summarise();
  void count_leg(std::size_t i);
  void count_dropped(const PlanLeg& planned);

  int number_;
  ControlConfig control_;
  const VehiclePlan& given_;
  VehiclePlan plan_;  // as it is driven
  const std::vector<Visit>& visits_;
  const Farm& farm_;
  const Ground& ground_;
  const SimulationConfig& config_;
  ChargerSlots& slots_;
  SimulatedVehicle vehicle_;
  std::unique_ptr<Tracker> tracker_;
  Senses senses_;
  std::unique_ptr<LocalLayer> local_;  // null: nobody is about
  const RunHooks& hooks_;
  std::span<const Agent> agents_;
  Command told_;  // at the last tick
  std::vector<double> leg_speed_;
  std::vector<bool> leg_working_;
  Reference reference_;
  std::vector<double> worst_;  // largest cross-track error of each leg
  Run run_;
  State state_ = State::kDriving;
  std::size_t stage_ = 0;
  int charger_ = -1;
  double arrived_ = 0.0;     // at the stop
  double until_ = 0.0;       // it stands
  double give_up_at_ = 0.0;  // if the stage is not done by then
  double progress_s_ = 0.0;  // of the true position on the path that is followed [m]
  double reached_s_ = 0.0;   // ... and as far as the vehicle knows
  int checked_leg_ = -1;     // for its energy
  double replan_from_ = 0.0;
  double spare_ratio_ = 1.0;  // of the battery, above the reserve
  double spare_until_ = 0.0;  // that is known well enough
  double stage_start_s_ = 0.0;
  double total_length_ = 0.0;
};

}  // namespace headland
