// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/training/internal/training_files.hpp"

#include <array>
#include <limits>

#include <fmt/format.h>

#include "local_planner/prediction/learned_predictor.hpp"
#include "sim/lab/prediction/prediction_score.hpp"
#include "sim/lab/training/internal/response_model.hpp"

namespace headland::training {
namespace {

constexpr double kNear = 3.0;  // where (003) Eq. 2 counts agents [m]

struct Scores {
  PredictionScore coasting;
  PredictionScore untold;
  PredictionScore told;
};

Scores scores_of(const ResponseNetwork& network, const std::vector<CrowdWindow>& windows,
                 CrowdScene scene, const WindowShape& shape, double near) {
  PredictionScorer coasting(shape, near);
  PredictionScorer untold(shape, near);
  PredictionScorer told(shape, near);
  CoastingPredictor coasting_predictor;
  for (const CrowdWindow& window : windows) {
    if (window.scene != scene) continue;
    LearnedPredictor learned(network, window.robot_radius_m);
    coasting.add(window, coasting_predictor, RobotForetold::kPlan);
    untold.add(window, learned, RobotForetold::kCoasting);
    told.add(window, learned, RobotForetold::kPlan);
  }
  return {coasting.score(), untold.score(), told.score()};
}

}  // namespace

std::string training_log(const TrainingResult& result, const TrainingSettings& settings,
                         const WindowShape& shape, std::size_t training_windows,
                         const std::vector<CrowdWindow>& test) {
  std::string text = fmt::format(
      "# Training of crowd_response.weights\n"
      "Written by `train_response` (sim/lab/training); the figures are those of this file's "
      "neighbour.\n\n"
      "- Seed {}; training on {} windows of up to {} agents, {} steps of {} s back and {} on; "
      "episodes for validation and test have their own seeds.\n"
      "- {} embedded values, {} hidden values; batches of {} windows; Adam, rate {} to {}; "
      "distance weight {}.\n\n"
      "| epoch | training loss | validation NLL | validation distance [m] | time [s] |\n"
      "|---|---|---|---|---|\n",
      settings.seed, training_windows, shape.most_agents, shape.past_steps, shape.step_s,
      shape.future_steps, settings.embedded, settings.hidden, settings.windows_per_batch,
      settings.rate, settings.last_rate, settings.distance_weight);
  int number = 0;
  for (const Epoch& epoch : result.epochs) {
    text +=
        fmt::format("| {} | {:.4f} | {:.4f} | {:.4f} | {:.0f} |\n", ++number, epoch.training_loss,
                    epoch.validation_nll, epoch.validation_ade_m, epoch.seconds);
  }
  text += fmt::format(
      "\nErrors on {} windows of the test episodes: mean over the {} steps / last step [m]. Near: "
      "the robot comes within {} m. Untold: the predictor is told that the robot goes on at its "
      "velocity; told: what it will do. Shares of truths within one and two deviations: a Gaussian "
      "has 0.393 and 0.865.\n\n"
      "| crowd | agents | constant velocity | p95 last | untold | told | p95 last | NLL | within 1 "
      "| "
      "within 2 |\n|---|---|---|---|---|---|---|---|---|---|\n",
      test.size(), shape.future_steps, kNear);
  for (const auto& [scene, name] : config::EnumNames<CrowdScene>::values) {
    for (const double near : {std::numeric_limits<double>::infinity(), kNear}) {
      const Scores s = scores_of(result.network, test, scene, shape, near);
      text += fmt::format(
          "| {}{} | {} | {:.3f} / {:.3f} | {:.2f} | {:.3f} / {:.3f} | {:.3f} / {:.3f} | {:.2f} | "
          "{:.2f} | {:.3f} | {:.3f} |\n",
          name, near == kNear ? ", near" : "", s.told.agents_count, s.coasting.ade_m,
          s.coasting.fde_m, s.coasting.fde_p95_m, s.untold.ade_m, s.untold.fde_m, s.told.ade_m,
          s.told.fde_m, s.told.fde_p95_m, s.told.nll, s.told.within_1_ratio, s.told.within_2_ratio);
    }
  }
  return text;
}

std::string reference(const ResponseNetwork& network, const WindowShape& shape,
                      const TrainingSettings& settings) {
  const torch::NoGradGuard no_gradient;
  ResponseModel model(settings.embedded, settings.hidden, settings.seed);
  model.set(network);
  std::vector<CrowdWindow> windows;
  for (const auto& [scene, name] : config::EnumNames<CrowdScene>::values) {
    const auto some = record_windows(scene, shape, 2, settings.seed + 10);
    windows.push_back(some.front());
    windows.push_back(some.back());
  }
  std::string text = fmt::format("windows {} past {} future {} step_s {}\n", windows.size(),
                                 shape.past_steps, shape.future_steps, shape.step_s);
  const auto moments = static_cast<std::size_t>(shape.moments());
  const auto past = static_cast<std::size_t>(shape.past_steps);
  for (const CrowdWindow& window : windows) {
    RandomStream random(settings.seed, "reference");
    const std::array<const CrowdWindow*, 1> one{&window};
    const Batch batch = make_batch(one, shape, {}, random);
    const Forecast forecast = model.forward(batch, shape);
    text +=
        fmt::format("robot_radius_m {} agents {}\nrobot\n", window.robot_radius_m, window.agents());
    for (const Point2& p : window.robot) text += fmt::format("{:.9g} {:.9g}\n", p.x(), p.y());
    for (std::size_t a = 0; a < window.radius_m.size(); ++a) {
      text += fmt::format("agent {:.9g}\n", window.radius_m[a]);
      for (std::size_t k = 0; k <= past; ++k) {
        const Point2& p = window.position[a * moments + k];
        const Point2& v = window.velocity[a * moments + k];
        text += fmt::format("{:.9g} {:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), v.x(), v.y());
      }
      text += "predicted\n";
      const auto index = static_cast<std::int64_t>(a);
      const auto heading = batch.heading[0][index];
      Eigen::Matrix2d turn;
      const double hx = heading[0].item<double>(), hy = heading[1].item<double>();
      turn << hx, -hy, hy, hx;
      for (std::size_t k = 0; k + past + 1 < moments; ++k) {
        const auto step = static_cast<std::int64_t>(k);
        const auto error = forecast.error[0][index][step];
        const auto c = forecast.covariance[0][index][step];
        const Point2 mean = window.position[a * moments + past + 1 + k] -
                            turn * Point2(error[0].item<double>(), error[1].item<double>());
        Eigen::Matrix2d local;
        local << c[0].item<double>(), c[1].item<double>(), c[1].item<double>(), c[2].item<double>();
        const Eigen::Matrix2d covariance = turn * local * turn.transpose();
        text += fmt::format("{:.7g} {:.7g} {:.6g} {:.6g} {:.6g}\n", mean.x(), mean.y(),
                            covariance(0, 0), covariance(0, 1), covariance(1, 1));
      }
    }
  }
  return text;
}

}  // namespace headland::training
