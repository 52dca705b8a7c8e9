// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "control/path_progress.hpp"
#include "control/receding_horizon/horizon_solver.hpp"
#include "control/speed_limits.hpp"
#include "control/speed_profile.hpp"
#include "control/tracker.hpp"
#include "core/base/error.hpp"
#include "core/config/visit.hpp"
#include "core/model/command_delay.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

enum class HorizonSolverKind { kRti, kIpopt };

struct HorizonConfig {
  HorizonSolverKind solver = HorizonSolverKind::kRti;
  int intervals_count = 15;
  double interval_s = 0.2;
  double steering_low_deg = -80.0;
  double steering_high_deg = 80.0;
  double acceleration_low_mps2 = -100.0;
  double acceleration_high_mps2 = 100.0;
  double max_yaw_rate_radps = 2.0;
  double deadline_s = 0.0;
  int most_stale_count = 10;
  double pivot_from_deg = 60.0;
  double pivot_until_deg = 10.0;
  double steering_tolerance_deg = 0.5;
  double stop_tolerance_m = 0.002;
  double lost_beyond_m = 2.0;
  double search_m = 1.0;
  HorizonWeights weights;

  std::optional<Error> check() const;

  template <class V>
  void visit(V& v) {
    v("solver", solver, "Who solves: the real-time iteration, or Ipopt");
    v("intervals_count", intervals_count, config::Range{1, 200}, "Of the horizon (seed 003: 15)");
    v("interval_s", interval_s, config::Range{0.01, 2.0}, "Length of one [s] (seed 003: 0.2)");
    v("steering_low_deg", steering_low_deg, config::Range{-80.0, 80.0},
      "Steering to the right at most, if the vehicle's own limit is not tighter [deg]");
    v("steering_high_deg", steering_high_deg, config::Range{-80.0, 80.0},
      "Steering to the left at most, likewise (seed 003: 40) [deg]");
    v("acceleration_low_mps2", acceleration_low_mps2, config::Range{-100.0, 100.0},
      "Hardest braking, if the vehicle's own limit is not tighter [m/s2]");
    v("acceleration_high_mps2", acceleration_high_mps2, config::Range{-100.0, 100.0},
      "Hardest acceleration, likewise [m/s2]");
    v("max_yaw_rate_radps", max_yaw_rate_radps, config::kPositive,
      "Fastest turn of a differential vehicle [rad/s]");
    v("deadline_s", deadline_s, config::kNonNegative,
      "A plan that takes longer is dropped for the last one, shifted [s]; 0: none");
    v("most_stale_count", most_stale_count, config::Range{0, 1000},
      "Cycles in a row that may drive by an old plan; then the vehicle stops");
    v("pivot_from_deg", pivot_from_deg, config::Range{5.0, 180.0},
      "Heading error from which a differential vehicle turns on the spot [deg]");
    v("pivot_until_deg", pivot_until_deg, config::Range{0.1, 60.0},
      "Heading error that ends turning on the spot [deg]");
    v("steering_tolerance_deg", steering_tolerance_deg, config::Range{0.01, 10.0},
      "Standing, the wheels are ready within this of the wanted angle [deg]");
    v("stop_tolerance_m", stop_tolerance_m, config::kPositive,
      "Nearer to a cusp or the end than this counts as there [m]");
    v("lost_beyond_m", lost_beyond_m, config::kPositive,
      "Farther from the path than this the vehicle stops [m]");
    v("search_m", search_m, config::kPositive,
      "How far around the last progress the nearest point is sought [m]");
    v("weights", weights, "What deviations cost");
  }
};

/// How a tracker's solves went since its construction.
struct HorizonCounts {
  int solves = 0;
  int late = 0;    ///< past their deadline: the shifted last plan drove
  int failed = 0;  ///< without a plan: likewise
};

/// The receding-horizon motion controller of seed 003 (III-D): every cycle it finds the controls of
/// the coming seconds that keep the vehicle, with the slip that is estimated, nearest to a
/// reference parametrised in time, and gives the first of them. The reference runs along the path
/// by the speed profile, stands at changes of gear, and has the heading and steering that the slip
/// asks for. Ackermann and differential vehicles, both gears, turning on the spot. Dead times are
/// bridged by predicting with the commands that are on their way. Deterministic without a clock. A
/// step does not allocate with the real-time iteration, and never throws.
class HorizonTracker : public Tracker {
 public:
  /// `cycle` [s] is the time between steps. Without a `clock` there are no deadlines. A `solver`
  /// for `intervals_count` intervals takes the place of the configured one.
  HorizonTracker(const Vehicle& vehicle, const HorizonConfig& config, double cycle,
                 const Clock* clock = nullptr, const SpeedLimitConfig& limits = {},
                 std::unique_ptr<HorizonSolver> solver = nullptr);

  const HorizonCounts& counts() const { return counts_; }
  /// The plan that drives now, and the problem it solves.
  const HorizonPlan& plan() const { return plan_; }
  const HorizonProblem& problem() const { return problem_; }

 private:
  enum class Mode { kStanding, kDriving, kPivoting, kStopping, kDone };

  Result<void> do_start() override;
  TrackOutput do_step(const VehicleEstimate& estimate, double dt) override;

  bool ackermann() const { return problem_.model.ackermann(); }
  double turn_of(const VehicleState& state) const {
    return ackermann() ? state.steering : state.yaw_rate;
  }
  VehicleState predict(const VehicleState& now) const;
  TrackOutput stop(TrackStatus status);
  TrackOutput give(const Command& command, TrackStatus status);
  TrackOutput arrive(const VehicleState& then);
  TrackOutput stand(const VehicleState& then);
  bool ready(const VehicleState& then) const;
  double standing_angle() const;
  TrackOutput drive(const VehicleState& then, double dt);
  void refer_to_path(const VehicleState& then, double s);
  void refer_to_pivot(const VehicleState& then, double heading_error);
  void set_bounds(const VehicleState& then);
  bool improve_plan(double dt);
  Command first_command(const VehicleState& then, double dt) const;

  Vehicle vehicle_;
  HorizonConfig config_;
  SpeedLimitConfig limits_;
  double cycle_;
  const Clock* clock_;
  CommandDelay delay_;
  SpeedProfile profile_;
  HorizonProblem problem_;
  Bounds turn_;  // [rad or rad/s]
  std::unique_ptr<HorizonSolver> solver_;
  HorizonPlan plan_;
  HorizonPlan shifted_;
  bool has_plan_ = false;
  int stale_ = 0;  // cycles in a row without a new plan
  HorizonCounts counts_;
  Mode mode_ = Mode::kDone;
  PathProgress progress_;
  bool changing_gear_ = false;
  double gear_left_ = 0.0;      // of a gear change [s]
  double steering_left_ = 0.0;  // until stuck wheels no longer hold it up [s]
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::HorizonSolverKind> {
  static constexpr std::pair<headland::HorizonSolverKind, std::string_view> values[] = {
      {headland::HorizonSolverKind::kRti, "rti"}, {headland::HorizonSolverKind::kIpopt, "ipopt"}};
};
