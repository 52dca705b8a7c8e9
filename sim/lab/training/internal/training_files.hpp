// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sim/lab/training/internal/trainer.hpp"

namespace headland::training {

/// What was trained, how, and how well it predicts windows that it has not seen: markdown.
std::string training_log(const TrainingResult& result, const TrainingSettings& settings,
                         const WindowShape& shape, std::size_t training_windows,
                         const std::vector<CrowdWindow>& test);

/// What libtorch makes of a network on some windows, for the tests of the run-time network.
std::string reference(const ResponseNetwork& network, const WindowShape& shape,
                      const TrainingSettings& settings);

}  // namespace headland::training
