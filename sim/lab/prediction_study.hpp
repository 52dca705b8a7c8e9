// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "local_planner/prediction/predictors.hpp"
#include "sim/lab/study_result.hpp"

namespace headland {

enum class RecordingKind : std::int8_t {
  kPedestrian,  ///< obsmat.txt of OpenTraj, or frame, id, x, y; one recording
  kSheep        ///< sheep_dog_drives.csv of Jadhav et al. 2024; as many as it has drives
};

/// Which of the recordings of a file, counted from one: to fit on some and to tell of the others.
enum class RecordingPart : std::int8_t { kAll, kOdd, kEven };

/// A file of recorded tracks.
struct Recording {
  std::string file;
  RecordingKind kind = RecordingKind::kPedestrian;
  std::string name;
  RecordingPart part = RecordingPart::kAll;
  double noise_m = 0.05;

  template <class V>
  void visit(V& v) {
    v.required("file", file,
               "Relative to the study's file; $HEADLAND_DATA stands for the folder of data");
    v.required("kind", kind, "What it holds");
    v("name", name, "Of the scene; empty: that of the folder that the file lies in");
    v("part", part, "Which of its drives");
    v("noise_m", noise_m, config::kNonNegative,
      "Standard deviation of its positions, as predictors are told [m]");
  }
};

/// How well agents are foretold, on tracks of real people and animals. The defaults are the usual
/// protocol for pedestrians: 8 steps of 0.4 s observed, 12 foretold.
struct PredictionStudyConfig {
  std::string study = "prediction";
  int seed = 1;
  std::vector<Recording> tracks;
  std::vector<PredictorKind> predictors = {PredictorKind::kConstantVelocity,
                                           PredictorKind::kCompanions, PredictorKind::kOrca,
                                           PredictorKind::kHerd, PredictorKind::kLearned};
  double step_s = 0.4;
  int observed_count = 8;
  int predicted_count = 12;
  std::vector<double> times_s = {1.2, 2.4, 4.8};
  PredictorsConfig prediction;

  std::optional<Error> check() const;

  template <class V>
  void visit(V& v) {
    v("study", study, "Which study this file is for");
    v("seed", seed, config::Range{0, 1000000000}, "Not used: nothing is random");
    v.required("tracks", tracks, "Files of recorded tracks, each a scene");
    v("predictors", predictors, "Each a cell per scene");
    v("step_s", step_s, config::kPositive, "A multiple of the recordings' own [s]");
    v("observed_count", observed_count, config::Range{2, 1000}, "Steps observed, now included");
    v("predicted_count", predicted_count, config::Range{1, 1000}, "Steps foretold");
    v("times_s", times_s, config::kPositive, "Multiples of the step at which errors are told [s]");
    v("prediction", prediction, "Parameters of the predictors, the same for all scenes");
  }
};

/// Cells `<scene>/<predictor>`, over all agents and moments: ade_m (mean error of the steps), fde_m
/// (at the last), error_<t>s_m, nll, covered_ratio (inside the ellipse of 95 %), and all errors
/// less those of constant velocity, agent by agent, if that is among the predictors:
/// ade_less_cv_m, ... Intervals take what one pedestrian, or one drive of the sheep, contributes as
/// one. `folder` is where relative files begin. Errors: of the files, with their path;
/// kOutOfRange if a scene has nobody who was recorded long enough, a step that is not a multiple of
/// the recording's. Deterministic for any number of `jobs`.
Result<StudyResult> run_prediction_study(const PredictionStudyConfig& config,
                                         const std::filesystem::path& folder, int jobs = 1);

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::RecordingKind> {
  static constexpr std::pair<headland::RecordingKind, std::string_view> values[] = {
      {headland::RecordingKind::kPedestrian, "pedestrian"},
      {headland::RecordingKind::kSheep, "sheep"}};
};

template <>
struct headland::config::EnumNames<headland::RecordingPart> {
  static constexpr std::pair<headland::RecordingPart, std::string_view> values[] = {
      {headland::RecordingPart::kAll, "all"},
      {headland::RecordingPart::kOdd, "odd"},
      {headland::RecordingPart::kEven, "even"}};
};
