// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/training/internal/trainer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "core/geometry/angle.hpp"
#include "sim/lab/training/internal/response_model.hpp"

namespace headland::training {
namespace {

struct Share {
  CrowdScene scene;
  int training_episodes;
  int other_episodes;  // of validation, and of test
};

constexpr Share kShares[] = {{CrowdScene::kDense, 900, 20},
                             {CrowdScene::kSparse, 500, 20},
                             {CrowdScene::kCrossing, 3000, 60},
                             {CrowdScene::kMixed, 700, 20}};

constexpr Disturbance kDisturbance{true, kPi, 0.3, 0.15, 1.5, 0.1, 0.2};

torch::Tensor mean_distance(const Forecast& forecast, const torch::Tensor& counts) {
  const torch::Tensor distance = (forecast.error.square().sum(-1) + 1e-4).sqrt();
  return (distance * counts.unsqueeze(-1)).sum() / (counts.sum() * distance.size(-1));
}

class Trainer {
 public:
  Trainer(const std::vector<CrowdWindow>& training, const std::vector<CrowdWindow>& validation,
          const WindowShape& shape, const TrainingSettings& settings)
      : validation_(validation),
        shape_(shape),
        settings_(settings),
        model_(settings.embedded, settings.hidden, settings.seed),
        optimizer_(model_.parameters(), torch::optim::AdamOptions(settings.rate)),
        random_(settings.seed, "training") {
    for (const CrowdWindow& window : training) order_.push_back(&window);
  }

  TrainingResult run() {
    TrainingResult result;
    double best = std::numeric_limits<double>::infinity();
    int waited = 0;
    for (int e = 1; e <= settings_.most_epochs && waited < settings_.patience; ++e, ++waited) {
      Epoch epoch;
      epoch.training_loss = learn();
      validate(epoch);
      epoch.seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
      result.epochs.push_back(epoch);
      fmt::print(stderr, "epoch {}: loss {:.4f}, validation {:.4f} nats, {:.4f} m, {:.0f} s\n", e,
                 epoch.training_loss, epoch.validation_nll, epoch.validation_ade_m, epoch.seconds);
      const double loss = epoch.validation_nll + settings_.distance_weight * epoch.validation_ade_m;
      if (loss < best) {
        best = loss;
        waited = -1;
        result.network = model_.to_network(shape_);
      }
    }
    return result;
  }

 private:
  using Clock = std::chrono::steady_clock;

  // One epoch; its mean loss.
  double learn() {
    for (std::size_t i = order_.size(); i > 1; --i) {
      std::swap(order_[i - 1],
                order_[static_cast<std::size_t>(random_.index(static_cast<int>(i)))]);
    }
    const auto size = static_cast<std::size_t>(settings_.windows_per_batch);
    const std::size_t batches = std::max<std::size_t>(1, order_.size() / size);
    double sum = 0.0;
    for (std::size_t b = 0; b < batches; ++b) {
      set_rate(batches);
      const std::size_t begin = b * size;
      const Batch batch = make_batch({order_.data() + begin, std::min(size, order_.size() - begin)},
                                     shape_, kDisturbance, random_);
      optimizer_.zero_grad();
      const Forecast forecast = model_.forward(batch, shape_);
      torch::Tensor loss = negative_log_likelihood(forecast, batch.counts) +
                           settings_.distance_weight * mean_distance(forecast, batch.counts);
      loss.backward();
      torch::nn::utils::clip_grad_norm_(model_.parameters(), settings_.clip);
      optimizer_.step();
      sum += loss.item<double>();
      if (b % 100 == 99) {
        fmt::print(stderr, "  {} of {}: loss {:.4f}\n", b + 1, batches,
                   sum / static_cast<double>(b + 1));
      }
    }
    return sum / static_cast<double>(batches);
  }

  // A hundred batches to warm up, then a cosine.
  void set_rate(std::size_t batches) {
    const double total = static_cast<double>(batches) * settings_.most_epochs;
    const double falling = 0.5 * (1.0 + std::cos(kPi * batches_done_ / total));
    const double warm = std::min(1.0, (batches_done_ + 1.0) / 100.0);
    const double rate =
        warm * (settings_.last_rate + falling * (settings_.rate - settings_.last_rate));
    static_cast<torch::optim::AdamOptions&>(optimizer_.param_groups()[0].options()).lr(rate);
    batches_done_ += 1.0;
  }

  void validate(Epoch& epoch) const {
    const torch::NoGradGuard no_gradient;
    RandomStream random(settings_.seed, "validation");
    double count = 0.0;
    constexpr std::size_t kSize = 64;
    for (std::size_t begin = 0; begin < validation_.size(); begin += kSize) {
      std::vector<const CrowdWindow*> some;
      for (std::size_t i = begin; i < std::min(begin + kSize, validation_.size()); ++i) {
        some.push_back(&validation_[i]);
      }
      const Batch batch = make_batch(some, shape_, {}, random);
      const Forecast forecast = model_.forward(batch, shape_);
      const double agents = batch.counts.sum().item<double>();
      count += agents;
      epoch.validation_nll +=
          agents * negative_log_likelihood(forecast, batch.counts).item<double>();
      epoch.validation_ade_m += agents * mean_distance(forecast, batch.counts).item<double>();
    }
    epoch.validation_nll /= count;
    epoch.validation_ade_m /= count;
  }

  const std::vector<CrowdWindow>& validation_;
  WindowShape shape_;
  TrainingSettings settings_;
  ResponseModel model_;
  torch::optim::Adam optimizer_;
  RandomStream random_;
  std::vector<const CrowdWindow*> order_;
  double batches_done_ = 0.0;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace

std::vector<CrowdWindow> windows_for(Purpose purpose, const WindowShape& shape,
                                     const TrainingSettings& settings) {
  std::vector<CrowdWindow> all;
  for (const Share& share : kShares) {
    const bool training = purpose == Purpose::kTraining;
    const double episodes = training ? settings.data_ratio * share.training_episodes
                                     : static_cast<double>(share.other_episodes);
    auto windows =
        record_windows(share.scene, shape, std::max(1, static_cast<int>(std::lround(episodes))),
                       settings.seed + static_cast<std::uint64_t>(purpose));
    std::move(windows.begin(), windows.end(), std::back_inserter(all));
  }
  return all;
}

TrainingResult train(const std::vector<CrowdWindow>& training,
                     const std::vector<CrowdWindow>& validation, const WindowShape& shape,
                     const TrainingSettings& settings) {
  return Trainer(training, validation, shape, settings).run();
}

}  // namespace headland::training
