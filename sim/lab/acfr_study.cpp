// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/acfr_study.hpp"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "core/base/clock.hpp"
#include "core/config/yaml.hpp"
#include "sim/lab/acfr/tables.hpp"
#include "sim/lab/episode_row.hpp"
#include "sim/lab/film.hpp"
#include "sim/lab/parallel.hpp"
#include "sim/lab/repeats.hpp"
#include "sim/lab/statistics.hpp"

namespace headland {
namespace {

// A line of episodes.csv: a waypoint, an interaction, a sample of the displacement, or the whole
// iteration. What does not belong to its kind is 0.
struct LogRow {
  double kind_count = 0.0;  // Kind
  double time_s = 0.0;      // waypoint: until reached or given up; sample, iteration: since start
  double distance_m = 0.0;  // waypoint: straight; interaction: least; sample: displacement;
                            // iteration: driven
  double reached_count = 0.0;
  double near_count = 0.0;
  double robot_near_count = 0.0;
  double contact_count = 0.0;
  double robot_contact_count = 0.0;
  double standing_s = 0.0;
  double longest_stand_s = 0.0;

  template <class V>
  void visit(V& v) {
    v("kind_count", kind_count);
    v("time_s", time_s);
    v("distance_m", distance_m);
    v("reached_count", reached_count);
    v("near_count", near_count);
    v("robot_near_count", robot_near_count);
    v("contact_count", contact_count);
    v("robot_contact_count", robot_contact_count);
    v("standing_s", standing_s);
    v("longest_stand_s", longest_stand_s);
  }
};
enum Kind { kVisit = 0, kInteraction = 1, kSample = 2, kIteration = 3 };

struct Cell {
  LocalPlannerKind planner;
  bool dense;
  double accuracy_m;

  std::string density() const {
    return fmt::format("{}/{}", config::enum_name(planner), dense ? "dense" : "sparse");
  }
  std::string name() const { return fmt::format("{}/{}m", density(), accuracy_m); }
};

std::vector<Cell> cells_of(const AcfrStudyConfig& config) {
  std::vector<Cell> cells;
  for (const LocalPlannerKind planner : config.planners) {
    for (const bool dense : {true, false}) {
      for (const double accuracy : config.accuracies_m) cells.push_back({planner, dense, accuracy});
    }
  }
  return cells;
}

std::uint64_t seed_of(const AcfrStudyConfig& config, int run) {
  return fnv1a(fmt::format("acfr/{}/{}", config.seed, run));
}

// All tours of the study, the same for all cells; planned beforehand.
class Tours {
 public:
  static Result<Tours> plan(const AcfrStudyConfig& config, int jobs) {
    Tours tours;
    const int scenarios = (config.runs_count + config.tours_count - 1) / config.tours_count;
    tours.all_.resize(static_cast<std::size_t>(config.runs_count));
    std::vector<std::optional<Error>> errors(static_cast<std::size_t>(scenarios));
    parallel_for(scenarios, jobs, [&](int scenario) {
      errors[static_cast<std::size_t>(scenario)] = tours.plan_scenario(config, scenario);
    });
    for (const auto& error : errors) {
      if (error) return tl::unexpected<Error>(*error);
    }
    return tours;
  }
  const AcfrTour& of(int run) const { return all_[static_cast<std::size_t>(run)]; }

 private:
  std::optional<Error> plan_scenario(const AcfrStudyConfig& config, int scenario) {
    const auto site = AcfrSite::build(config.site, config.vehicle,
                                      static_cast<std::uint64_t>(config.seed + scenario));
    if (!site) return site.error();
    const int first = scenario * config.tours_count;
    for (int run = first; run < std::min(first + config.tours_count, config.runs_count); ++run) {
      auto tour = site->tour(seed_of(config, run));
      if (!tour) return tour.error();
      all_[static_cast<std::size_t>(run)] = std::move(*tour);
    }
    return std::nullopt;
  }

  std::vector<AcfrTour> all_;
};

AcfrOutcome drive(const AcfrStudyConfig& config, const PredictorFactory& predictor,
                  const Cell& cell, const AcfrTour& tour, int run, const Clock* clock, Film* film) {
  AcfrDrive episode;
  episode.tour = &tour;
  episode.world = &config.world;
  episode.vehicle = config.vehicle;
  episode.density_m2 = cell.dense ? config.dense_m2 : config.sparse_m2;
  episode.accuracy_m = cell.accuracy_m;
  episode.budget.iterations = config.iterations_count;
  episode.seed = seed_of(config, run);
  episode.clock = clock;
  episode.film = film;
  const auto planner = make_local_planner(cell.planner, config.local, config.vehicle, predictor);
  return drive_acfr(episode, *planner);
}

Episode rows_of(AcfrOutcome outcome) {
  Episode result;
  const auto add = [&](LogRow row) { result.rows.push_back(to_row(row)); };
  const auto flag = [](bool value) { return value ? 1.0 : 0.0; };
  for (const AcfrVisit& v : outcome.visits) add({kVisit, v.time_s, v.distance_m, flag(v.reached)});
  for (const AcfrInteraction& i : outcome.interactions) {
    add({kInteraction, 0.0, i.least_m, 0.0, flag(i.near), flag(i.robot_fault), flag(i.contact),
         flag(i.robot_contact)});
  }
  for (const auto& [time, off] : outcome.displacements) add({kSample, time, off});
  add({kIteration, outcome.duration_s, outcome.length_m, 0.0, 0.0, 0.0, 0.0, 0.0,
       outcome.standing_s, outcome.longest_stand_s});
  result.plan_ms = std::move(outcome.plan_ms);
  return result;
}

bool of_visit(const LogRow& row) { return static_cast<int>(row.kind_count) == kVisit; }

// Whether a row of an episode is so.
FilmReason when(std::string what, const std::function<bool(const LogRow&)>& so) {
  return {std::move(what), [so](const Episode& episode) {
            return std::any_of(episode.rows.begin(), episode.rows.end(),
                               [&](const auto& values) { return so(from_row<LogRow>(values)); });
          }};
}

std::vector<Film> films_of(const AcfrStudyConfig& config, const PredictorFactory& predictor,
                           const std::vector<Cell>& cells, const Tours& tours,
                           const std::vector<std::vector<Episode>>& episodes, const StudyRun& run) {
  const std::vector<FilmReason> reasons = {
      when("a waypoint was given up",
           [](const LogRow& r) { return of_visit(r) && r.reached_count == 0.0; }),
      when("a contact by the robot's doing",
           [](const LogRow& r) { return r.robot_contact_count > 0.0; }),
      when("a waypoint took longer than the shorter timeout",
           [limit = config.short_timeout_s](const LogRow& r) {
             return of_visit(r) && r.time_s > limit;
           }),
      when("a near-collision by the robot's doing",
           [](const LogRow& r) { return r.robot_near_count > 0.0; }),
      when("a near-collision", [](const LogRow& r) { return r.near_count > 0.0; })};
  std::vector<std::string> planners;
  for (const Cell& cell : cells) planners.emplace_back(config::enum_name(cell.planner));
  const auto chosen = choose_films(episodes, planners, reasons, run.films_count);
  std::vector<Film> films(chosen.size());
  parallel_for(static_cast<int>(chosen.size()), run.jobs, [&](int i) {
    const auto& [key, why] = chosen[static_cast<std::size_t>(i)];
    const Cell& cell = cells[static_cast<std::size_t>(key.cell)];
    Film& film = films[static_cast<std::size_t>(i)];
    film.name = fmt::format("{}, iteration {}", cell.name(), key.run + 1);
    film.note = why;
    drive(config, predictor, cell, tours.of(key.run), key.run, nullptr, &film);
  });
  return films;
}

// Metrics of a cell from its rows.
class Summary {
 public:
  explicit Summary(const AcfrStudyConfig& config) : short_s_(config.short_timeout_s) {}

  void add(const Episode& episode) {
    for (const auto& values : episode.rows) add(from_row<LogRow>(values));
    plan_ms_.insert(plan_ms_.end(), episode.plan_ms.begin(), episode.plan_ms.end());
  }

  StudyCell cell(std::string name) const {
    StudyCell cell{std::move(name), visits_};
    const auto share = [&](const char* metric, int hits, int count) {
      if (count > 0) cell.metrics.emplace_back(metric, proportion(hits, count));
    };
    const auto sample = [&](const char* metric, const std::vector<double>& values) {
      if (!values.empty()) cell.metrics.emplace_back(metric, summarize(values));
    };
    share("fail_1min", failed_short_, visits_);
    share("fail_5min", failed_, visits_);
    const int met = static_cast<int>(least_.size());
    share("near_collision", near_, met);
    share("robot_near", robot_near_, met);
    share("contact", contact_, met);
    share("robot_fault_contact", robot_contact_, met);
    sample("least_m", least_);
    if (!least_.empty()) cell.add("least_cvar5_m", cvar5(least_));
    sample("displacement_m", displacement_);
    sample("speed_mps", speed_);
    sample("standing_ratio", standing_);
    sample("longest_stand_s", longest_stand_);
    if (!plan_ms_.empty()) {
      Statistic statistic = summarize(plan_ms_);
      statistic.p99 = quantile(plan_ms_, 0.99);
      cell.metrics.emplace_back("plan_ms", statistic);
    }
    return cell;
  }

 private:
  void add(const LogRow& row) {
    switch (static_cast<int>(row.kind_count)) {
      case kVisit:
        ++visits_;
        if (row.reached_count == 0.0) ++failed_;
        if (row.reached_count == 0.0 || row.time_s > short_s_) ++failed_short_;
        if (row.reached_count > 0.0) speed_.push_back(row.distance_m / row.time_s);
        break;
      case kInteraction:
        least_.push_back(row.distance_m);
        near_ += static_cast<int>(row.near_count);
        robot_near_ += static_cast<int>(row.robot_near_count);
        contact_ += static_cast<int>(row.contact_count);
        robot_contact_ += static_cast<int>(row.robot_contact_count);
        break;
      case kSample:
        displacement_.push_back(row.distance_m);
        break;
      default:
        standing_.push_back(row.standing_s / row.time_s);
        longest_stand_.push_back(row.longest_stand_s);
        break;
    }
  }

  double short_s_;
  int visits_ = 0;
  int failed_ = 0;
  int failed_short_ = 0;
  int near_ = 0;
  int robot_near_ = 0;
  int contact_ = 0;
  int robot_contact_ = 0;
  std::vector<double> least_;
  std::vector<double> displacement_;
  std::vector<double> speed_;
  std::vector<double> standing_;
  std::vector<double> longest_stand_;
  std::vector<double> plan_ms_;
};

StudyResult result_of(const AcfrStudyConfig& config, const std::vector<Cell>& cells,
                      const std::vector<std::vector<Episode>>& episodes) {
  StudyResult result{config.study};
  std::vector<StudyCell> over_accuracies;
  for (std::size_t c = 0; c < cells.size();) {
    Summary all(config);
    const std::string density = cells[c].density();
    for (; c < cells.size() && cells[c].density() == density; ++c) {
      Summary one(config);
      for (const Episode& episode : episodes[c]) {
        one.add(episode);
        all.add(episode);
      }
      result.cells.push_back(one.cell(cells[c].name()));
    }
    over_accuracies.push_back(all.cell(density));
  }
  result.cells.insert(result.cells.end(), over_accuracies.begin(), over_accuracies.end());
  add_acfr_tables(result);
  return result;
}

}  // namespace

std::optional<Error> AcfrStudyConfig::check() const {
  if (auto error = check_repeats(planners, "planners")) return error;
  return check_repeats(accuracies_m, "accuracies_m");
}

Result<StudyResult> run_acfr_study(const AcfrStudyConfig& config, const StudyRun& run) {
  if (auto error = config.check()) return tl::unexpected<Error>(*error);
  const std::vector<Cell> cells = cells_of(config);
  AcfrStudyConfig one = config;
  one.runs_count = 1;
  EpisodeGrid grid{
      config.study, config::to_yaml(one), row_columns<LogRow>(), {}, config.runs_count};
  for (const Cell& cell : cells) grid.cells.push_back(cell.name());
  const auto predictor = predictor_factory(config.local, run.folder);
  if (!predictor) return tl::unexpected<Error>(predictor.error());
  const auto tours = Tours::plan(config, run.jobs);
  if (!tours) return tl::unexpected<Error>(tours.error());
  const auto episodes = run_episodes(grid, run, [&](int cell, int number) {
    const ThreadClock clock;
    return rows_of(drive(config, *predictor, cells[static_cast<std::size_t>(cell)],
                         tours->of(number), number, &clock, nullptr));
  });
  if (!episodes) return tl::unexpected<Error>(episodes.error());
  StudyResult result = result_of(config, cells, *episodes);
  result.films = films_of(config, *predictor, cells, *tours, *episodes, run);
  if (!run.out.empty()) result.files = episode_files();
  return result;
}

}  // namespace headland
