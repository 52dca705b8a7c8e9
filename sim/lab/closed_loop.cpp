// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/closed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <span>

#include <fmt/format.h>

namespace headland {
namespace {

constexpr double kProgressPeriod = 1.0;  // simulated [s]

// Window of the path in which the true position is projected, around the tracker's progress [m].
constexpr double kWindow = 3.0;
// Nearer to a cusp than this, the vehicle is on it [m].
constexpr double kOnCusp = 1e-6;
// Slower counts as standing [m/s]: a drive with a lag never quite stands.
constexpr double kStill = 1e-3;

// Who charges where, and who waits: first come, first served.
class ChargerSlots {
 public:
  explicit ChargerSlots(const Farm& farm) : farm_(farm), queues_(farm.chargers.size()) {}

  int find(const std::string& id) const {
    for (std::size_t c = 0; c < farm_.chargers.size(); ++c) {
      if (farm_.chargers[c].id == id) return static_cast<int>(c);
    }
    return -1;
  }
  const Charger& charger(int c) const { return farm_.chargers[static_cast<std::size_t>(c)]; }
  void enqueue(int c, int vehicle) { queue(c).push_back(vehicle); }
  // The first in the queue hold the slots.
  bool holds_slot(int c, int vehicle) const {
    const auto& all = queues_[static_cast<std::size_t>(c)];
    const auto at = std::find(all.begin(), all.end(), vehicle);
    return at - all.begin() < charger(c).slots;
  }
  void leave(int c, int vehicle) {
    queue(c).erase(std::find(queue(c).begin(), queue(c).end(), vehicle));
  }

 private:
  std::vector<int>& queue(int c) { return queues_[static_cast<std::size_t>(c)]; }
  const Farm& farm_;
  std::vector<std::vector<int>> queues_;  // of vehicles, at each charger
};

// Rows, and those of which all parts are done, by whichever vehicle.
void count_rows(std::span<const VehiclePlan> plans, std::span<const Run> runs,
                RunMetrics& metrics) {
  std::map<std::string, bool> done;
  for (std::size_t v = 0; v < plans.size(); ++v) {
    for (std::size_t i = 0; i < plans[v].legs.size(); ++i) {
      const PlanLeg& leg = plans[v].legs[i];
      if (leg.kind != LegKind::kRow) continue;
      const auto row = done.emplace(leg.id, true).first;
      row->second = row->second && runs[v].leg_done[i];
    }
  }
  metrics.rows_total = static_cast<int>(done.size());
  metrics.rows_done = static_cast<int>(
      std::count_if(done.begin(), done.end(), [](const auto& row) { return row.second; }));
}

const char* describe(TrackStatus failure) {
  switch (failure) {
    case TrackStatus::kPathLost:
      return "the tracker lost the path";
    case TrackStatus::kBadState:
      return "the measured state is no number";
    case TrackStatus::kSolverFailed:
      return "the tracker's solver failed";
    case TrackStatus::kTracking:
    case TrackStatus::kGearChange:
    case TrackStatus::kDone:
      break;
  }
  return "the tracker stopped";
}

// One vehicle on its plan, tick by tick.
class Driver {
 public:
  Driver(int number, const VehiclePlan& plan, const std::vector<Visit>& visits, const Farm& farm,
         const Ground& ground, const SimulationConfig& config, ChargerSlots& slots,
         const Clock* clock)
      : number_(number),
        plan_(plan),
        visits_(visits),
        farm_(farm),
        ground_(ground),
        config_(config),
        slots_(slots),
        vehicle_(plan.vehicle, plan.start, plan.start_soc, {config.sensors, config.slip},
                 config.seed + static_cast<std::uint64_t>(number), config.step_s, ground),
        tracker_(make_tracker(plan.vehicle, config.control, config.sensors, config.step_s, clock)),
        estimator_(make_estimator(plan.vehicle, config.control, config.step_s)),
        worst_(plan.legs.size(), 0.0) {
    run_.leg_done.assign(plan.legs.size(), false);
    for (const PlanStage& stage : plan.stages) total_length_ += stage.path.length();
    for (const PlanLeg& leg : plan.legs) {
      leg_speed_.push_back(leg_speed(plan.vehicle, leg.kind));
      leg_working_.push_back(leg.kind == LegKind::kRow);
    }
    if (estimator_ != nullptr) estimator_->reset(vehicle_.truth(), 0.0);
    begin_stage(0.0);
  }

  bool done() const { return state_ == State::kDone; }
  // Of the driven length [m].
  double driven() const { return done() ? total_length_ : stage_start_s_ + progress_s_; }
  double total_length() const { return total_length_; }

  // The tick that ends at `time` [s].
  void step(double time) {
    if (state_ != State::kDone) observe(time - config_.step_s);
    switch (state_) {
      case State::kDriving:
        drive(time);
        break;
      case State::kQueueing:
        if (slots_.holds_slot(charger_, number_)) begin_charge(time);
        break;
      case State::kStanding:
        if (time >= until_) end_stop(time);
        break;
      case State::kDone:
        break;
    }
  }

  Run finish() {
    summarise();
    return std::move(run_);
  }

 private:
  enum class State { kDriving, kQueueing, kStanding, kDone };

  const PlanStage& stage() const { return plan_.stages[stage_]; }
  const PlanLeg& stop() const { return plan_.legs[static_cast<std::size_t>(stage().stop_leg)]; }

  void begin_stage(double time) {
    if (stage_ >= plan_.stages.size()) {
      state_ = State::kDone;
      run_.metrics.duration_s = time;
      return;
    }
    progress_s_ = 0.0;
    if (stage().path.empty()) return arrive(time);
    reference_ = Reference{stage().path, leg_speed_, {}, leg_working_};  // the tracker points to it
    reference_.zones = energy_zones(reference_, plan_.vehicle, config_.control.limits, ground_);
    if (const auto started = tracker_->start(reference_); !started) {
      return give_up(started.error().what, time);
    }
    // Nothing drives a stage at less than a tenth of its planned pace.
    give_up_at_ = time + 60.0 + 10.0 * planned_duration(stage());
    state_ = State::kDriving;
  }

  // What the vehicle knows of itself at `time` [s], at a stand too.
  void observe(double time) {
    if (estimator_ == nullptr) {
      if (state_ == State::kDriving) known_ = vehicle_.measure();
      return;
    }
    known_ = estimator_->update(vehicle_.sense(time), told_, time).vehicle;
  }

  void drive(double time) {
    const TrackOutput output = tracker_->step(known_, config_.step_s);
    told_ = output.command;
    if (output.stale) ++run_.metrics.stale_plan_count;
    const Point2 before = vehicle_.truth().pose.position();
    if (output.status == TrackStatus::kDone && std::abs(vehicle_.truth().speed) < kStill) {
      return arrive(time);
    }
    if (failed(output.status)) return give_up(describe(output.status), time);
    const Path& path = stage().path;
    vehicle_.step(output.command, plan_.legs[static_cast<std::size_t>(path.at(output.s).leg)].kind);
    record(path, output, before, time);
    if (std::abs(run_.trace.back().cross_track_m) > config_.max_deviation_m) {
      return give_up("the vehicle left its path", time);
    }
    if (vehicle_.soc() <= 0.0) return give_up("the battery is empty", time);
    if (time > give_up_at_) give_up("the vehicle does not get on", time);
  }

  // At the stage's end: stand in the queue of a charger, at a visit, or go on.
  void arrive(double time) {
    stage_start_s_ += stage().path.length();
    progress_s_ = 0.0;
    if (stage().stop_leg < 0) {
      ++stage_;
      return begin_stage(time);
    }
    arrived_ = time;
    if (stop().kind == LegKind::kCharge) {
      charger_ = slots_.find(stop().id);
      slots_.enqueue(charger_, number_);
      state_ = State::kQueueing;
      if (slots_.holds_slot(charger_, number_)) begin_charge(time);
      return;
    }
    const double begin = std::max(time, stop().earliest_s);
    run_.metrics.waited_s += begin - time;
    until_ = begin + stop().cost.duration_s;
    vehicle_.draw(stop().cost.energy_j);
    state_ = State::kStanding;
  }

  void begin_charge(double time) {
    run_.metrics.waited_s += time - arrived_;
    ++run_.metrics.charges;
    until_ = time + vehicle_.charge(
                        lower(slots_.charger(charger_).curve, plan_.vehicle.battery.acceptance()),
                        stop().soc_end);
    state_ = State::kStanding;
  }

  void end_stop(double time) {
    if (stop().kind == LegKind::kCharge) slots_.leave(charger_, number_);
    run_.leg_done[static_cast<std::size_t>(stage().stop_leg)] =
        stop().visit < 0 || visited(visits_[static_cast<std::size_t>(stop().visit)]);
    ++stage_;
    begin_stage(time);
  }

  // Whether the vehicle stands near enough to the poi, and not too late.
  bool visited(const Visit& visit) const {
    const Poi& poi = farm_.pois[static_cast<std::size_t>(visit.poi)];
    const Point2 off = vehicle_.truth().pose.position() - poi.pose.position();
    return off.norm() <= visit.accuracy_m && arrived_ <= visit.terms.latest_s;
  }

  double planned_duration(const PlanStage& driven) const {
    double duration = 0.0;
    for (const PathPiece& piece : driven.path.pieces()) {
      duration += piece.length / leg_speed_[static_cast<std::size_t>(piece.leg)];
    }
    return duration + 10.0 * static_cast<double>(driven.path.segments().size());
  }

  // Projects the true position onto the path around the tracker's progress, never across a cusp
  // (the path runs back on itself there), and appends a trace row.
  void record(const Path& path, const TrackOutput& output, const Point2& before, double time) {
    const VehicleState& truth = vehicle_.truth();
    // On a cusp the tracker is still on the segment that ends there.
    const double s = std::max(0.0, output.s - kOnCusp);
    const PathSegment& segment = path.segments()[static_cast<std::size_t>(path.at(s).segment)];
    const Projection projection =
        path.project(truth.pose.position(), std::max(segment.begin_s, output.s - kWindow),
                     std::min(segment.end_s, output.s + kWindow));
    const PathSample at = path.at(std::min(projection.s, segment.end_s - 1e-9));
    progress_s_ = projection.s;
    run_.trace.push_back({time, truth.pose.x, truth.pose.y, truth.pose.yaw, truth.speed,
                          truth.steering, output.command.yaw_rate, stage_start_s_ + projection.s,
                          projection.lateral_error, vehicle_.soc(), at.gear, at.leg,
                          vehicle_.slip(), known_.slip,
                          (known_.state.pose.position() - before).norm()});
    const auto leg = static_cast<std::size_t>(at.leg);
    worst_[leg] = std::max(worst_[leg], std::abs(projection.lateral_error));
    run_.leg_done[leg] = true;
    if (truth.speed * sign(at.gear) < -1e-3) ++run_.metrics.wrong_gear_count;
    run_.metrics.min_soc = std::min(run_.metrics.min_soc, vehicle_.soc());
  }

  void give_up(const std::string& why, double time) {
    const bool moved = !run_.trace.empty();
    const int leg = moved ? run_.trace.back().leg : 0;
    run_.metrics.reason = fmt::format("{}: {} after {:.1f} m, on leg '{}'", plan_.id, why,
                                      moved ? run_.trace.back().s_m : 0.0,
                                      plan_.legs[static_cast<std::size_t>(leg)].id);
    run_.metrics.duration_s = time;
    state_ = State::kDone;
  }

  void summarise() {
    RunMetrics& metrics = run_.metrics;
    for (std::size_t i = 0; i < plan_.legs.size(); ++i) count_leg(i);
    count_rows({&plan_, 1}, {&run_, 1}, metrics);
    const double reserve = plan_.vehicle.battery.reserve_soc;
    metrics.reserve_kept = metrics.min_soc >= reserve - 1e-9;
    if (metrics.reason.empty() && !metrics.reserve_kept) {
      metrics.reason = fmt::format("{}: the charge fell to {:.1f} %, below the reserve of {:.1f} %",
                                   plan_.id, 100.0 * metrics.min_soc, 100.0 * reserve);
    }
    if (metrics.reason.empty() && metrics.duration_s > plan_.shift_s) {
      metrics.reason = fmt::format("{}: it was back {:.0f} s after its shift of {:.0f} s", plan_.id,
                                   metrics.duration_s - plan_.shift_s, plan_.shift_s);
    }
    const int missed_rows = metrics.rows_total - metrics.rows_done;
    const int missed_visits = metrics.visits_total - metrics.visits_done;
    metrics.completed = metrics.reason.empty() && missed_rows == 0 && missed_visits == 0;
    if (metrics.reason.empty() && missed_rows > 0) {
      metrics.reason = fmt::format("{}: {} rows were driven with an error above {} m", plan_.id,
                                   missed_rows, config_.row_tolerance_m);
    } else if (metrics.reason.empty() && missed_visits > 0) {
      metrics.reason =
          fmt::format("{}: {} places were not reached closely enough", plan_.id, missed_visits);
    }
    metrics.energy_j = vehicle_.drawn_j();
  }

  void count_leg(std::size_t i) {
    RunMetrics& metrics = run_.metrics;
    const PlanLeg& leg = plan_.legs[i];
    if (leg.visit >= 0) {
      ++metrics.visits_total;
      metrics.visits_done += run_.leg_done[i] ? 1 : 0;
    }
    if (leg.kind != LegKind::kRow) return;
    // The last row begun when a run breaks off was not driven to its end.
    const bool broken_off = !metrics.reason.empty() && !run_.trace.empty() &&
                            run_.trace.back().leg == static_cast<int>(i);
    run_.leg_done[i] = run_.leg_done[i] && !broken_off && worst_[i] <= config_.row_tolerance_m;
  }

  int number_;
  const VehiclePlan& plan_;
  const std::vector<Visit>& visits_;
  const Farm& farm_;
  const Ground& ground_;
  const SimulationConfig& config_;
  ChargerSlots& slots_;
  SimulatedVehicle vehicle_;
  std::unique_ptr<Tracker> tracker_;
  std::unique_ptr<Estimator> estimator_;
  VehicleEstimate known_;
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
  double progress_s_ = 0.0;  // on the stage's path
  double stage_start_s_ = 0.0;
  double total_length_ = 0.0;
};

// Tracking errors of several vehicles as one sequence; legs numbered on.
TrackingMetrics fleet_tracking(std::span<const VehiclePlan> plans, std::span<const Run> runs) {
  std::vector<PathError> errors;
  std::vector<LegKind> kinds;
  for (std::size_t v = 0; v < runs.size(); ++v) {
    const int offset = static_cast<int>(kinds.size());
    for (const TraceRow& row : runs[v].trace) {
      errors.push_back({row.s_m, row.cross_track_m, std::abs(row.cross_track_m), offset + row.leg});
    }
    for (const PlanLeg& leg : plans[v].legs) kinds.push_back(leg.kind);
  }
  return tracking_metrics(errors, kinds);
}

RunMetrics fleet_metrics(const std::vector<VehiclePlan>& plans, const std::vector<Run>& runs) {
  RunMetrics all;
  all.completed = true;
  for (const Run& run : runs) {
    const RunMetrics& one = run.metrics;
    all.completed = all.completed && one.completed;
    if (all.reason.empty()) all.reason = one.reason;
    all.visits_done += one.visits_done;
    all.visits_total += one.visits_total;
    all.charges += one.charges;
    all.energy_j += one.energy_j;
    all.duration_s = std::max(all.duration_s, one.duration_s);
    all.waited_s += one.waited_s;
    all.min_soc = std::min(all.min_soc, one.min_soc);
    all.reserve_kept = all.reserve_kept && one.reserve_kept;
    all.wrong_gear_count += one.wrong_gear_count;
    all.stale_plan_count += one.stale_plan_count;
  }
  count_rows(plans, runs, all);
  all.tracking = fleet_tracking(plans, runs);
  return all;
}

}  // namespace

std::vector<int> trace_ticks(const std::vector<TraceRow>& trace, double period) {
  std::vector<int> ticks;
  double next = 0.0;
  for (int i = 0; i < static_cast<int>(trace.size()); ++i) {
    const double t = trace[static_cast<std::size_t>(i)].t_s;
    if (i > 0 && i + 1 < static_cast<int>(trace.size()) && t < next) continue;
    ticks.push_back(i);
    next = t + period - 1e-9;
  }
  return ticks;
}

std::vector<FleetTick> fleet_ticks(const FleetRun& run, double period) {
  std::vector<FleetTick> ticks;
  for (std::size_t v = 0; v < run.vehicles.size(); ++v) {
    for (const int tick : trace_ticks(run.vehicles[v].trace, period)) {
      ticks.push_back({v, static_cast<std::size_t>(tick)});
    }
  }
  const auto time = [&run](const FleetTick& t) {
    return run.vehicles[t.vehicle].trace[t.tick].t_s;
  };
  std::stable_sort(ticks.begin(), ticks.end(),
                   [&](const FleetTick& a, const FleetTick& b) { return time(a) < time(b); });
  return ticks;
}

FleetRun drive_fleet(const std::vector<VehiclePlan>& plans, const std::vector<Visit>& visits,
                     const Farm& farm, const Ground& ground, const SimulationConfig& config,
                     const Progress& progress, const Clock* clock) {
  ChargerSlots slots(farm);
  std::vector<Driver> drivers;
  drivers.reserve(plans.size());
  double total = 0.0;
  for (std::size_t v = 0; v < plans.size(); ++v) {
    drivers.emplace_back(static_cast<int>(v), plans[v], visits, farm, ground, config, slots, clock);
    total += drivers.back().total_length();
  }
  const auto all_done = [&] {
    return std::all_of(drivers.begin(), drivers.end(), [](const Driver& d) { return d.done(); });
  };
  double next_progress = 0.0;
  for (long tick = 1; !all_done(); ++tick) {
    const double time = static_cast<double>(tick) * config.step_s;
    for (Driver& driver : drivers) driver.step(time);
    if (!progress || time < next_progress) continue;
    next_progress += kProgressPeriod;
    double driven = 0.0;
    for (const Driver& driver : drivers) driven += driver.driven();
    progress(driven / std::max(total, 1.0), time);
  }
  FleetRun run;
  for (Driver& driver : drivers) run.vehicles.push_back(driver.finish());
  for (std::size_t v = 0; v < plans.size(); ++v) {
    run.vehicles[v].metrics.tracking = fleet_tracking({&plans[v], 1}, {&run.vehicles[v], 1});
  }
  run.metrics = fleet_metrics(plans, run.vehicles);
  return run;
}

}  // namespace headland
