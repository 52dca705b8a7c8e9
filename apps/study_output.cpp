// SPDX-License-Identifier: Apache-2.0
#include "apps/study_output.hpp"

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

}  // namespace headland::apps
