// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/result.hpp"
#include "local_planner/prediction/companions.hpp"
#include "local_planner/prediction/constant_velocity.hpp"
#include "local_planner/prediction/herd_predictor.hpp"
#include "local_planner/prediction/orca_predictor.hpp"

namespace headland {

enum class PredictorKind : std::int8_t {
  kConstantVelocity,
  kCompanions,  ///< constant velocity, shared by people who walk together
  kOrca,        ///< they avoid each other and the robot
  kHerd,        ///< animals flee and stay together; people as kCompanions
  kLearned      ///< LSTM encoder-decoder, told the robot's plan (seed 003)
};

struct LearnedConfig {
  std::string weights = "../models/crowd_response.weights";
  double robot_radius_m = 1.5;

  template <class V>
  void visit(V& v) {
    v("weights", weights, "Its network's file, relative to the configuration's");
    v("robot_radius_m", robot_radius_m, config::kNonNegative,
      "That agents take the robot to have (seed 003: 1.5) [m]");
  }
};

/// The parameters of all predictors.
struct PredictorsConfig {
  ConstantVelocityConfig constant_velocity;
  CompanionConfig companions;
  OrcaConfig orca;
  HerdConfig herd;
  LearnedConfig learned;

  template <class V>
  void visit(V& v) {
    v("constant_velocity", constant_velocity, "Agents that go straight on");
    v("companions", companions, "Likewise, people who walk together as one");
    v("orca", orca, "Agents that give way to each other and to the robot");
    v("herd", herd, "Sheep and cattle");
    v("learned", learned, "Trained on simulated crowds");
  }
};

/// Makes predictors that have seen nothing yet. Safe for several threads at once.
using PredictorFactory = std::function<std::unique_ptr<Predictor>()>;

/// The factory of a kind. `folder` is where relative files begin. Errors: those of load_network.
Result<PredictorFactory> predictor_factory(PredictorKind kind, const PredictorsConfig& config = {},
                                           const std::filesystem::path& folder = {});

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::PredictorKind> {
  static constexpr std::pair<headland::PredictorKind, std::string_view> values[] = {
      {headland::PredictorKind::kConstantVelocity, "constant_velocity"},
      {headland::PredictorKind::kCompanions, "companions"},
      {headland::PredictorKind::kOrca, "orca"},
      {headland::PredictorKind::kHerd, "herd"},
      {headland::PredictorKind::kLearned, "learned"}};
};
