// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/crowd/tables.hpp"

#include <string>

#include <fmt/format.h>

#include "sim/lab/crowd/published.hpp"
#include "sim/lab/statistics.hpp"

namespace headland {

using namespace crowd_protocol;

namespace {

using Row = std::vector<std::string>;

std::string share(const Statistic* s) {
  if (s == nullptr) return "-";
  if (!s->ci_low) return fmt::format("{:.1f}", 100.0 * s->mean);
  return fmt::format("{:.1f} [{:.1f}, {:.1f}]", 100.0 * s->mean, 100.0 * *s->ci_low,
                     100.0 * *s->ci_high);
}

std::string mean(const Statistic* s) { return s == nullptr ? "-" : fmt::format("{:.2f}", s->mean); }

std::string percent(const Statistic* s) {
  return s == nullptr ? "-" : fmt::format("{:.2f}", 100.0 * s->mean);
}

std::string times(const Statistic* s) {
  if (s == nullptr || !s->median || !s->p99) return "-";
  return fmt::format("{:.2g} / {:.2g}", *s->median, *s->p99);
}

Row row_of(const StudyCell& cell) {
  return {cell.name,
          share(cell.find("success")),
          share(cell.find("collision")),
          percent(cell.find("robot_fault_collision")),
          share(cell.find("near_miss_episodes")),
          mean(cell.find("time_s")),
          mean(cell.find("length_m")),
          percent(cell.find("disturbed_ratio")),
          percent(cell.find("disturbed_half_ratio")),
          percent(cell.find("disturbed_quarter_ratio")),
          times(cell.find("plan_ms"))};
}

Row row_of(const PublishedCrowdResult& published) {
  const auto share_of = [](int hits) {
    const Statistic s = proportion(hits, kPublishedEpisodes);
    return share(&s);
  };
  const auto number = [](double value) { return fmt::format("{:.2f}", value); };
  return {std::string(published.name) + " (published, holonomic)",
          share_of(published.success),
          share_of(published.collision),
          "-",
          share_of(published.near_miss_episodes),
          number(published.time_s),
          number(published.length_m),
          number(100.0 * published.disturbed_ratio),
          number(100.0 * published.disturbed_half_ratio),
          number(100.0 * published.disturbed_quarter_ratio),
          fmt::format("{:.0f}", published.plan_ms)};
}

StudyTable main_table(const StudyResult& result, bool visible) {
  StudyTable table{
      visible ? "People see the robot; published: 500 episodes each"
              : "People do not see the robot",
      {"planner", "success %", "collision %", "robot's fault %", "near-miss episodes %", "time s",
       "length m", "disturbed > 1 %", "> 0.5 %", "> 0.25 m/s2 %", "plan ms p50 / p99"},
      {}};
  const std::string_view ending = visible ? "/visible" : "/invisible";
  for (const StudyCell& cell : result.cells) {
    if (cell.name.ends_with(ending)) table.rows.push_back(row_of(cell));
  }
  if (visible) {
    for (const PublishedCrowdResult& p : kPublishedCrowdResults) table.rows.push_back(row_of(p));
  }
  return table;
}

StudyTable size_table(const StudyResult& result) {
  StudyTable table{"Success / collision [%] by number of people",
                   {"planner", "2 to 4", "5 to 8", "9 to 11"},
                   {}};
  for (const StudyCell& cell : result.cells) {
    Row row = {cell.name};
    for (const CrowdSize& size : kCrowdSizes) {
      const Statistic* success = cell.find("success" + std::string(size.suffix));
      const Statistic* collision = cell.find("collision" + std::string(size.suffix));
      row.push_back(success == nullptr ? "-"
                                       : fmt::format("{:.1f} / {:.1f}", 100.0 * success->mean,
                                                     100.0 * collision->mean));
    }
    table.rows.push_back(std::move(row));
  }
  for (const PublishedCrowdResult& published : kPublishedCrowdResults) {
    Row row = {std::string(published.name) + " (published, holonomic)"};
    for (const double success : published.success_ratio) {
      row.push_back(fmt::format("{:.1f}", 100.0 * success));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

void add_crowd_tables(StudyResult& result) {
  result.tables.push_back(main_table(result, true));
  result.tables.push_back(main_table(result, false));
  result.tables.push_back(size_table(result));
}

void add_paired_table(StudyResult& result, const std::vector<std::vector<CrowdOutcome>>& outcomes) {
  StudyTable table{"Same scenarios: where only one of two planners succeeds",
                   {"planner", "other", "only planner", "only other", "McNemar p"},
                   {}};
  for (std::size_t other = 2; other < outcomes.size(); ++other) {
    const std::size_t first = other % 2;  // visible and invisible take turns
    int only_first = 0;
    int only_other = 0;
    for (std::size_t run = 0; run < outcomes[first].size(); ++run) {
      const double difference =
          outcomes[first][run].success_count - outcomes[other][run].success_count;
      only_first += difference > 0.5 ? 1 : 0;
      only_other += difference < -0.5 ? 1 : 0;
    }
    table.rows.push_back({result.cells[first].name, result.cells[other].name,
                          fmt::format("{}", only_first), fmt::format("{}", only_other),
                          fmt::format("{:.2g}", mcnemar(only_first, only_other))});
  }
  result.tables.push_back(std::move(table));
}

void add_people_plot(StudyResult& result, const std::vector<std::vector<CrowdOutcome>>& outcomes) {
  Plot plot{"Success by the number of people", "people", "success [%]"};
  for (std::size_t c = 0; c < outcomes.size(); ++c) {
    PlotSeries series{result.cells[c].name};
    for (int people = kLeastPeople; people <= kMostPeople; ++people) {
      int count = 0;
      double hits = 0.0;
      for (const CrowdOutcome& o : outcomes[c]) {
        if (static_cast<int>(o.people_count) != people) continue;
        ++count;
        hits += o.success_count;
      }
      if (count == 0) continue;
      series.x.push_back(people);
      series.y.push_back(100.0 * hits / count);
    }
    plot.series.push_back(std::move(series));
  }
  result.plots.push_back(std::move(plot));
}

}  // namespace headland
