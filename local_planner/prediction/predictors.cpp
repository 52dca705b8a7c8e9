// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/predictors.hpp"

#include "local_planner/prediction/learned_predictor.hpp"

namespace headland {
namespace {

template <class Kind, class... Arguments>
PredictorFactory factory_of(const Arguments&... arguments) {
  return [arguments...] { return std::make_unique<Kind>(arguments...); };
}

}  // namespace

Result<PredictorFactory> predictor_factory(PredictorKind kind, const PredictorsConfig& config,
                                           const std::filesystem::path& folder) {
  switch (kind) {
    case PredictorKind::kCompanions:
      return factory_of<CompanionPredictor>(config.companions);
    case PredictorKind::kOrca:
      return factory_of<OrcaPredictor>(config.orca);
    case PredictorKind::kHerd:
      return factory_of<HerdPredictor>(config.herd);
    case PredictorKind::kLearned: {
      const auto network = load_network((folder / config.learned.weights).lexically_normal());
      if (!network) return tl::unexpected<Error>(network.error());
      return factory_of<LearnedPredictor>(*network, config.learned.robot_radius_m);
    }
    case PredictorKind::kConstantVelocity:
      break;
  }
  return factory_of<ConstantVelocityPredictor>(config.constant_velocity);
}

}  // namespace headland
