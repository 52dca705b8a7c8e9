// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "core/world/ground.hpp"
#include "global_planner/mission/mission_plan.hpp"
#include "global_planner/mission/rest_of_mission.hpp"
#include "sim/lab/metrics.hpp"
#include "sim/lab/run/field_agents.hpp"
#include "sim/lab/run/local_layer.hpp"
#include "sim/lab/run/row_sight.hpp"
#include "sim/lab/trackers.hpp"
#include "sim/simulated_vehicle.hpp"

namespace headland {

/// How a plan is driven in simulation.
struct SimulationConfig {
  double step_s = 0.02;
  std::uint64_t seed = 1;
  double row_tolerance_m = 0.3;
  double max_deviation_m = 3.0;
  double max_lost_s = 60.0;
  double trace_period_s = 0.1;
  SensorConfig sensors;
  SlipConfig slip;
  ControlConfig control;
  FieldAgentsConfig agents;
  LocalLayerConfig local;
  PerceptionConfig perception;

  template <class V>
  void visit(V& v) {
    v("step_s", step_s, config::Range{0.001, 0.2}, "Time step of vehicle and controller [s]");
    v("seed", seed, config::kNonNegative, "Seed of the noise");
    v("row_tolerance_m", row_tolerance_m, config::kPositive,
      "A row counts as done if the cross-track error stayed within this [m]");
    v("max_deviation_m", max_deviation_m, config::kPositive,
      "The run is given up when the vehicle follows its path and is farther than this from it [m]");
    v("max_lost_s", max_lost_s, config::kPositive,
      "A vehicle that does not know its pose stands, and gives up after this [s]");
    v("trace_period_s", trace_period_s, config::kNonNegative,
      "Between the lines of trace.csv and the messages of run.mcap [s]; 0: every step");
    v("sensors", sensors, "Sensor errors");
    v("slip", slip, "Slip of the wheels on the ground");
    v("control", control, "The trackers");
    v("agents", agents, "People and animals about; none: the local layer is not needed");
    v("local", local, "The local layer, where there are agents");
    v("perception", perception, "What vehicles with a lidar see");
  }
};

/// One tick of a run.
struct TraceRow {
  double t_s = 0.0;
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  double speed_mps = 0.0;
  double steering_rad = 0.0;    ///< Ackermann; zero for differential vehicles
  double yaw_rate_radps = 0.0;  ///< commanded; differential vehicles
  double s_m = 0.0;             ///< progress along the whole plan
  double cross_track_m = 0.0;   ///< true position to the analytic path, left positive
  double soc = 1.0;
  Gear gear = Gear::kForward;
  int leg = 0;
  Slip slip;                      ///< that the wheels had
  Slip known_slip;                ///< that the tracker was told
  double position_error_m = 0.0;  ///< of the position that the tracker was told
  Driving driving = Driving::kPath;
};

/// What a run amounts to (metrics.json).
struct RunMetrics {
  bool completed = false;
  std::string reason;  ///< why not, if not
  int rows_done = 0;
  int rows_total = 0;
  int visits_done = 0;
  int visits_total = 0;
  int charges = 0;
  TrackingMetrics tracking;
  double energy_j = 0.0;
  double duration_s = 0.0;
  double waited_s = 0.0;  ///< for a slot at a charger, or for a task's time
  double min_soc = 1.0;
  bool reserve_kept = true;  ///< no battery ever went below its reserve
  int wrong_gear_count = 0;  ///< ticks that drove against the path's gear
  int stale_plan_count = 0;  ///< ticks that drove by an older plan of the tracker
  EncounterMetrics encounters;
  RowSightMetrics rows_seen;
  int replans = 0;         ///< of the rest of the mission, as the reserve was at risk
  int failed_replans = 0;  ///< ... to which there was no answer: the old plan was kept
};

/// One vehicle's run.
struct Run {
  VehiclePlan driven;  ///< the plan as it was driven: the given one, unless it was planned anew
  RunMetrics metrics;  ///< of every tick
  std::vector<bool> leg_done;
  std::vector<TraceRow> trace;  ///< every tick that it drove
};

/// Who was where at a moment.
struct AgentFrame {
  double t_s = 0.0;
  std::vector<Agent> agents;
};

/// All vehicles of a plan.
struct FleetRun {
  RunMetrics metrics;              ///< sums, and the worst of all; tracking over all ticks
  std::vector<Run> vehicles;       ///< as in the plan
  std::vector<AgentFrame> agents;  ///< every half second, if there are any
};

/// The ticks of a trace at least `period` [s] apart, the first and last among them.
std::vector<int> trace_ticks(const std::vector<TraceRow>& trace, double period);

/// A tick of one of the vehicles.
struct FleetTick {
  std::size_t vehicle = 0;
  std::size_t tick = 0;
};
/// All vehicles' trace_ticks, by time.
std::vector<FleetTick> fleet_ticks(const FleetRun& run, double period);

/// Called about every simulated second with the fraction done and the simulated time [s].
using Progress = std::function<void(double fraction, double time_s)>;

/// Plans the rest of a vehicle's mission anew; see headland::replan.
using Replan = std::function<Result<VehiclePlan>(std::size_t vehicle, const VehiclePlan& plan,
                                                 const Standing& standing)>;

/// What a run may ask for, and tell.
struct RunHooks {
  Progress progress;
  const Clock* clock = nullptr;  ///< trackers' deadlines are held against it
  Replan replan;                 ///< none: plans are kept, whatever the charge
  std::function<bool()> stop;    ///< true gives all vehicles up
  std::filesystem::path folder;  ///< where relative files of the configuration begin
};

/// Drives the plans of all vehicles in lock-step simulation, each with the tracker that suits its
/// kinematics. At chargers vehicles queue for slots, in the order in which they arrive. Vehicles do
/// not see each other yet. Where there are agents, each vehicle's local layer sees them, drives
/// around them and stops for them; the energy left is checked again afterwards, and what is left of
/// the mission planned anew if the reserve is at risk. Deterministic: same plan, configuration and
/// seed, same trace to the bit; unless there is a clock.
/// @return Errors of make_crowd and predictor_factory.
Result<FleetRun> drive_fleet(const std::vector<VehiclePlan>& plans,
                             const std::vector<Visit>& visits, const Farm& farm,
                             const Ground& ground, const SimulationConfig& config,
                             const RunHooks& hooks = {});

}  // namespace headland
