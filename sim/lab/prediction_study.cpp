// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/prediction_study.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include <fmt/format.h>

#include "sim/lab/prediction/forecasts.hpp"
#include "sim/lab/prediction/published.hpp"
#include "sim/lab/prediction/scene.hpp"
#include "sim/lab/statistics.hpp"

namespace headland {
namespace {

constexpr auto kBaseline = PredictorKind::kConstantVelocity;

// A forecast, and what its interval takes as one with it.
struct Scored {
  Forecast forecast;
  int cluster = 0;
};

struct Metric {
  std::string name;
  std::function<double(const Forecast&)> value;
};

// Whether `part` goes into `whole` without a rest.
bool divides(double part, double whole) {
  const double times = whole / part;
  return std::round(times) >= 1.0 && std::abs(times - std::round(times)) < 1e-6;
}

std::string name_of(PredictorKind kind) { return std::string(config::enum_name(kind)); }

// How far off a forecast is, by the names of the metrics without their unit.
std::vector<Metric> error_metrics(const PredictionStudyConfig& config) {
  std::vector<Metric> metrics = {{"ade",
                                  [](const Forecast& f) {
                                    double sum = 0.0;
                                    for (const double error : f.error_m) sum += error;
                                    return sum / static_cast<double>(f.error_m.size());
                                  }},
                                 {"fde", [](const Forecast& f) { return f.error_m.back(); }}};
  for (const double time : config.times_s) {
    const auto step = static_cast<std::size_t>(std::lround(time / config.step_s)) - 1;
    metrics.push_back(
        {fmt::format("error_{}s", time), [step](const Forecast& f) { return f.error_m[step]; }});
  }
  return metrics;
}

std::string with_interval(const Statistic& statistic) {
  if (!statistic.ci_low) return fmt::format("{:+.3f}", statistic.mean);
  return fmt::format("{:+.3f} [{:+.3f}, {:+.3f}]", statistic.mean, *statistic.ci_low,
                     *statistic.ci_high);
}

class Study {
 public:
  Study(const PredictionStudyConfig& config, int jobs)
      : config_(config), jobs_(jobs), errors_(error_metrics(config)) {
    result_.study = "prediction";
  }

  std::optional<Error> prepare(const std::filesystem::path& folder) {
    for (const PredictorKind kind : config_.predictors) {
      auto factory = predictor_factory(kind, config_.prediction, folder);
      if (!factory) return factory.error();
      factories_.push_back(std::move(*factory));
    }
    return std::nullopt;
  }

  // False if nobody was recorded long enough.
  bool add(const RecordedScene& scene) {
    std::map<PredictorKind, std::vector<Scored>> found;
    for (std::size_t i = 0; i < factories_.size(); ++i) {
      found[config_.predictors[i]] = forecasts(scene, factories_[i]);
    }
    if (found.begin()->second.empty()) return false;
    const auto baseline = found.find(kBaseline);
    Plot plot{"Error by time, " + scene.name, "ahead [s]", "mean error [m]"};
    for (const PredictorKind kind : config_.predictors) {
      result_.cells.push_back(cell_of(scene.name + "/" + name_of(kind), found[kind],
                                      baseline == found.end() ? nullptr : &baseline->second));
      plot.series.push_back(errors_by_time(name_of(kind), found[kind]));
    }
    result_.plots.push_back(std::move(plot));
    return true;
  }

  StudyResult finish() {
    add_errors();
    add_comparison();
    add_published();
    return std::move(result_);
  }

 private:
  std::vector<Scored> forecasts(const RecordedScene& scene, const PredictorFactory& make) const {
    const ForecastShape shape{config_.step_s, config_.observed_count, config_.predicted_count,
                              scene.kind};
    std::vector<Scored> scored;
    for (std::size_t i = 0; i < scene.recordings.size(); ++i) {
      for (Forecast& one : forecast(scene.recordings[i], shape, make, jobs_)) {
        const int cluster = scene.recordings.size() > 1 ? static_cast<int>(i) : one.track;
        scored.push_back({std::move(one), cluster});
      }
    }
    return scored;
  }

  StudyCell cell_of(const std::string& name, const std::vector<Scored>& scored,
                    const std::vector<Scored>* baseline) const {
    StudyCell cell{name, static_cast<int>(scored.size())};
    std::vector<int> clusters;
    for (const Scored& one : scored) clusters.push_back(one.cluster);
    const auto add = [&](const std::string& metric, const auto& value) {
      std::vector<double> sample;
      for (std::size_t i = 0; i < scored.size(); ++i) sample.push_back(value(i));
      cell.metrics.emplace_back(metric, summarize(std::move(sample), clusters));
    };
    for (const Metric& m : errors_) {
      add(m.name + "_m", [&](std::size_t i) { return m.value(scored[i].forecast); });
    }
    add("nll", [&](std::size_t i) { return scored[i].forecast.nll; });
    add("covered_ratio", [&](std::size_t i) { return scored[i].forecast.covered_ratio; });
    if (baseline == nullptr || baseline == &scored) return cell;
    for (const Metric& m : errors_) {
      add(m.name + "_less_cv_m", [&](std::size_t i) {
        return m.value(scored[i].forecast) - m.value((*baseline)[i].forecast);
      });
    }
    return cell;
  }

  PlotSeries errors_by_time(const std::string& name, const std::vector<Scored>& scored) const {
    PlotSeries series{name};
    for (int k = 0; k < config_.predicted_count; ++k) {
      double sum = 0.0;
      for (const Scored& one : scored) sum += one.forecast.error_m[static_cast<std::size_t>(k)];
      series.x.push_back((k + 1) * config_.step_s);
      series.y.push_back(sum / static_cast<double>(scored.size()));
    }
    return series;
  }

  void add_errors() {
    StudyTable table{"Errors [m]: mean of the steps / last step (95th percentile), and by time",
                     {"scene/predictor", "forecasts", "ADE / FDE (p95)"}};
    for (const double time : config_.times_s) table.header.push_back(fmt::format("{} s", time));
    table.header.insert(table.header.end(), {"NLL", "inside 95 %"});
    for (const StudyCell& cell : result_.cells) {
      const Statistic& last = *cell.find("fde_m");
      std::vector<std::string> row = {
          cell.name, fmt::format("{}", cell.n),
          fmt::format("{:.3f} / {:.3f} ({:.2f})", cell.find("ade_m")->mean, last.mean,
                      last.p95.value_or(last.mean))};
      for (const double time : config_.times_s) {
        row.push_back(fmt::format("{:.3f}", cell.find(fmt::format("error_{}s_m", time))->mean));
      }
      row.push_back(fmt::format("{:.2f}", cell.find("nll")->mean));
      row.push_back(fmt::format("{:.1f} %", 100.0 * cell.find("covered_ratio")->mean));
      table.rows.push_back(std::move(row));
    }
    result_.tables.push_back(std::move(table));
  }

  void add_comparison() {
    StudyTable table{"Errors less those of constant velocity [m], with 95 % intervals",
                     {"scene/predictor"}};
    for (const Metric& m : errors_) table.header.push_back(m.name);
    for (const StudyCell& cell : result_.cells) {
      if (cell.find("ade_less_cv_m") == nullptr) continue;
      std::vector<std::string> row = {cell.name};
      for (const Metric& m : errors_) {
        row.push_back(with_interval(*cell.find(m.name + "_less_cv_m")));
      }
      table.rows.push_back(std::move(row));
    }
    if (!table.rows.empty()) result_.tables.push_back(std::move(table));
  }

  // Beside ours of the same scene, if the protocol is theirs.
  void add_published() {
    if (config_.step_s != 0.4 || config_.observed_count != 8 || config_.predicted_count != 12)
      return;
    StudyTable table{"Published on the same scenes [m]", {"scene", "method", "ADE", "FDE"}};
    const auto text = [](double error) {
      return std::isnan(error) ? std::string("-") : fmt::format("{:.2f}", error);
    };
    for (const PublishedForecast& p : kPublishedForecasts) {
      const std::string scene = std::string(p.scene) + "/";
      const bool here = std::any_of(result_.cells.begin(), result_.cells.end(),
                                    [&](const StudyCell& c) { return c.name.starts_with(scene); });
      if (!here) continue;
      table.rows.push_back(
          {std::string(p.scene), std::string(p.method), text(p.ade_m), text(p.fde_m)});
    }
    if (!table.rows.empty()) result_.tables.push_back(std::move(table));
  }

  const PredictionStudyConfig& config_;
  int jobs_ = 1;
  std::vector<Metric> errors_;
  std::vector<PredictorFactory> factories_;
  StudyResult result_;
};

std::optional<Error> check_scene(const RecordedScene& scene, const PredictionStudyConfig& config,
                                 const std::string& place) {
  for (const SampledTracks& tracks : scene.recordings) {
    if (divides(tracks.step_s(), config.step_s)) continue;
    return Error{ErrorCode::kOutOfRange,
                 fmt::format("{} is no multiple of the step of {}, {} s", config.step_s, place,
                             tracks.step_s()),
                 "choose another step",
                 {{}, 0, "step_s"}};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Error> PredictionStudyConfig::check() const {
  if (tracks.empty() || predictors.empty()) {
    return Error{ErrorCode::kOutOfRange,
                 "nothing to do",
                 "name at least one",
                 {{}, 0, tracks.empty() ? "tracks" : "predictors"}};
  }
  for (const double time : times_s) {
    if (!divides(step_s, time) || time > (predicted_count + 0.5) * step_s) {
      return Error{ErrorCode::kOutOfRange,
                   fmt::format("{} is no time of the steps", time),
                   fmt::format("multiples of step_s up to {}", predicted_count * step_s),
                   {{}, 0, "times_s"}};
    }
  }
  return std::nullopt;
}

Result<StudyResult> run_prediction_study(const PredictionStudyConfig& config,
                                         const std::filesystem::path& folder, int jobs) {
  Study study(config, jobs);
  if (auto error = study.prepare(folder)) return tl::unexpected<Error>(*error);
  for (std::size_t i = 0; i < config.tracks.size(); ++i) {
    const std::string place = fmt::format("tracks[{}]", i);
    const auto scene = read_scene(config.tracks[i], place, folder);
    if (!scene) return tl::unexpected<Error>(scene.error());
    if (auto error = check_scene(*scene, config, place)) return tl::unexpected<Error>(*error);
    if (!study.add(*scene)) {
      return fail(
          ErrorCode::kOutOfRange,
          fmt::format("in {}, \"{}\", nobody was recorded for {} steps of {} s in a row", place,
                      scene->name, config.observed_count + config.predicted_count, config.step_s),
          "choose fewer steps", {config.tracks[i].file, 0, {}});
    }
  }
  return study.finish();
}

}  // namespace headland
