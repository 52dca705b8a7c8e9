// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/run/plan_driver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sim/lab/run/run_metrics.hpp"

namespace headland {
namespace {

// Window of the path in which the true position is projected, around the tracker's progress [m].
constexpr double kWindow = 3.0;
// Nearer to a cusp than this, the vehicle is on it [m].
constexpr double kOnCusp = 1e-6;
// Slower counts as standing [m/s]: a drive with a lag never quite stands.
constexpr double kStill = 1e-3;
// To where the local planner drives: the end of a stretch of one gear [m].
constexpr double kPlaceAccuracy = 0.3;
constexpr double kStands = 0.05;  // the local planner creeps at less [m/s]
// Nearer than this to the end of such a stretch, or of a leg, the path is not left [m]; nor within
// rows and headland turns, where there is no room: there the vehicle waits.
constexpr double kNoLeavingBefore = 5.0;
constexpr double kReplanPeriod = 60.0;  // [s]
constexpr int kReplanPlaces = 4;
constexpr double kReplanSpacing = 2.0;  // of places on the path to plan anew from [m]

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

// With the estimator that this vehicle has.
ControlConfig control_of(const Vehicle& vehicle, const SimulationConfig& config) {
  ControlConfig control = config.control;
  control.estimator = estimator_for(vehicle, control, config.perception);
  return control;
}

// Whether the plan has any row or visit.
bool works(const VehiclePlan& plan) {
  return std::any_of(plan.legs.begin(), plan.legs.end(), [](const PlanLeg& leg) {
    return leg.kind == LegKind::kRow || leg.visit >= 0;
  });
}

}  // namespace

PlanDriver::PlanDriver(int number, const VehiclePlan& plan, const std::vector<Visit>& visits,
                       const Farm& farm, const Ground& ground, const SimulationConfig& config,
                       ChargerSlots& slots, const ClearanceMap* obstacles,
                       const PredictorFactory& predictor, const LidarScene* scene,
                       const RunHooks& hooks)
    : number_(number),
      control_(control_of(plan.vehicle, config)),
      given_(plan),
      plan_(plan),
      visits_(visits),
      farm_(farm),
      ground_(ground),
      config_(config),
      slots_(slots),
      vehicle_(plan.vehicle, plan.start, plan.start_soc, {config.sensors, config.slip},
               config.seed + static_cast<std::uint64_t>(number), config.step_s, ground),
      tracker_(make_tracker(plan.vehicle, control_, config.sensors, config.step_s, hooks.clock)),
      senses_(plan.vehicle, control_, config.perception, scene, config.step_s,
              config.seed + static_cast<std::uint64_t>(number)),
      hooks_(hooks) {
  if (obstacles != nullptr) {
    local_ = std::make_unique<LocalLayer>(plan.vehicle, config.local, predictor, *obstacles,
                                          config.seed + static_cast<std::uint64_t>(number),
                                          config.step_s);
  }
  fit_to_legs();
  senses_.begin(vehicle_.truth());
  begin_stage(0.0);
}

void PlanDriver::step(double time, std::span<const Agent> agents) {
  agents_ = agents;
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

void PlanDriver::count(std::span<const Agent> agents) {
  if (local_ != nullptr && state_ != State::kDone) local_->count(vehicle_.truth(), agents);
}

void PlanDriver::stop(double time) {
  if (!done()) give_up("it was stopped", time);
}

Run PlanDriver::finish() {
  run_.driven = std::move(plan_);
  summarise();
  return std::move(run_);
}

// Sizes what is kept leg by leg.
void PlanDriver::fit_to_legs() {
  run_.leg_done.resize(plan_.legs.size(), false);
  worst_.resize(plan_.legs.size(), 0.0);
  leg_speed_.clear();
  leg_working_.clear();
  for (const PlanLeg& leg : plan_.legs) {
    leg_speed_.push_back(leg_speed(plan_.vehicle, leg.kind));
    leg_working_.push_back(leg.kind == LegKind::kRow);
  }
  total_length_ = 0.0;
  for (const PlanStage& stage : plan_.stages) total_length_ += stage.path.length();
}

void PlanDriver::begin_stage(double time) {
  if (stage_ >= plan_.stages.size()) {
    state_ = State::kDone;
    run_.metrics.duration_s = time;
    return;
  }
  if (stage().path.empty()) {
    reference_ = {};
    return arrive(time);
  }
  // Nothing drives a stage at less than a tenth of its planned pace.
  give_up_at_ = time + 60.0 + 10.0 * planned_duration(stage());
  follow(stage().path, time);
}

// Starts the tracker on a path: a stage's, or what is left of it.
void PlanDriver::follow(const Path& path, double time) {
  progress_s_ = 0.0;
  reached_s_ = 0.0;
  reference_ = Reference{path, leg_speed_, {}, leg_working_};  // the tracker points to it
  reference_.zones = energy_zones(reference_, plan_.vehicle, control_.limits, ground_);
  if (const auto started = tracker_->start(reference_); !started) {
    return give_up(started.error().what, time);
  }
  state_ = State::kDriving;
}

// What the vehicle knows of itself at `time` [s], at a stand too.
void PlanDriver::observe(double time) {
  const bool driving = state_ == State::kDriving;
  senses_.step(time, vehicle_, told_, agents_, !driving);
  if (!driving) return;
  const int leg = reference_.path.at(reached_s_).leg;
  senses_.look_at_row(time, vehicle_.truth().pose, reference_.path, reached_s_, leg,
                      row_width(plan_.legs[static_cast<std::size_t>(leg)]));
}

// Between the plants beside a row; 0 where the leg is none.
double PlanDriver::row_width(const PlanLeg& leg) const {
  if (leg.kind != LegKind::kRow) return 0.0;
  for (const RowRef& ref : farm_.all_rows()) {
    if (farm_.row_name(ref) == leg.id) {
      return farm_.row_parcels[static_cast<std::size_t>(ref.parcel)].row_spacing_m;
    }
  }
  return 0.0;
}

void PlanDriver::drive(double time) {
  LocalOutput local;
  if (local_ != nullptr) {
    local = local_->step(time - config_.step_s, senses_.known(), local_goal(), local_view(time),
                         agents_);
    if (local.gave_back && !take_up_path(time)) return;
  }
  const Point2 before = vehicle_.truth().pose.position();
  if (local.driving == Driving::kLocal) {
    told_ = local.command;
    reached_s_ = nearest_s();
    if (at_stage_end()) return arrive(time);
  } else {
    const TrackOutput output = tracker_->step(senses_.known(), config_.step_s);
    told_ = local_ != nullptr ? local_->guard(output.command) : output.command;
    reached_s_ = output.s;
    if (output.stale) ++run_.metrics.stale_plan_count;
    if (output.status == TrackStatus::kDone && std::abs(vehicle_.truth().speed) < kStill) {
      return arrive(time);
    }
    if (failed(output.status)) return give_up(describe(output.status), time);
  }
  if (senses_.lost_for() > config_.max_lost_s) return give_up("its pose is not known", time);
  if (senses_.lost_for() > 0.0) told_ = {};  // it stands until it knows where it is
  const int leg = reference_.path.at(reached_s_).leg;
  vehicle_.step(told_, plan_.legs[static_cast<std::size_t>(leg)].kind);
  record(before, local.driving, time);
  if (local.driving == Driving::kPath &&
      std::abs(run_.trace.back().cross_track_m) > config_.max_deviation_m) {
    return give_up("the vehicle left its path", time);
  }
  if (vehicle_.soc() <= 0.0) return give_up("the battery is empty", time);
  if (time > give_up_at_) return give_up("the vehicle does not get on", time);
  const int now = run_.trace.back().leg;
  if (local_ != nullptr && local.driving == Driving::kPath && now != checked_leg_ &&
      may_replan(time)) {
    checked_leg_ = now;
    check_reserve(time);
  }
}

// What the local planner drives to: along the path, as far as its next cusp.
LocalGoal PlanDriver::local_goal() const {
  const Path& path = reference_.path;
  const PathSample at = path.at(reached_s_);
  const PathSegment& segment = path.segments()[static_cast<std::size_t>(at.segment)];
  LocalGoal goal;
  goal.path = &path;
  goal.s = reached_s_;
  goal.place = path.at(segment.end_s - kOnCusp).pose.position();
  goal.place_s = segment.end_s;
  goal.accuracy_m = kPlaceAccuracy;
  goal.speed_mps = leg_speed_[static_cast<std::size_t>(at.leg)];
  return goal;
}

ArbiterView PlanDriver::local_view(double time) {
  const PathSample at = reference_.path.at(reached_s_);
  const PathSegment& segment = reference_.path.segments()[static_cast<std::size_t>(at.segment)];
  ArbiterView view;
  const LegKind kind = plan_.legs[static_cast<std::size_t>(at.leg)].kind;
  const double end = std::min(segment.end_s, reference_.path.leg_range(at.leg).second);
  view.may_leave = kind != LegKind::kRow && kind != LegKind::kTurn && at.gear == Gear::kForward &&
                   end - reached_s_ > kNoLeavingBefore;
  if (time >= spare_until_) {
    spare_ratio_ = spare() / plan_.vehicle.battery.capacity_j();
    spare_until_ = time + 1.0;
  }
  view.spare_ratio = spare_ratio_;
  return view;
}

// Progress of a vehicle that is not on the path: never back, never across a cusp.
double PlanDriver::nearest_s() const {
  const Path& path = reference_.path;
  const PathSegment& segment =
      path.segments()[static_cast<std::size_t>(path.at(reached_s_).segment)];
  const double ahead = std::min(reached_s_ + kWindow, segment.end_s - kOnCusp);
  return path
      .project(senses_.known().state.pose.position(), reached_s_, std::max(reached_s_, ahead))
      .s;
}

// The local planner has brought the vehicle to where it stops.
bool PlanDriver::at_stage_end() const {
  const Path& path = reference_.path;
  const VehicleState& state = senses_.known().state;
  return path.length() - reached_s_ < kPlaceAccuracy && std::abs(state.speed) < kStands &&
         (path.end_pose().position() - state.pose.position()).norm() < kPlaceAccuracy;
}

// Gives the tracker the rest of the path. False if nothing is left of it, or the tracker cannot.
bool PlanDriver::take_up_path(double time) {
  const double s = nearest_s();
  stage_start_s_ += s;
  const Path rest = reference_.path.slice(s, reference_.path.length());
  if (rest.empty()) {
    reference_ = {};
    arrive(time);
    return false;
  }
  follow(rest, time);
  checked_leg_ = -1;
  return state_ == State::kDriving;
}

double PlanDriver::spare() const {
  const int leg = reference_.path.at(reached_s_).leg;
  const auto [begin, end] = reference_.path.leg_range(leg);
  const double done = end > begin ? (reached_s_ - begin) / (end - begin) : 0.0;
  return spare_energy(plan_, {leg, done}, vehicle_.soc());
}

// Not within rows, nor soon after the last time.
bool PlanDriver::may_replan(double time) const {
  if (!hooks_.replan || time < replan_from_) return false;
  const int leg = reference_.path.at(reached_s_).leg;
  return plan_.legs[static_cast<std::size_t>(leg)].kind != LegKind::kRow;
}

// Plans what is left anew if the charge will not last. From a little farther along the path if
// there is no way from here, as at a row's end.
void PlanDriver::check_reserve(double time) {
  if (spare() >= 0.0) return;
  const int leg = reference_.path.at(reached_s_).leg;
  replan_from_ = time + kReplanPeriod;
  const double end = reference_.path.leg_range(leg).second;
  for (int i = 0; i < kReplanPlaces; ++i) {
    const double ahead = i * kReplanSpacing;
    if (ahead > 0.0 && reached_s_ + ahead > end) break;
    const Pose2 pose =
        ahead > 0.0 ? reference_.path.at(reached_s_ + ahead).pose : senses_.known().state.pose;
    auto anew = hooks_.replan(static_cast<std::size_t>(number_), plan_,
                              {pose, vehicle_.soc(), time, leg + 1});
    if (!anew || !works(*anew)) continue;
    ++run_.metrics.replans;
    return go_on_by(std::move(*anew), leg + 1, ahead, time);
  }
  ++run_.metrics.failed_replans;
}

// `ahead` [m] from here on another plan is driven; its legs follow on those so far.
void PlanDriver::go_on_by(VehiclePlan anew, int first_leg, double ahead, double time) {
  stage_start_s_ += reached_s_;
  plan_.stages.resize(stage_ + 1);
  double before = 0.0;
  for (std::size_t i = 0; i < stage_; ++i) before += plan_.stages[i].path.length();
  Path& under_way = plan_.stages.back().path;
  under_way = under_way.slice(0.0, stage_start_s_ + ahead - before);
  plan_.stages.back().stop_leg = -1;
  for (const PlanStage& stage : anew.stages) {
    PlanStage& added = plan_.stages.emplace_back();
    added.path.append(stage.path, first_leg);
    added.stop_leg = stage.stop_leg < 0 ? -1 : stage.stop_leg + first_leg;
  }
  plan_.legs.resize(static_cast<std::size_t>(first_leg));
  for (PlanLeg& leg : anew.legs) {
    leg.begin_s += time;
    leg.earliest_s += leg.earliest_s > 0.0 ? time : 0.0;
    plan_.legs.push_back(std::move(leg));
  }
  plan_.energy_j = 0.0;
  for (const PlanLeg& leg : plan_.legs) plan_.energy_j += leg.cost.energy_j;
  plan_.finish_s = time + anew.finish_s;
  fit_to_legs();
  if (ahead > 0.0) return follow(reference_.path.slice(reached_s_, reached_s_ + ahead), time);
  ++stage_;
  begin_stage(time);
}

// At the stage's end: stand in the queue of a charger, at a visit, or go on.
void PlanDriver::arrive(double time) {
  stage_start_s_ += reference_.path.length();
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

void PlanDriver::begin_charge(double time) {
  run_.metrics.waited_s += time - arrived_;
  ++run_.metrics.charges;
  until_ = time + vehicle_.charge(
                      lower(slots_.charger(charger_).curve, plan_.vehicle.battery.acceptance()),
                      stop().soc_end);
  state_ = State::kStanding;
}

void PlanDriver::end_stop(double time) {
  if (stop().kind == LegKind::kCharge) slots_.leave(charger_, number_);
  run_.leg_done[static_cast<std::size_t>(stage().stop_leg)] =
      stop().visit < 0 || visited(visits_[static_cast<std::size_t>(stop().visit)]);
  ++stage_;
  begin_stage(time);
}

// Whether the vehicle stands near enough to the poi, and not too late.
bool PlanDriver::visited(const Visit& visit) const {
  const Poi& poi = farm_.pois[static_cast<std::size_t>(visit.poi)];
  const Point2 off = vehicle_.truth().pose.position() - poi.pose.position();
  return off.norm() <= visit.accuracy_m && arrived_ <= visit.terms.latest_s;
}

double PlanDriver::planned_duration(const PlanStage& driven) const {
  double duration = 0.0;
  for (const PathPiece& piece : driven.path.pieces()) {
    duration += piece.length / leg_speed_[static_cast<std::size_t>(piece.leg)];
  }
  return duration + 10.0 * static_cast<double>(driven.path.segments().size());
}

// Projects the true position onto the path around the vehicle's progress, never across a cusp
// (the path runs back on itself there), and appends a trace row.
void PlanDriver::record(const Point2& before, Driving driving, double time) {
  const Path& path = reference_.path;
  const VehicleState& truth = vehicle_.truth();
  // On a cusp the tracker is still on the segment that ends there.
  const double s = std::max(0.0, reached_s_ - kOnCusp);
  const PathSegment& segment = path.segments()[static_cast<std::size_t>(path.at(s).segment)];
  const Projection projection =
      path.project(truth.pose.position(), std::max(segment.begin_s, reached_s_ - kWindow),
                   std::min(segment.end_s, reached_s_ + kWindow));
  const PathSample at = path.at(std::min(projection.s, segment.end_s - 1e-9));
  progress_s_ = projection.s;
  run_.trace.push_back({time, truth.pose.x, truth.pose.y, truth.pose.yaw, truth.speed,
                        truth.steering, told_.yaw_rate, stage_start_s_ + projection.s,
                        projection.lateral_error, vehicle_.soc(), at.gear, at.leg, vehicle_.slip(),
                        senses_.known().slip,
                        (senses_.known().state.pose.position() - before).norm(), driving});
  const auto leg = static_cast<std::size_t>(at.leg);
  worst_[leg] = std::max(worst_[leg], std::abs(projection.lateral_error));
  run_.leg_done[leg] = true;
  if (driving == Driving::kPath && truth.speed * sign(at.gear) < -1e-3) {
    ++run_.metrics.wrong_gear_count;
  }
  run_.metrics.min_soc = std::min(run_.metrics.min_soc, vehicle_.soc());
}

void PlanDriver::give_up(const std::string& why, double time) {
  const bool moved = !run_.trace.empty();
  const int leg = moved ? run_.trace.back().leg : 0;
  run_.metrics.reason = fmt::format("{}: {} after {:.1f} m, on leg '{}'", plan_.id, why,
                                    moved ? run_.trace.back().s_m : 0.0,
                                    plan_.legs[static_cast<std::size_t>(leg)].id);
  run_.metrics.duration_s = time;
  state_ = State::kDone;
}

void PlanDriver::summarise() {
  RunMetrics& metrics = run_.metrics;
  if (local_ != nullptr) metrics.encounters = local_->metrics();
  metrics.rows_seen = senses_.rows_seen();
  for (std::size_t i = 0; i < run_.driven.legs.size(); ++i) count_leg(i);
  for (const PlanLeg& leg : given_.legs) count_dropped(leg);
  count_rows({&given_, 1}, {&run_, 1}, metrics);
  const double reserve = given_.vehicle.battery.reserve_soc;
  metrics.reserve_kept = metrics.min_soc >= reserve - 1e-9;
  if (metrics.reason.empty() && !metrics.reserve_kept) {
    metrics.reason = fmt::format("{}: the charge fell to {:.1f} %, below the reserve of {:.1f} %",
                                 given_.id, 100.0 * metrics.min_soc, 100.0 * reserve);
  }
  if (metrics.reason.empty() && metrics.duration_s > given_.shift_s) {
    metrics.reason = fmt::format("{}: it was back {:.0f} s after its shift of {:.0f} s", given_.id,
                                 metrics.duration_s - given_.shift_s, given_.shift_s);
  }
  const int missed_rows = metrics.rows_total - metrics.rows_done;
  const int missed_visits = metrics.visits_total - metrics.visits_done;
  metrics.completed = metrics.reason.empty() && missed_rows == 0 && missed_visits == 0;
  const int replans = metrics.replans;
  if (metrics.reason.empty() && replans > 0 && missed_rows + missed_visits > 0) {
    metrics.reason = fmt::format(
        "{}: {} rows and {} places were left out when the rest was planned anew, as the charge "
        "would not have lasted",
        given_.id, missed_rows, missed_visits);
  }
  if (metrics.reason.empty() && missed_rows > 0) {
    metrics.reason = fmt::format("{}: {} rows were driven with an error above {} m", given_.id,
                                 missed_rows, config_.row_tolerance_m);
  } else if (metrics.reason.empty() && missed_visits > 0) {
    metrics.reason =
        fmt::format("{}: {} places were not reached closely enough", given_.id, missed_visits);
  }
  metrics.energy_j = vehicle_.drawn_j();
}

void PlanDriver::count_leg(std::size_t i) {
  RunMetrics& metrics = run_.metrics;
  const PlanLeg& leg = run_.driven.legs[i];
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

// A visit that a new plan no longer holds.
void PlanDriver::count_dropped(const PlanLeg& planned) {
  if (planned.visit < 0) return;
  const auto& legs = run_.driven.legs;
  const bool kept = std::any_of(legs.begin(), legs.end(),
                                [&](const PlanLeg& leg) { return leg.visit == planned.visit; });
  if (!kept) ++run_.metrics.visits_total;
}

}  // namespace headland
