// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/config/visit.hpp"
#include "core/model/motion.hpp"

namespace headland {

/// x [m], y [m], yaw [rad] in map; speed of the wheels [m/s, signed]; turn (steering angle [rad] or
/// yaw rate of the wheels [rad/s]).
using HorizonState = Eigen::Matrix<double, 5, 1>;
/// Change of the speed [m/s2] and of the turn [rad/s or rad/s2].
using HorizonControl = Eigen::Vector2d;

enum HorizonIndex { kX = 0, kY = 1, kYaw = 2, kWheelSpeed = 3, kWheelTurn = 4 };

/// What deviations from the reference cost, all squared: of states once an interval, and at the end
/// of the horizon `terminal_ratio` times as much.
struct HorizonWeights {
  double along_weight = 10.0;
  double across_weight = 200.0;
  double heading_weight = 20.0;
  double speed_weight = 5.0;
  double turn_weight = 1.0;
  double acceleration_weight = 0.3;
  double turn_rate_weight = 0.3;
  double yaw_acceleration_weight = 0.01;
  double terminal_ratio = 3.0;

  template <class V>
  void visit(V& v) {
    v("along_weight", along_weight, config::kNonNegative, "Of the error along the path [1/m2]");
    v("across_weight", across_weight, config::kPositive, "Of the cross-track error [1/m2]");
    v("heading_weight", heading_weight, config::kNonNegative, "Of the heading error [1/rad2]");
    v("speed_weight", speed_weight, config::kNonNegative, "Of the speed error [s2/m2]");
    v("turn_weight", turn_weight, config::kNonNegative,
      "Of the steering angle or yaw rate against the path's [1/rad2, s2/rad2]");
    v("acceleration_weight", acceleration_weight, config::kPositive,
      "Of the acceleration against the reference's [s4/m2]");
    v("turn_rate_weight", turn_rate_weight, config::kPositive,
      "Of an Ackermann vehicle's steering rate against the reference's [s2/rad2]");
    v("yaw_acceleration_weight", yaw_acceleration_weight, config::kPositive,
      "Of a differential vehicle's yaw acceleration against the reference's [s4/rad2]");
    v("terminal_ratio", terminal_ratio, config::Range{1.0, 1000.0},
      "Weights of the last state over those of the others");
  }
};

/// Bounds of one number.
struct Bounds {
  double low = 0.0;
  double high = 0.0;
};

/// What is wanted of the state at one border of intervals, and of the control behind it.
struct HorizonStage {
  HorizonState wanted = HorizonState::Zero();
  HorizonControl control = HorizonControl::Zero();  ///< wanted; not used at the horizon's end
  Bounds speed;  ///< [m/s]; both bounds not used at the horizon's begin
  Bounds turn;   ///< [rad or rad/s]
};

/// One receding-horizon problem (seed 003, III-D; 15 intervals of 0.2 s there): the nonlinear
/// programme, by multiple shooting,
///   min  sum_k |T_k (x_k - r_k)|^2_Q + |u_k - v_k|^2_R   (T_k turns x, y into the reference's
///   frame) s.t. x_0 given, x_{k+1} = F(x_k, u_k), u in a box, speed and turn of x_{k>0} in boxes
/// with F the MotionModel under the slip, over one interval of constant control.
struct HorizonProblem {
  HorizonProblem(const MotionModel& motion, int intervals, double interval)
      : model(motion), interval_s(interval), stages(static_cast<std::size_t>(intervals) + 1) {}

  MotionModel model;
  double interval_s;
  Slip slip;
  HorizonState start = HorizonState::Zero();
  std::vector<HorizonStage> stages;  ///< one more than intervals
  HorizonWeights weights;
  Bounds acceleration;  ///< [m/s2]
  Bounds turn_rate;     ///< [rad/s or rad/s2]

  int intervals() const { return static_cast<int>(stages.size()) - 1; }
  const HorizonStage& stage(int k) const { return stages[static_cast<std::size_t>(k)]; }

  using StateMatrix = Eigen::Matrix<double, 5, 5>;
  using ControlMatrix = Eigen::Matrix<double, 5, 2>;

  /// F, and its derivatives.
  HorizonState next(const HorizonState& x, const HorizonControl& u) const;
  HorizonState next(const HorizonState& x, const HorizonControl& u, StateMatrix& by_state,
                    ControlMatrix& by_control) const;
  /// sum_i multiplier_i d2 F_i / d(x,u)2, 7 x 7, the controls last.
  Eigen::Matrix<double, 7, 7> curvature(const HorizonState& x, const HorizonControl& u,
                                        const HorizonState& multiplier) const;

  /// The cost of a state at border k is e' Q e / 2 with e = x - wanted: Q, 5 x 5.
  StateMatrix state_weight(int k) const;
  Eigen::Vector2d control_weight() const;  ///< diagonal of R
};

/// A trajectory over the horizon. As an argument it is where a solver starts.
struct HorizonPlan {
  explicit HorizonPlan(int intervals = 0)
      : states(static_cast<std::size_t>(intervals) + 1, HorizonState::Zero()),
        controls(static_cast<std::size_t>(intervals), HorizonControl::Zero()) {}

  std::vector<HorizonState> states;
  std::vector<HorizonControl> controls;

  int intervals() const { return static_cast<int>(controls.size()); }
  /// The same plan seen `time` [s] later: between its borders linear, behind its end held.
  /// Does not allocate if `shifted` has the same size.
  void shift_into(HorizonPlan& shifted, double time, double interval) const;
};

/// Sum of the costs of a plan; the dynamics do not enter.
double cost(const HorizonProblem& problem, const HorizonPlan& plan);

/// The largest violation of the dynamics by a plan, all components alike.
double dynamics_gap(const HorizonProblem& problem, const HorizonPlan& plan);

}  // namespace headland
