// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"
#include "core/model/measurement.hpp"
#include "perception/localization/first_heading.hpp"
#include "perception/localization/health.hpp"
#include "perception/localization/internal/replay.hpp"
#include "perception/localization/local_filter.hpp"

namespace headland {

/// What positions are worth, by what the receiver says of them: standard deviation per axis. A
/// reading's own deviation counts where it is larger.
struct FixNoiseConfig {
  double unknown_m = 0.02;
  double fixed_m = 0.02;
  double float_m = 0.3;
  double differential_m = 1.0;
  double single_m = 3.0;

  template <class V>
  void visit(V& v) {
    v("unknown_m", unknown_m, config::kPositive, "The receiver does not tell [m]");
    v("fixed_m", fixed_m, config::kPositive, "Carrier phase, whole ambiguities [m]");
    v("float_m", float_m, config::kPositive, "Carrier phase, ambiguities not whole [m]");
    v("differential_m", differential_m, config::kPositive, "Corrected pseudoranges [m]");
    v("single_m", single_m, config::kPositive, "Pseudoranges alone [m]");
  }
  double of(FixQuality quality) const;
};

struct GlobalFilterConfig {
  double antenna_x_m = 0.0;
  double antenna_y_m = 0.0;
  double baseline_m = 0.0;
  double baseline_tolerance_m = 0.03;
  double least_heading_noise_deg = 0.3;
  FixNoiseConfig fix_noise;
  double correlation_s = 1.0;
  double position_drift_m = 0.003;
  double heading_drift_deg = 0.02;
  double first_scale_ratio = 0.02;
  double first_bias_radps = 0.005;
  double first_side_deg = 1.0;
  double scale_walk_ratio = 1e-4;
  double bias_walk_radps = 2e-5;
  double side_walk_deg = 0.01;
  int reanchor_count = 5;
  double frozen_m = 0.25;
  double coasting_s = 2.0;
  double lost_m = 1.0;
  double replay_s = 1.0;

  template <class V>
  void visit(V& v) {
    v("antenna_x_m", antenna_x_m, config::Range{-20.0, 20.0},
      "Antenna ahead of base [m]; 0, 0: positions are of base");
    v("antenna_y_m", antenna_y_m, config::Range{-20.0, 20.0}, "Antenna to the left of base [m]");
    v("baseline_m", baseline_m, config::kNonNegative,
      "Between the two antennas that give the heading [m]; 0: not checked");
    v("baseline_tolerance_m", baseline_tolerance_m, config::kPositive,
      "A measured baseline off by more is a wrong heading [m]");
    v("least_heading_noise_deg", least_heading_noise_deg, config::kPositive,
      "No heading is trusted more [deg]");
    v("fix_noise", fix_noise, "What positions are worth");
    v("correlation_s", correlation_s, config::kNonNegative,
      "Errors of positions without whole ambiguities that are nearer in time are the same [s]");
    v("position_drift_m", position_drift_m, config::kNonNegative,
      "What the odometry's own covariance leaves out, after one metre [m]");
    v("heading_drift_deg", heading_drift_deg, config::kNonNegative,
      "Likewise of the heading, after one metre [deg]");
    v("first_scale_ratio", first_scale_ratio, config::kPositive,
      "Scale error of the odometry at the start");
    v("first_bias_radps", first_bias_radps, config::kPositive,
      "Turning of the odometry at the start [rad/s]");
    v("first_side_deg", first_side_deg, config::kPositive,
      "Direction error of the odometry's motion at the start [deg]");
    v("scale_walk_ratio", scale_walk_ratio, config::kNonNegative, "Its change in a second");
    v("bias_walk_radps", bias_walk_radps, config::kNonNegative, "Its change in a second [rad/s]");
    v("side_walk_deg", side_walk_deg, config::kNonNegative, "Its change in a second [deg]");
    v("reanchor_count", reanchor_count, config::Range{2.0, 8.0},
      "Rejected positions in a row that agree with each other are believed");
    v("frozen_m", frozen_m, config::kPositive,
      "Positions that do not change while the vehicle moves this far are frozen [m]");
    v("coasting_s", coasting_s, config::kPositive, "Without a position for longer: coasting [s]");
    v("lost_m", lost_m, config::kPositive,
      "Standard deviation of the position along its worst axis that is lost [m]");
    v("replay_s", replay_s, config::Range{0.0, 10.0},
      "Readings as late as this are still put in their place [s]");
  }
};

/// What the global filter knows.
struct GlobalEstimate {
  double time_s = std::numeric_limits<double>::quiet_NaN();
  Pose2 pose;                                            ///< T_map_base; yaw in (-pi, pi]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y [m], yaw [rad]
  double odometry_scale = 0.0;                           ///< true way / odometry's - 1
  double odometry_turning = 0.0;                         ///< its yaw rate too much [rad/s]
  double odometry_side = 0.0;  ///< motion, left of where odometry says [rad]
  PoseHealth health;
};

/// The pose in the map: the local filter's increments carry it on, GNSS positions and headings of
/// two antennas hold it (seed 000, III-B).
///
/// Extended Kalman filter over pose, and the odometry's scale error, turning and side error. Every
/// reading is gated at 99 % of its normalised innovation; between 95 % and that its noise is raised
/// in proportion. Positions that are rejected in a row and agree with each other re-anchor the
/// filter, by raising its covariance. Repeated values are never used. Starts from start(), or from
/// positions and a heading, or from positions alone once the way driven tells the heading. Late
/// readings are put in their place. Deterministic. One thread at a time. Does not allocate after
/// construction. An update costs about 2 us.
class GlobalFilter {
 public:
  explicit GlobalFilter(const GlobalFilterConfig& config);

  /// The pose at `time_s` is known, with its covariance (x [m], y [m], yaw [rad]).
  void start(double time_s, const Pose2& T_map_base, const Eigen::Matrix3d& covariance);
  bool started() const { return started_; }

  /// Motion since the increment before.
  ReadingOutcome add_increment(const MotionIncrement& increment);
  /// kPosition or kHeading; any other kind is kInvalid.
  ReadingOutcome add(const Measurement& reading);

  /// At the end of the last increment, or at a reading after it.
  GlobalEstimate estimate() const;

  static constexpr int kSize = 6;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  /// The state after the odometry says `moved` in `dt` [s], and the derivatives by the state and
  /// by `moved`.
  static Vector moved_on(const Vector& state, const Eigen::Vector3d& moved, double dt,
                         Matrix& by_state, Eigen::Matrix<double, kSize, 3>& by_moved);
  /// Place of an antenna at `arm` (in base), and its derivatives by the state.
  static Point2 antenna(const Vector& state, const Point2& arm,
                        Eigen::Matrix<double, 2, kSize>& by_state);

 private:
  enum class EventKind { kIncrement, kPosition, kHeading };
  struct Event {
    double time_s = 0.0;
    EventKind kind = EventKind::kIncrement;
    MotionIncrement increment;
    Measurement reading;
  };
  struct Rejected {
    static constexpr int kMost = 8;
    std::array<Point2, kMost> residual{};
    int count = 0;
  };
  struct State {
    double time_s = std::numeric_limits<double>::quiet_NaN();
    Vector mean = Vector::Zero();
    Matrix covariance = Matrix::Zero();
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();  // of the last increment, in base
    double travelled = 0.0;                          // [m]
    Rejected positions;                              // rejected in a row
    Rejected headings;                               // likewise; the residual is x [rad]
    Point2 last_value{std::numeric_limits<double>::quiet_NaN(), 0.0};
    double last_value_at = 0.0;                                    // travelled
    double last_fix_s = -std::numeric_limits<double>::infinity();  // used
    double anchored_s = -std::numeric_limits<double>::infinity();  // again
    bool frozen = false;
  };

  ReadingOutcome apply(State& state, const Event& event) const;
  void carry_on(State& state, const Eigen::Vector3d& moved, const Eigen::Matrix3d& covariance,
                double dt) const;
  void carry_on_to(State& state, double time_s) const;
  ReadingOutcome apply_position(State& state, const Measurement& reading) const;
  ReadingOutcome apply_heading(State& state, const Measurement& reading) const;
  bool agree(Rejected& rejected, const Point2& residual, double deviation) const;
  bool heading_fits_baseline(const Measurement& reading) const;
  ReadingOutcome try_to_start(const Measurement& reading);
  double position_noise(const Measurement& reading) const;

  GlobalFilterConfig config_;
  internal::Replay<State, Event> replay_;
  bool started_ = false;
  FirstHeading first_heading_;
  std::optional<Measurement> waiting_heading_;
  Pose2 waiting_motion_;  // since the waiting heading
};

}  // namespace headland
