// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "local_planner/prediction/recurrent_network.hpp"
#include "sim/lab/prediction/crowd_windows.hpp"

namespace headland::training {

/// How much is learnt, from what, for how long.
struct TrainingSettings {
  std::uint64_t seed = 3;
  int embedded = 24;  ///< values that the robot and the neighbours become
  int hidden = 48;    ///< of a cell
  int most_epochs = 10;
  int patience = 2;  ///< epochs without a better validation, then it ends
  int windows_per_batch = 48;
  double rate = 3e-3;  ///< of Adam; falls to last_rate with a cosine
  double last_rate = 1e-4;
  double clip = 1.0;             ///< of the gradient's norm
  double distance_weight = 2.0;  ///< of the mean distance [m] beside the log likelihood
  double data_ratio = 1.0;       ///< of the episodes; less for a try
};

/// Windows for training, for choosing the epoch, and for the figures: their episodes share nothing.
enum class Purpose : std::int8_t { kTraining, kValidation, kTest };
std::vector<CrowdWindow> windows_for(Purpose purpose, const WindowShape& shape,
                                     const TrainingSettings& settings);

struct Epoch {
  double training_loss = 0.0;
  double validation_nll = 0.0;
  double validation_ade_m = 0.0;
  double seconds = 0.0;  ///< since the beginning
};

struct TrainingResult {
  ResponseNetwork network;  ///< of the epoch with the best validation, as its file has it
  std::vector<Epoch> epochs;
};

/// Trains a response network; tells stderr how it goes. Repeatable on one machine and build.
TrainingResult train(const std::vector<CrowdWindow>& training,
                     const std::vector<CrowdWindow>& validation, const WindowShape& shape,
                     const TrainingSettings& settings);

}  // namespace headland::training
