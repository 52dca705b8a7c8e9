// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "local_planner/prediction/predictors.hpp"
#include "sim/lab/prediction/sampled_tracks.hpp"

namespace headland {

/// What is shown of a recording, and what is asked for.
struct ForecastShape {
  double step_s = 0.4;                  ///< a multiple of the recording's own
  int observed = 8;                     ///< steps, now included; all samples between are shown too
  int predicted = 12;                   ///< steps
  AgentKind kind = AgentKind::kPerson;  ///< whose errors count; all are shown
};

/// One agent foretold from one moment, beside what came.
struct Forecast {
  int track = 0;
  std::vector<double> error_m{};  ///< at the steps
  double nll = 0.0;               ///< negative log-density of what came, mean of the steps
  double covered_ratio = 0.0;     ///< of the steps that came inside the ellipse of 95 %
};

/// From every `step_s`-th moment on, a fresh predictor sees the observed steps of everybody, no
/// velocities, a robot that stands a kilometre away, and foretells. All agents of the kind count
/// that were recorded at all steps, observed and predicted. In order of time, then of tracks.
/// `jobs` moments at once.
std::vector<Forecast> forecast(const SampledTracks& tracks, const ForecastShape& shape,
                               const PredictorFactory& make, int jobs = 1);

}  // namespace headland
