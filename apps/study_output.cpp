// SPDX-License-Identifier: Apache-2.0
#include "apps/study_output.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace headland::apps {
namespace {

using Json = nlohmann::ordered_json;

Json statistic_json(const Statistic& statistic) {
  Json json = {{"mean", statistic.mean}};
  const auto add = [&](const char* name, const std::optional<double>& value) {
    if (value) json[name] = *value;
  };
  add("median", statistic.median);
  add("std", statistic.std);
  add("p95", statistic.p95);
  add("p99", statistic.p99);
  add("ci_low", statistic.ci_low);
  add("ci_high", statistic.ci_high);
  return json;
}

}  // namespace

std::string results_json(const FinishedStudy& study) {
  Json cells = Json::array();
  for (const StudyCell& cell : study.result.cells) {
    Json json = {{"name", cell.name}, {"n", cell.n}};
    for (const auto& [metric, statistic] : cell.metrics) json[metric] = statistic_json(statistic);
    cells.push_back(std::move(json));
  }
  const Json document = {{"study", study.result.study},
                         {"version", study.stamp.version},
                         {"seed", study.stamp.seed},
                         {"config_hash", study.stamp.config_hash},
                         {"config_yaml", study.stamp.config_yaml},
                         {"cells", std::move(cells)}};
  return document.dump(2) + "\n";
}

std::string cells_csv(const StudyResult& result) {
  std::string text = "cell,n,metric,mean,median,std,p95,ci_low,ci_high\n";
  const auto number = [](const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : std::string();
  };
  for (const StudyCell& cell : result.cells) {
    for (const auto& [metric, s] : cell.metrics) {
      text += fmt::format("{},{},{},{},{},{},{},{},{}\n", cell.name, cell.n, metric, s.mean,
                          number(s.median), number(s.std), number(s.p95), number(s.ci_low),
                          number(s.ci_high));
    }
  }
  return text;
}

namespace {

std::string table_text(const StudyTable& table) {
  std::vector<std::size_t> widths;
  for (const std::string& name : table.header) widths.push_back(name.size());
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < std::min(row.size(), widths.size()); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  std::string text = table.title + "\n";
  const auto add = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += fmt::format("  {:<{}}", row[i], i < widths.size() ? widths[i] : 0);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  };
  add(table.header);
  for (const auto& row : table.rows) add(row);
  return text;
}

std::string cells_text(const StudyResult& result) {
  std::string text;
  for (const StudyCell& cell : result.cells) {
    text += fmt::format("{:<32}", cell.name);
    for (const auto& [metric, s] : cell.metrics) {
      text += fmt::format(" {}={:.5g}", metric, s.mean);
      if (s.ci_low && s.ci_high) text += fmt::format(" [{:.5g}, {:.5g}]", *s.ci_low, *s.ci_high);
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::string study_text(const StudyResult& result) {
  if (result.tables.empty()) return cells_text(result);
  std::string text;
  for (const StudyTable& table : result.tables) text += table_text(table) + "\n";
  return text;
}

}  // namespace headland::apps
