// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/prediction/forecasts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "sim/lab/parallel.hpp"

namespace headland {
namespace {

constexpr double kRobotAway = 1000.0;  // east and north of everybody [m]

// A moment of a recording, by its sample.
class Moment {
 public:
  Moment(const SampledTracks& tracks, const ForecastShape& shape, int now)
      : tracks_(tracks),
        shape_(shape),
        now_(now),
        stride_(static_cast<int>(std::lround(shape.step_s / tracks.step_s()))) {}

  std::vector<Forecast> run(const PredictorFactory& make) const {
    std::vector<Forecast> forecasts;
    for (int track = 0; track < tracks_.tracks(); ++track) {
      if (counts(track)) forecasts.push_back({track});
    }
    if (forecasts.empty()) return forecasts;
    const auto predictor = make();
    const Point2 robot =
        *tracks_.position(forecasts.front().track, now_) + Point2(kRobotAway, kRobotAway);
    std::vector<Agent> seen;
    for (int sample = now_ - (shape_.observed - 1) * stride_; sample <= now_; ++sample) {
      tracks_.see(sample, seen);
      predictor->observe(seen, robot, {0.0, 0.0}, sample * tracks_.step_s());
    }
    Prediction prediction;
    predictor->predict({}, shape_.step_s, shape_.predicted, prediction);
    for (Forecast& forecast : forecasts) compare(prediction, forecast);
    return forecasts;
  }

 private:
  bool counts(int track) const {
    if (tracks_.kind(track) != shape_.kind) return false;
    for (int k = 1 - shape_.observed; k <= shape_.predicted; ++k) {
      if (!tracks_.position(track, now_ + k * stride_)) return false;
    }
    return true;
  }

  void compare(const Prediction& prediction, Forecast& forecast) const {
    constexpr double kEllipse95 = 5.991464547107979;  // of chi-squared, two degrees of freedom
    const int id = tracks_.id(forecast.track);
    const auto found = std::find(prediction.ids.begin(), prediction.ids.end(), id);
    const int agent = static_cast<int>(found - prediction.ids.begin());
    for (int k = 0; k < shape_.predicted; ++k) {
      const std::size_t i = prediction.index(agent, k);
      const Point2 came = *tracks_.position(forecast.track, now_ + (k + 1) * stride_);
      const Point2 error = came - prediction.mean[i];
      const Eigen::Matrix2d& covariance = prediction.covariance[i];
      const double distance2 = error.dot(covariance.inverse() * error);
      forecast.error_m.push_back(error.norm());
      forecast.nll +=
          std::log(2.0 * std::numbers::pi) + 0.5 * (std::log(covariance.determinant()) + distance2);
      forecast.covered_ratio += distance2 <= kEllipse95 ? 1.0 : 0.0;
    }
    forecast.nll /= shape_.predicted;
    forecast.covered_ratio /= shape_.predicted;
  }

  const SampledTracks& tracks_;
  const ForecastShape& shape_;
  int now_;
  int stride_;
};

}  // namespace

std::vector<Forecast> forecast(const SampledTracks& tracks, const ForecastShape& shape,
                               const PredictorFactory& make, int jobs) {
  const int stride = static_cast<int>(std::lround(shape.step_s / tracks.step_s()));
  const int first = (shape.observed - 1) * stride;
  const int last = tracks.samples() - 1 - shape.predicted * stride;
  const int moments = last < first ? 0 : (last - first) / stride + 1;
  std::vector<std::vector<Forecast>> found(static_cast<std::size_t>(moments));
  parallel_for(moments, jobs, [&](int i) {
    found[static_cast<std::size_t>(i)] = Moment(tracks, shape, first + i * stride).run(make);
  });
  std::vector<Forecast> all;
  for (auto& of_moment : found)
    std::move(of_moment.begin(), of_moment.end(), std::back_inserter(all));
  return all;
}

}  // namespace headland
