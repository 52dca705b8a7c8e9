// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/command.hpp"
#include "apps/report.hpp"
#include "sim/lab/ebs221_study.hpp"
#include "sim/lab/polito_study.hpp"
#include "sim/lab/study_result.hpp"

namespace headland::apps {
namespace {

using Json = nlohmann::ordered_json;

// A study file: which study, then that study's own keys.
template <class Config>
struct StudyFile {
  std::string study;
  Config config;

  template <class V>
  void visit(V& v) {
    v.required("study", study, "ebs221 or polito");
    config.visit(v);
  }
};

struct FinishedStudy {
  StudyResult result;
  Stamp stamp;
};

template <class Config, class RunStudy>
Result<FinishedStudy> run_as(const config::Node& node, const RunStudy& run_study) {
  StudyFile<Config> file;
  if (auto read = config::read_into(node, file); !read) return tl::unexpected<Error>(read.error());
  auto result = run_study(file.config);
  if (!result) return tl::unexpected<Error>(result.error());
  return FinishedStudy{std::move(*result), make_stamp(file.config.seed, config::to_yaml(file))};
}

Json statistic_json(const Statistic& statistic) {
  Json json = {{"mean", statistic.mean}};
  const auto add = [&](const char* name, const std::optional<double>& value) {
    if (value) json[name] = *value;
  };
  add("median", statistic.median);
  add("std", statistic.std);
  add("p95", statistic.p95);
  add("ci_low", statistic.ci_low);
  add("ci_high", statistic.ci_high);
  return json;
}

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

std::string episodes_csv(const StudyResult& result) {
  std::string text = "cell,n,metric,mean,median,std,p95,ci_low,ci_high\n";
  const auto cell_text = [](const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : std::string();
  };
  for (const StudyCell& cell : result.cells) {
    for (const auto& [metric, s] : cell.metrics) {
      text += fmt::format("{},{},{},{},{},{},{},{},{}\n", cell.name, cell.n, metric, s.mean,
                          cell_text(s.median), cell_text(s.std), cell_text(s.p95),
                          cell_text(s.ci_low), cell_text(s.ci_high));
    }
  }
  return text;
}

std::string cells_text(const StudyResult& result) {
  std::string text;
  for (const StudyCell& cell : result.cells) {
    text += fmt::format("{:<32}", cell.name);
    for (const auto& [metric, s] : cell.metrics) text += fmt::format(" {}={:.5g}", metric, s.mean);
    text += "\n";
  }
  return text;
}

}  // namespace

int study_command(const CommonOptions& options, int jobs, int max_episodes) {
  static_cast<void>(jobs);
  static_cast<void>(max_episodes);
  return 0;
}

}  // namespace headland::apps
