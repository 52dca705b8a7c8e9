// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/ebs221_study.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "sim/lab/ebs221/drive.hpp"
#include "sim/lab/ebs221/figures.hpp"
#include "sim/lab/ebs221/tours.hpp"
#include "sim/lab/metrics.hpp"
#include "sim/lab/statistics.hpp"

namespace headland {
namespace {

constexpr double kEulerStep = 0.001;  // of (002)'s plant [s]

// One drive, measured by the rules that apply.
struct Measured {
  std::optional<TrackingMetrics> by_seed;  // distance to the waypoints' polyline
  std::optional<TrackingMetrics> exact;    // distance to the exact path
};

// Links of a route by kind, the way (002) counts: from and to the depot are turns.
std::vector<LegKind> two_kinds(std::vector<LegKind> kinds) {
  for (LegKind& kind : kinds) kind = kind == LegKind::kRow ? kind : LegKind::kTurn;
  return kinds;
}

// The exact errors are split into rows and turns at the seed's borders (the middle between two
// waypoints), so that both rules speak of the same samples.
Measured measure_seed(const FieldDrive& drive, const SeedRoute& route) {
  const std::vector<LegKind> kinds = seed_kinds(route);
  const std::vector<PathError> errors = seed_errors(drive.positions, route);
  std::vector<PathError> exact = drive.errors;
  for (std::size_t i = 0; i < exact.size(); ++i) exact[i].leg = errors[i].leg;
  return {tracking_metrics(errors, kinds), tracking_metrics(exact, kinds)};
}

void add_rms(StudyCell& cell, const std::string& prefix, const TrackingMetrics& metrics) {
  cell.add(prefix + "overall_rms_m", metrics.overall_rms_m);
  cell.add(prefix + "row_rms_m", metrics.row_rms_m);
  cell.add(prefix + "turn_rms_m", metrics.turn_rms_m);
}

StudyCell cell_of(const std::string& name, const FieldDrive& drive, const Measured& m,
                  const TrackingMetrics& headline) {
  StudyCell cell{name};
  add_rms(cell, "", headline);
  cell.add("max_m", headline.max_m);
  if (m.exact) {
    add_rms(cell, "true_", *m.exact);
    cell.add("true_max_m", m.exact->max_m);
  }
  if (m.by_seed) add_rms(cell, "seed_", *m.by_seed);
  cell.add("wrong_gear_count", drive.wrong_gear_count);
  cell.add("mean_speed_mps", drive.distance / drive.duration);
  cell.add("guided_count", drive.guided_count);
  cell.add("completed_ratio", drive.completed ? 1.0 : 0.0);
  return cell;
}

// (002)'s fishtail table also splits the errors by gear.
void add_gears(const FieldDrive& drive, const std::vector<PathError>& errors, StudyCell& cell) {
  std::vector<PathError> by_gear = errors;
  for (std::size_t i = 0; i < by_gear.size(); ++i) {
    by_gear[i].leg = drive.gears[i] == Gear::kForward ? 0 : 1;
  }
  const LegKind kinds[] = {LegKind::kRow, LegKind::kTurn};
  const TrackingMetrics metrics = tracking_metrics(by_gear, kinds);
  cell.add("forward_rms_m", metrics.row_rms_m);
  cell.add("reverse_rms_m", metrics.turn_rms_m);
  cell.add("reverse_count",
           static_cast<double>(std::count(drive.gears.begin(), drive.gears.end(), Gear::kReverse)));
}

// The same metrics over many drives.
StudyCell merged(const std::string& name, const std::vector<StudyCell>& runs) {
  StudyCell cell{name, static_cast<int>(runs.size())};
  for (std::size_t m = 0; m < runs.front().metrics.size(); ++m) {
    std::vector<double> sample;
    for (const StudyCell& run : runs) sample.push_back(run.metrics[m].second.mean);
    cell.metrics.emplace_back(runs.front().metrics[m].first, summarize(std::move(sample)));
  }
  return cell;
}

class Study {
 public:
  explicit Study(const Ebs221StudyConfig& config) : config_(config) {}

  Result<StudyResult> run() {
    result_.study = "ebs221";
    for (const TurnCosts costs : {TurnCosts::kSeed, TurnCosts::kTrue}) {
      for (const Ebs221Part* part : {&config_.part_d, &config_.part_f}) {
        if (auto added = add_tour(costs, part->planned_steering_deg); !added) {
          return tl::unexpected<Error>(added.error());
        }
      }
    }
    add_seed("D", config_.part_d);
    add_seed("E", config_.part_e);
    add_perturbed("E", config_.part_e);
    add_seed("F", config_.part_f);
    add_seed_fishtail(config_.part_fishtail);
    add_ours("D", config_.part_d, TurnShape::kDubins);
    add_ours("F", config_.part_f, TurnShape::kDubins);
    add_ours("fishtail", config_.part_fishtail, TurnShape::kFishtail);
    add_ours("fishtail_30deg", config_.part_f, TurnShape::kFishtail);
    add_tour_table(result_);
    add_drive_table(result_);
    return std::move(result_);
  }

 private:
  Result<void> add_tour(TurnCosts costs, double steering_deg) {
    const RowTourProblem problem =
        tour_problem(config_.field, config_.field.radius(steering_deg), costs);
    const auto before = std::chrono::steady_clock::now();
    const Result<RowTour> tour = solve_row_tour(problem);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - before;
    if (!tour) return tl::unexpected<Error>(tour.error());
    StudyCell cell{std::string("tour/") + (costs == TurnCosts::kSeed ? "seed/" : "true/") +
                   std::to_string(static_cast<int>(steering_deg)) + "deg"};
    cell.add("cost_m", tour->cost);
    cell.add("planning_s", took.count());
    cell.add("optimal", tour->optimal ? 1.0 : 0.0);
    result_.cells.push_back(std::move(cell));
    return {};
  }

  std::vector<FieldLink> links_of(const Ebs221Part& part) const {
    return field_links(config_.field, alternating_order(part.rows, true));
  }
  SeedRoute route_of(const Ebs221Part& part) const {
    return seed_route(links_of(part), config_.field.radius(part.planned_steering_deg),
                      0.5 * config_.field.row_length_m);
  }
  FieldPath path_of(const Ebs221Part& part, TurnShape shape) const {
    return field_path(links_of(part), config_.field.radius(part.planned_steering_deg), shape);
  }

  SeedPurePursuitConfig follower(const Ebs221Part& part) const {
    SeedPurePursuitConfig controller;
    controller.wheelbase_m = config_.wheelbase_m;
    controller.max_steering_deg = part.max_steering_deg;
    controller.lookahead_line_m = part.lookahead_line_m;
    controller.lookahead_turn_m = part.lookahead_turn_m;
    return controller;
  }
  SeedPlant plant() const {
    SeedPlant plant;
    plant.speed_mps = config_.speed_mps;
    plant.period_s = config_.period_s;
    plant.euler_steps = std::max(1, static_cast<int>(std::lround(config_.period_s / kEulerStep)));
    return plant;
  }
  FieldDrive drive_seed(const Ebs221Part& part, const SeedRoute& route, const Path& path) const {
    return drive_seed_field(plant(), follower(part), route, path, config_.field.depot());
  }

  void add_seed(const std::string& name, const Ebs221Part& part) {
    const SeedRoute route = route_of(part);
    const FieldPath exact = path_of(part, TurnShape::kDubins);
    const FieldDrive drive = drive_seed(part, route, exact.path);
    const Measured m = measure_seed(drive, route);
    result_.cells.push_back(cell_of("track/seed/" + name, drive, m, *m.by_seed));
    add_drive_plots("track/seed/" + name, drive, exact.path, result_);
  }

  // (002) counts a fishtail's link as a turn; its errors are to the waypoints' polyline alone.
  void add_seed_fishtail(const Ebs221Part& part) {
    const std::vector<FieldLink> links = links_of(part);
    const double radius = config_.field.radius(part.planned_steering_deg);
    const SeedRoute route =
        seed_route(links, radius, 0.5 * config_.field.row_length_m, TurnShape::kFishtail);
    std::vector<bool> fishtails;
    for (const FieldLink& link : links) fishtails.push_back(seed_fishtails(link, radius));
    FieldDrive drive =
        drive_seed_fishtail(plant(), follower(part), route, fishtails, config_.field.depot());
    drive.errors = seed_errors(drive.positions, route);
    Measured m;
    m.by_seed = tracking_metrics(drive.errors, seed_kinds(route));
    StudyCell cell = cell_of("track/seed/fishtail", drive, m, *m.by_seed);
    add_gears(drive, drive.errors, cell);
    add_drive_plots(cell.name, drive, path_of(part, TurnShape::kFishtail).path, result_);
    result_.cells.push_back(std::move(cell));
  }

  // Waypoints off by less than any rounding of them that matters to a farmer.
  void add_perturbed(const std::string& name, const Ebs221Part& part) {
    const SeedRoute route = route_of(part);
    const FieldPath exact = path_of(part, TurnShape::kDubins);
    const std::string key = "track/seed/" + name + "/perturbed";
    RandomStream errors(static_cast<std::uint64_t>(config_.seed), "ebs221/waypoints");
    std::vector<StudyCell> runs;
    for (int i = 0; i < config_.runs_count; ++i) {
      SeedRoute moved = route;
      for (Point2& p : moved.points) {
        p.x() += config_.waypoint_error_m * errors.uniform(-1.0, 1.0);
        p.y() += config_.waypoint_error_m * errors.uniform(-1.0, 1.0);
      }
      const FieldDrive drive = drive_seed(part, moved, exact.path);
      const Measured m = measure_seed(drive, moved);
      runs.push_back(cell_of(key, drive, m, *m.by_seed));
    }
    result_.cells.push_back(merged(key, runs));
  }

  Vehicle vehicle(const Ebs221Part& part) const {
    Vehicle v;
    v.wheelbase_m = config_.wheelbase_m;
    v.max_steering_deg = part.max_steering_deg;
    v.min_turning_radius_m = config_.field.radius(part.planned_steering_deg);
    v.steering_rate_radps = config_.steering_rate_radps;
    v.work_speed_mps = v.transit_speed_mps = v.turn_speed_mps = config_.speed_mps;
    v.acceleration_mps2 = config_.acceleration_mps2;
    return v;
  }

  // On the same rows in the same order as the seed, at the same speed.
  void add_ours(const std::string& name, const Ebs221Part& part, TurnShape shape) {
    const FieldPath plan = path_of(part, shape);
    const Reference reference{plan.path, std::vector<double>(plan.kinds.size(), config_.speed_mps)};
    const Vehicle tractor = vehicle(part);
    PurePursuit tracker(tractor, config_.tracker);
    const FieldDrive drive = drive_our_field(tracker, tractor, reference, config_.period_s);
    Measured m;
    m.exact = tracking_metrics(drive.errors, two_kinds(plan.kinds));
    if (shape == TurnShape::kDubins) {
      const SeedRoute route = route_of(part);
      m.by_seed = tracking_metrics(seed_errors(drive.positions, route), seed_kinds(route));
    }
    result_.cells.push_back(cell_of("track/ours/" + name, drive, m, *m.exact));
    add_drive_plots("track/ours/" + name, drive, plan.path, result_);
  }

  const Ebs221StudyConfig& config_;
  StudyResult result_;
};

}  // namespace

std::optional<Error> Ebs221StudyConfig::check() const {
  const std::pair<const char*, const Ebs221Part*> parts[] = {{"part_d", &part_d},
                                                             {"part_e", &part_e},
                                                             {"part_f", &part_f},
                                                             {"part_fishtail", &part_fishtail}};
  for (const auto& [name, part] : parts) {
    std::vector<int> sorted = part->rows;
    std::sort(sorted.begin(), sorted.end());
    std::vector<int> all(static_cast<std::size_t>(field.rows_count));
    std::iota(all.begin(), all.end(), 1);
    if (sorted == all) continue;
    return Error{ErrorCode::kOutOfRange,
                 "the order of work does not name every row once",
                 "list the numbers 1 to field.rows_count, each once",
                 {{}, 0, std::string(name) + ".rows"}};
  }
  return std::nullopt;
}

Result<StudyResult> run_ebs221_study(const Ebs221StudyConfig& config) {
  if (auto error = config.check()) return tl::unexpected<Error>(*error);
  return Study(config).run();
}

}  // namespace headland
