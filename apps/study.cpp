// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "apps/command.hpp"
#include "apps/interrupt.hpp"
#include "apps/output_files.hpp"
#include "apps/report_content.hpp"
#include "apps/study_output.hpp"
#include "sim/lab/acfr_study.hpp"
#include "sim/lab/crowd_study.hpp"
#include "sim/lab/ebs221_study.hpp"
#include "sim/lab/energy_study.hpp"
#include "sim/lab/polito_study.hpp"
#include "sim/lab/prediction_study.hpp"
#include "sim/lab/rows_study.hpp"
#include "sim/lab/tracking_study.hpp"

namespace headland::apps {
namespace {

constexpr int kFilms = 6;  // in the report

std::filesystem::path folder_of(const config::Node& node) {
  return std::filesystem::path(node.where().file).parent_path();
}

template <class Config, class RunStudy>
Result<FinishedStudy> run_as(const config::Node& node, int max_episodes,
                             const RunStudy& run_study) {
  Config config;
  if (auto read = config::read_into(node, config); !read)
    return tl::unexpected<Error>(read.error());
  if constexpr (requires { config.runs_count; }) {
    if (max_episodes > 0) config.runs_count = std::min(config.runs_count, max_episodes);
  }
  auto result = run_study(config);
  if (!result) return tl::unexpected<Error>(result.error());
  return FinishedStudy{std::move(*result), make_stamp(static_cast<std::uint64_t>(config.seed),
                                                      config::to_yaml(config))};
}

// A study of episodes keeps them in `out` as it goes; Ctrl-C ends it after those that are running.
template <class Config, class RunStudy>
Result<FinishedStudy> run_episodes_as(const config::Node& node, int max_episodes, int jobs,
                                      const std::string& out, const RunStudy& run_study) {
  ProgressBar bar("episodes");
  const InterruptGuard guard;
  const StudyRun run{jobs,
                     out,
                     [&bar](double share) { bar.update(share); },
                     InterruptGuard::interrupted,
                     folder_of(node),
                     kFilms};
  return run_as<Config>(node, max_episodes,
                        [&](const Config& config) { return run_study(config, run); });
}

Result<FinishedStudy> run_study_file(const config::Node& node, int jobs, int max_episodes,
                                     const std::string& out) {
  const auto study = node.child("study");
  const std::string name = study && study->is_scalar() ? study->scalar() : "";
  if (name == "ebs221") return run_as<Ebs221StudyConfig>(node, max_episodes, run_ebs221_study);
  if (name == "polito") {
    return run_as<PolitoStudyConfig>(node, max_episodes, [&](const PolitoStudyConfig& config) {
      return run_polito_study(config, jobs);
    });
  }
  if (name == "energy") {
    return run_as<EnergyStudyConfig>(node, max_episodes, [&](const EnergyStudyConfig& config) {
      return run_energy_study(config, jobs);
    });
  }
  if (name == "prediction") {
    return run_as<PredictionStudyConfig>(
        node, max_episodes, [&](const PredictionStudyConfig& config) {
          return run_prediction_study(config, folder_of(node), jobs);
        });
  }
  if (name == "rows") {
    return run_as<RowsStudyConfig>(node, max_episodes, [&](const RowsStudyConfig& config) {
      return run_rows_study(config, folder_of(node), jobs);
    });
  }
  if (name == "tracking") {
    return run_as<TrackingStudyConfig>(node, max_episodes, [&](const TrackingStudyConfig& config) {
      return run_tracking_study(config, jobs);
    });
  }
  if (name == "acfr") {
    return run_episodes_as<AcfrStudyConfig>(node, max_episodes, jobs, out, run_acfr_study);
  }
  if (name == "crowd") {
    return run_episodes_as<CrowdStudyConfig>(node, max_episodes, jobs, out, run_crowd_study);
  }
  Location where = study ? study->where() : node.where();
  where.key = "study";
  return fail(study ? ErrorCode::kUnknownName : ErrorCode::kMissingKey,
              study ? "'" + name + "' is no study" : "required key is missing",
              "allowed: acfr, crowd, ebs221, energy, polito, prediction, rows, tracking", where);
}

}  // namespace

int study_command(const CommonOptions& options, int jobs, int max_episodes) {
  if (auto ready = prepare_output(options.out); !ready) {
    return report_error(ready.error(), options);
  }
  const auto node = load_with_overrides(options);
  if (!node) return report_error(node.error(), options);
  const auto finished = run_study_file(*node, jobs, max_episodes, options.out);
  if (!finished) return report_error(finished.error(), options);

  const std::string results = results_json(*finished);
  std::map<std::string, std::string> files = {{"results.json", results}};
  const std::vector<std::string>& kept = finished->result.files;
  if (kept.empty()) files["episodes.csv"] = cells_csv(finished->result);
  const auto written = write_report(study_report(*finished), options.out, files, kept);
  if (!written) return report_error(written.error(), options);
  if (options.json) {
    fmt::print("{}", results);
  } else {
    fmt::print("{}{}", study_text(finished->result), report_line(options.out));
  }
  return 0;
}

}  // namespace headland::apps
