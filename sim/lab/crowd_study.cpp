// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/crowd_study.hpp"

#include <functional>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "core/base/clock.hpp"
#include "core/config/yaml.hpp"
#include "sim/lab/crowd/episode.hpp"
#include "sim/lab/crowd/tables.hpp"
#include "sim/lab/episode_row.hpp"
#include "sim/lab/film.hpp"
#include "sim/lab/repeats.hpp"
#include "sim/lab/statistics.hpp"

namespace headland {
namespace {

using Outcomes = std::vector<CrowdOutcome>;

// A planner, none for the holonomic reference, among people who see the robot or do not.
struct Cell {
  std::optional<LocalPlannerKind> planner;
  bool visible;

  std::string planner_name() const {
    return std::string(planner ? config::enum_name(*planner) : kHolonomicOrca);
  }
  std::string name() const { return planner_name() + (visible ? "/visible" : "/invisible"); }
};

std::vector<Cell> cells_of(const CrowdStudyConfig& config) {
  std::vector<Cell> cells;
  for (const LocalPlannerKind planner : config.planners) {
    cells.push_back({planner, true});
    cells.push_back({planner, false});
  }
  cells.push_back({std::nullopt, true});
  cells.push_back({std::nullopt, false});
  return cells;
}

std::unique_ptr<EpisodeRobot> robot_of(const CrowdStudyConfig& config,
                                       const PredictorFactory& predictor, const Cell& cell,
                                       const CrowdWalk& walk) {
  if (!cell.planner) return std::make_unique<HolonomicOrcaRobot>(walk.start, walk.goal);
  return std::make_unique<PlannedRobot>(
      config.vehicle, make_local_planner(*cell.planner, config.local, config.vehicle, predictor),
      PlanBudget{config.iterations_count, {}}, walk.start, walk.goal);
}

Episode drive(const CrowdStudyConfig& config, const PredictorFactory& predictor, const Cell& cell,
              int run, Film* film = nullptr) {
  const CrowdScenario scenario = crowd_scenario(static_cast<std::uint64_t>(config.seed), run);
  const auto robot = robot_of(config, predictor, cell, scenario.robot);
  Episode episode;
  const CrowdOutcome outcome =
      run_crowd_episode(scenario, cell.visible, *robot, ThreadClock(), episode.plan_ms, film);
  episode.rows.push_back(to_row(outcome));
  return episode;
}

double timeout(const CrowdOutcome& o) { return 1.0 - o.success_count - o.collision_count; }

FilmReason when(std::string what, const std::function<bool(const CrowdOutcome&)>& so) {
  return {std::move(what), [so](const Episode& episode) {
            return so(from_row<CrowdOutcome>(episode.rows.front()));
          }};
}

std::vector<Film> films_of(const CrowdStudyConfig& config, const PredictorFactory& predictor,
                           const std::vector<Cell>& cells,
                           const std::vector<std::vector<Episode>>& episodes, int count) {
  const std::vector<FilmReason> reasons = {
      when("a collision by the robot's doing",
           [](const CrowdOutcome& o) { return o.fault_count > 0.0; }),
      when("a collision", [](const CrowdOutcome& o) { return o.collision_count > 0.0; }),
      when("out of time", [](const CrowdOutcome& o) { return timeout(o) > 0.0; }),
      when("a near miss", [](const CrowdOutcome& o) { return o.near_count > 0.0; })};
  std::vector<std::string> planners;
  for (const Cell& cell : cells) planners.push_back(cell.planner_name());
  std::vector<Film> films;
  for (const auto& [key, why] : choose_films(episodes, planners, reasons, count)) {
    const Cell& cell = cells[static_cast<std::size_t>(key.cell)];
    Film& film = films.emplace_back();
    film.name = fmt::format("{}, scenario {}", cell.name(), key.run + 1);
    film.note = why;
    drive(config, predictor, cell, key.run, &film);
  }
  return films;
}

class Summary {
 public:
  Summary(std::string name, const Outcomes& outcomes)
      : cell_{std::move(name), static_cast<int>(outcomes.size())}, outcomes_(outcomes) {}

  StudyCell of(const std::vector<double>& plan_ms) {
    add_share("success", &CrowdOutcome::success_count);
    add_share("collision", &CrowdOutcome::collision_count);
    add_share("robot_fault_collision", &CrowdOutcome::fault_count);
    add_share("timeout", timeout);
    add_share("near_miss_episodes",
              [](const CrowdOutcome& o) { return o.near_count > 0.0 ? 1.0 : 0.0; });
    add_mean("time_s", &CrowdOutcome::time_s, true);
    add_mean("length_m", &CrowdOutcome::length_m, true);
    add_mean("gap_m", &CrowdOutcome::gap_m);
    cell_.add("gap_cvar5_m", cvar5(sample(&CrowdOutcome::gap_m)));
    add_mean("near_count", &CrowdOutcome::near_count);
    add_disturbance("disturbed_ratio", &CrowdOutcome::disturbed_count);
    add_disturbance("disturbed_half_ratio", &CrowdOutcome::disturbed_half_count);
    add_disturbance("disturbed_quarter_ratio", &CrowdOutcome::disturbed_quarter_count);
    if (!plan_ms.empty()) {
      Statistic statistic = summarize(plan_ms);
      statistic.p99 = quantile(plan_ms, 0.99);
      cell_.metrics.emplace_back("plan_ms", statistic);
    }
    for (const CrowdSize& size : kCrowdSizes) {
      add_share("success" + std::string(size.suffix), &CrowdOutcome::success_count, size);
      add_share("collision" + std::string(size.suffix), &CrowdOutcome::collision_count, size);
    }
    return std::move(cell_);
  }

 private:
  using Value = std::function<double(const CrowdOutcome&)>;

  std::vector<double> sample(const Value& value, bool successes_only = false) const {
    std::vector<double> values;
    for (const CrowdOutcome& o : outcomes_) {
      if (!successes_only || o.success_count > 0.0) values.push_back(value(o));
    }
    return values;
  }

  void add_share(const std::string& metric, const Value& value, const CrowdSize& size = {}) {
    int hits = 0;
    int count = 0;
    for (const CrowdOutcome& o : outcomes_) {
      if (o.people_count < size.least || o.people_count > size.most) continue;
      ++count;
      hits += value(o) > 0.5 ? 1 : 0;
    }
    if (count > 0) cell_.metrics.emplace_back(metric, proportion(hits, count));
  }

  void add_mean(const std::string& metric, const Value& value, bool successes_only = false) {
    auto values = sample(value, successes_only);
    if (!values.empty()) cell_.metrics.emplace_back(metric, summarize(std::move(values)));
  }

  // Mean of the episodes' shares, as published.
  void add_disturbance(const std::string& metric, double CrowdOutcome::*count) {
    add_mean(metric, [count](const CrowdOutcome& o) {
      return o.seen_count > 0.0 ? o.*count / o.seen_count : 0.0;
    });
  }

  StudyCell cell_;
  const Outcomes& outcomes_;
};

StudyResult result_of(const CrowdStudyConfig& config, const std::vector<Cell>& cells,
                      const std::vector<std::vector<Episode>>& episodes) {
  StudyResult result{config.study};
  std::vector<Outcomes> outcomes;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::vector<double> plan_ms;
    outcomes.emplace_back();
    for (const Episode& episode : episodes[c]) {
      outcomes.back().push_back(from_row<CrowdOutcome>(episode.rows.front()));
      plan_ms.insert(plan_ms.end(), episode.plan_ms.begin(), episode.plan_ms.end());
    }
    result.cells.push_back(Summary(cells[c].name(), outcomes.back()).of(plan_ms));
  }
  add_crowd_tables(result);
  add_paired_table(result, outcomes);
  add_people_plot(result, outcomes);
  return result;
}

}  // namespace

std::optional<Error> CrowdStudyConfig::check() const { return check_repeats(planners, "planners"); }

Result<StudyResult> run_crowd_study(const CrowdStudyConfig& config, const StudyRun& run) {
  if (auto error = config.check()) return tl::unexpected<Error>(*error);
  const std::vector<Cell> cells = cells_of(config);
  CrowdStudyConfig one = config;
  one.runs_count = 1;
  EpisodeGrid grid{
      config.study, config::to_yaml(one), row_columns<CrowdOutcome>(), {}, config.runs_count};
  for (const Cell& cell : cells) grid.cells.push_back(cell.name());
  const auto predictor = predictor_factory(config.local, run.folder);
  if (!predictor) return tl::unexpected<Error>(predictor.error());
  const auto episodes = run_episodes(grid, run, [&](int cell, int number) {
    return drive(config, *predictor, cells[static_cast<std::size_t>(cell)], number);
  });
  if (!episodes) return tl::unexpected<Error>(episodes.error());
  StudyResult result = result_of(config, cells, *episodes);
  result.films = films_of(config, *predictor, cells, *episodes, run.films_count);
  if (!run.out.empty()) result.files = episode_files();
  return result;
}

}  // namespace headland
