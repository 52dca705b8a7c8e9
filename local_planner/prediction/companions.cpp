// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/companions.hpp"

#include <cmath>

namespace headland {
namespace {

constexpr double kNoCompanion = 9.0;  // exponent from which on weights are nothing

}  // namespace

void companion_velocities(const CompanionModel& model, std::span<const FilteredAgent> agents,
                          std::vector<Point2>& velocities) {
  const double near2 = model.near_m * model.near_m;
  const double alike2 = model.alike_mps * model.alike_mps;
  velocities.clear();
  for (const FilteredAgent& self : agents) {
    Point2 sum = self.velocity;
    double weights = 1.0;
    if (self.kind == AgentKind::kPerson) {
      for (const FilteredAgent& other : agents) {
        if (&other == &self || other.kind != AgentKind::kPerson) continue;
        const double unlike = (other.position - self.position).squaredNorm() / near2 +
                              (other.velocity - self.velocity).squaredNorm() / alike2;
        if (unlike > kNoCompanion) continue;
        const double weight = std::exp(-unlike);
        sum += weight * other.velocity;
        weights += weight;
      }
    }
    velocities.push_back(sum / weights);
  }
}

double way_after(const CompanionModel& model, AgentKind kind, double t) {
  if (kind != AgentKind::kPerson) return t;
  return -model.stopping_s * std::expm1(-t / model.stopping_s);
}

CompanionPredictor::CompanionPredictor(const CompanionConfig& config)
    : config_(config), filter_(config.filter) {}

void CompanionPredictor::observe(std::span<const Agent> agents, const Point2&, const Point2&,
                                 double time_s) {
  filter_.observe(agents, time_s);
  companion_velocities(config_.companions, filter_.seen(), velocities_);
}

void CompanionPredictor::predict(std::span<const Point2>, double step_s, int steps,
                                 Prediction& prediction) const {
  const auto agents = filter_.seen();
  begin_prediction(agents, config_.spread, step_s, steps, prediction);
  auto mean = prediction.mean.begin();
  for (std::size_t i = 0; i < agents.size(); ++i) {
    for (int k = 1; k <= prediction.steps; ++k) {
      const double way = way_after(config_.companions, agents[i].kind, k * step_s);
      *mean++ = agents[i].position + way * velocities_[i];
    }
  }
}

}  // namespace headland
