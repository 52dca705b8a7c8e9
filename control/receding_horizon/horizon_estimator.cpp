// SPDX-License-Identifier: Apache-2.0
#include "control/receding_horizon/horizon_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "control/estimation/ekf_estimator.hpp"
#include "control/receding_horizon/internal/estimation_window.hpp"

namespace headland {
namespace {

// Lengths of the blocks of a full window, oldest first.
std::vector<int> block_lengths(const HorizonEstimatorConfig& config, int intervals) {
  if (config.blocking == NoiseBlocking::kNone) {
    return std::vector<int>(static_cast<std::size_t>(intervals), 1);
  }
  std::vector<int> lengths;  // newest first
  const int even = std::max(1, (intervals + config.blocks_count - 1) / config.blocks_count);
  int longer = 1;
  int shorter = 0;
  for (int left = intervals; left > 0;) {
    const int wanted = config.blocking == NoiseBlocking::kUniform ? even : longer;
    lengths.push_back(std::min(left, wanted));
    left -= lengths.back();
    longer += std::exchange(shorter, longer);  // 1, 1, 2, 3, 5, ...
  }
  std::reverse(lengths.begin(), lengths.end());
  return lengths;
}

}  // namespace

HorizonEstimator::HorizonEstimator(const Vehicle& vehicle, const EstimationConfig& model,
                                   const HorizonEstimatorConfig& config, double cycle)
    : model_(vehicle, model),
      config_(config),
      log_(vehicle, cycle, config.window_s + 2.0 * config.period_s),
      stride_(std::max(1, static_cast<int>(std::lround(config.period_s / cycle)))),
      most_(std::max(1, static_cast<int>(std::lround(config.window_s / (stride_ * cycle))))),
      block_lengths_(block_lengths(config, most_)),
      prior_(model_),
      window_(std::make_unique<control::internal::EstimationWindow>(model_, log_, stride_, most_,
                                                                    block_lengths_)) {}
HorizonEstimator::~HorizonEstimator() = default;

void HorizonEstimator::reset(const VehicleState& start, double now) {
  log_.reset(now);
  newest_ = model_.vector_of(start, {});
  prior_.reset(newest_, model_.first_covariance());
  variance_ = prior_.covariance().diagonal();
  prior_inflation_.setOnes();
  window_->begin_at(newest_);
  solved_at_ = 0;
}

// After a failure: the window begins again with the prior, and that with what is known by heart.
void HorizonEstimator::restart() {
  if (!prior_.finite()) prior_.reset(newest_, model_.first_covariance());
  prior_inflation_.setOnes();
  window_->begin_at(prior_.state());
}

// The window's begin moves on: the prior filters what leaves it, and knows of steps from the
// smoothed window.
void HorizonEstimator::advance_base() {
  const long base = log_.now() - static_cast<long>(most_) * stride_;
  if (base <= log_.base()) return;
  log_.replay(prior_, base, prior_inflation_);
  window_->drop_oldest((base - log_.base()) / stride_);
  log_.forget_before(base);
}

// Taken from one cycle to another by the commands alone.
EstimateVector HorizonEstimator::coasted(EstimateVector state, long from, long to) const {
  for (long cycle = from; cycle < to; ++cycle) {
    state = model_.coast(state, log_.acting(cycle), log_.cycle());
  }
  return state;
}

bool HorizonEstimator::solve() {
  const double freedom = config_.tail_freedom_count;
  const bool heavy_tailed = freedom > 0.0;
  if (heavy_tailed) {
    window_->weigh_changes(freedom);
    window_->doubt_the_newest(config_.fresh_s, config_.fresh_weight);
  }
  for (int i = 0; i < config_.iterations_count; ++i) {
    if (!window_->improve(prior_)) return false;
    if (heavy_tailed) window_->weigh_changes(freedom);
  }
  return true;
}

Estimate HorizonEstimator::update(std::span<const Measurement> measured, const Command& last,
                                  double now) {
  log_.take(measured, last, now);
  bool good = true;
  if (log_.now() >= solved_at_ + stride_) {
    advance_base();
    window_->extend();
    good = solve();
    prior_inflation_ = window_->oldest_trust().cwiseInverse();
    const long solved_at = log_.base() + static_cast<long>(window_->length()) * stride_;
    if (good) {
      newest_ = window_->newest();
      variance_ = window_->variance();
    } else {
      newest_ = coasted(newest_, solved_at_, solved_at);
    }
    solved_at_ = solved_at;
  }
  EstimateVector state = coasted(newest_, solved_at_, log_.now());
  model_.keep_bounds(state);
  Estimate estimate = make_estimate(model_, log_, state, variance_.cwiseMax(0.0));
  if (!good) {
    estimate.status = EstimateStatus::kFailed;
    restart();
  }
  return estimate;
}

}  // namespace headland
