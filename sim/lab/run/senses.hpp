// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/world/agent.hpp"
#include "sim/lab/run/localizer_estimator.hpp"
#include "sim/lab/run/perception_config.hpp"
#include "sim/lab/run/row_sight.hpp"
#include "sim/lab/run/vehicle_lidar.hpp"
#include "sim/lab/trackers.hpp"
#include "sim/simulated_vehicle.hpp"

namespace headland {

/// Whom the tracker of a vehicle goes by: kAuto becomes the localizer on vehicles that perceive,
/// else the sensors' last word.
EstimatorKind estimator_for(const Vehicle& vehicle, const ControlConfig& control,
                            const PerceptionConfig& perception);

/// What a simulated vehicle knows of itself, tick by tick: by its sensors' last word, an estimator
/// or a localizer; with a lidar, in rows, by what that sees of them. Deterministic for a seed.
class Senses {
 public:
  /// `cycle` [s]: between two ticks. `scene`: what a lidar sees, must outlive this; null: the
  /// vehicle does not perceive.
  Senses(const Vehicle& vehicle, const ControlConfig& control, const PerceptionConfig& perception,
         const LidarScene* scene, double cycle, std::uint64_t seed);

  /// It is there, at time 0.
  void begin(const VehicleState& truth);
  /// One tick at `time` [s]: `told` was the last command. Without an estimator a vehicle that
  /// stands `idle` reads no new fix.
  void step(double time, SimulatedVehicle& vehicle, const Command& told,
            std::span<const Agent> agents, bool idle);
  /// After `step`, while `path` is driven near `s` [m]: in a row with plants `row_width` [m] apart
  /// on either side, the pose across it is the lidar's. 0: no row. `leg`: another one begins anew.
  void look_at_row(double time, const Pose2& truth, const Path& path, double s, int leg,
                   double row_width);

  const VehicleEstimate& known() const { return known_; }
  /// Since when no pose is known that could be driven on, in seconds; 0: one is.
  double lost_for() const { return lost_s_; }
  RowSightMetrics rows_seen() const { return rows_ ? rows_->metrics() : RowSightMetrics{}; }

 private:
  void perceive(double time, const Pose2& truth, std::span<const Agent> agents);

  double cycle_;
  const LidarScene* scene_;
  std::unique_ptr<Estimator> estimator_;     // null: the sensors' last word
  LocalizerEstimator* localizer_ = nullptr;  // it, if it is one
  std::optional<VehicleLidar> lidar_;
  std::optional<InertialSimulator> inertial_;
  std::optional<RowSight> rows_;
  const LidarScan* scan_ = nullptr;  // ended at this tick
  int row_leg_ = -1;
  VehicleEstimate known_;
  double lost_s_ = 0.0;
};

}  // namespace headland
