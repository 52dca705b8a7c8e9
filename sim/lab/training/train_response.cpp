// SPDX-License-Identifier: Apache-2.0
// Trains the learned predictor on crowds that the simulator makes; see README.md beside this file.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "core/base/random.hpp"
#include "local_planner/prediction/learned_predictor.hpp"
#include "sim/lab/prediction/prediction_score.hpp"
#include "sim/lab/training/internal/response_model.hpp"

namespace headland::training {
namespace {

// What is trained, on how much, for how long.
struct Settings {
  std::uint64_t seed = 3;
  int embedded = 24;
  int hidden = 48;
  int most_epochs = 12;
  int patience = 3;  // epochs without a better validation
  int windows_per_batch = 48;
  double rate = 3e-3;  // falls with a cosine
  double last_rate = 1e-4;
  double clip = 1.0;  // norm of gradients
  double training_scale = 1.0;
};

struct Share {
  CrowdScene scene;
  int training_episodes;
  int validation_episodes;
};

constexpr Share kShares[] = {{CrowdScene::kDense, 450, 20},
                             {CrowdScene::kSparse, 250, 20},
                             {CrowdScene::kCrossing, 900, 60},
                             {CrowdScene::kMixed, 350, 20}};

const Disturbance kTraining{true, kPi, 0.3, 0.15, 1.5, 0.1, 0.2};

std::vector<CrowdWindow> record(const WindowShape& shape, std::uint64_t seed, double scale,
                                int Share::*episodes) {
  std::vector<CrowdWindow> all;
  for (const Share& share : kShares) {
    const int count = std::max(1, static_cast<int>(std::lround(scale * (share.*episodes))));
    auto windows = record_windows(share.scene, shape, count, seed);
    std::move(windows.begin(), windows.end(), std::back_inserter(all));
  }
  return all;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

class Trainer {
 public:
  Trainer(const Settings& settings, const WindowShape& shape)
      : settings_(settings),
        shape_(shape),
        training_(record(shape, settings.seed, settings.training_scale, &Share::training_episodes)),
        validation_(record(shape, settings.seed + 1, 1.0, &Share::validation_episodes)),
        model_(settings.embedded, settings.hidden, settings.seed),
        random_(settings.seed, "batches") {}

  double validate() {
    const torch::NoGradGuard no_gradient;
    double sum = 0.0;
    double count = 0.0;
    RandomStream random(settings_.seed, "validation");
    for (std::size_t begin = 0; begin < validation_.size(); begin += 64) {
      std::vector<const CrowdWindow*> some;
      for (std::size_t i = begin; i < std::min(begin + 64, validation_.size()); ++i) {
        some.push_back(&validation_[i]);
      }
      const Batch batch = make_batch(some, shape_, {}, random);
      const double agents = batch.counts.sum().item<double>();
      sum += agents *
             negative_log_likelihood(model_.forward(batch, shape_), batch.counts).item<double>();
      count += agents;
    }
    return sum / count;
  }

  void run() {
    std::vector<const CrowdWindow*> order;
    for (const CrowdWindow& window : training_) order.push_back(&window);
    torch::optim::Adam optimizer(model_.parameters(), torch::optim::AdamOptions(settings_.rate));
    const auto per_batch = static_cast<std::size_t>(settings_.windows_per_batch);
    const std::size_t batches = order.size() / per_batch;
    const double total = static_cast<double>(batches) * settings_.most_epochs;
    const auto begin = std::chrono::steady_clock::now();
    double best = std::numeric_limits<double>::infinity();
    int waited = 0;
    double done = 0.0;
    for (int epoch = 1; epoch <= settings_.most_epochs && waited < settings_.patience; ++epoch) {
      for (std::size_t i = order.size(); i > 1; --i) {
        std::swap(order[i - 1],
                  order[static_cast<std::size_t>(random_.index(static_cast<int>(i)))]);
      }
      double sum = 0.0;
      for (std::size_t b = 0; b < batches; ++b, done += 1.0) {
        const double phase = 0.5 * (1.0 + std::cos(kPi * done / total));
        const double warm = std::min(1.0, (done + 1.0) / 100.0);
        const double rate =
            warm * (settings_.last_rate + phase * (settings_.rate - settings_.last_rate));
        static_cast<torch::optim::AdamOptions&>(optimizer.param_groups()[0].options()).lr(rate);
        const Batch batch =
            make_batch({order.data() + b * per_batch, per_batch}, shape_, kTraining, random_);
        optimizer.zero_grad();
        auto loss = negative_log_likelihood(model_.forward(batch, shape_), batch.counts);
        loss.backward();
        torch::nn::utils::clip_grad_norm_(model_.parameters(), settings_.clip);
        optimizer.step();
        sum += loss.item<double>();
        if (b % 50 == 49) {
          fmt::print(stderr, "epoch {} batch {}/{} loss {:.4f} {:.0f} s\n", epoch, b + 1, batches,
                     sum / static_cast<double>(b + 1), seconds_since(begin));
        }
      }
      const double validation = validate();
      fmt::print(stderr, "epoch {} training {:.4f} validation {:.4f} {:.0f} s\n", epoch,
                 sum / static_cast<double>(batches), validation, seconds_since(begin));
      log_ += fmt::format("| {} | {:.4f} | {:.4f} | {:.0f} |\n", epoch,
                          sum / static_cast<double>(batches), validation, seconds_since(begin));
      ++waited;
      if (validation < best) {
        best = validation;
        waited = 0;
        best_ = model_.to_network(shape_);
      }
    }
  }

  const ResponseNetwork& best() const { return best_; }
  const std::vector<CrowdWindow>& validation() const { return validation_; }
  std::size_t windows() const { return training_.size(); }

 private:
  Settings settings_;
  WindowShape shape_;
  std::vector<CrowdWindow> training_;
  std::vector<CrowdWindow> validation_;
  ResponseModel model_;
  RandomStream random_;
  ResponseNetwork best_;
  std::string log_;
};

std::string score_table(const ResponseNetwork& network, const std::vector<CrowdWindow>& windows,
                        const WindowShape& shape) {
  std::string table;
  for (const auto& [scene, name] : config::EnumNames<CrowdScene>::values) {
    for (const double near : {1e9, 3.0}) {
      PredictionScorer coasting(shape, near), told(shape, near), untold(shape, near);
      CoastingPredictor coast;
      for (const CrowdWindow& window : windows) {
        if (window.scene != scene) continue;
        LearnedPredictor learned(network, window.robot_radius_m);
        coasting.add(window, coast, RobotForetold::kPlan);
        told.add(window, learned, RobotForetold::kPlan);
        untold.add(window, learned, RobotForetold::kCoasting);
      }
      const PredictionScore c = coasting.score(), t = told.score(), u = untold.score();
      table += fmt::format(
          "{} {} n {} | cv {:.3f}/{:.3f} p95 {:.2f} | untold {:.3f}/{:.3f} | told "
          "{:.3f}/{:.3f} p95 {:.2f} nll {:.2f} in1 {:.3f} in2 {:.3f}\n",
          name, near < 100 ? "near" : "all", t.agents_count, c.ade_m, c.fde_m, c.fde_p95_m, u.ade_m,
          u.fde_m, t.ade_m, t.fde_m, t.fde_p95_m, t.nll, t.within_1_ratio, t.within_2_ratio);
    }
  }
  return table;
}

}  // namespace
}  // namespace headland::training

int main(int count, char** words) {
  using namespace headland;
  using namespace headland::training;
  torch::set_num_threads(1);
  at::set_num_interop_threads(1);
  Settings settings;
  if (count > 2) settings.most_epochs = std::stoi(words[2]);
  if (count > 3) settings.training_scale = std::stod(words[3]);
  if (count > 4) settings.hidden = std::stoi(words[4]);
  const WindowShape shape;
  Trainer trainer(settings, shape);
  fmt::print(stderr, "{} windows, validation {}\n", trainer.windows(), trainer.validation().size());
  trainer.run();
  const std::string text = to_text(trainer.best());
  std::ofstream(words[1]) << text;
  fmt::print("{}", score_table(*parse_network(text, words[1]), trainer.validation(), shape));
}
