// SPDX-License-Identifier: Apache-2.0
// Trains the learned predictor; README.md beside this file says how to call it.
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <torch/torch.h>

#include "sim/lab/training/internal/training_files.hpp"

namespace {

bool write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream stream(path, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) fmt::print(stderr, "{}: cannot be written\n", path.string());
  return static_cast<bool>(stream);
}

}  // namespace

int main(int count, char** words) {
  using namespace headland;
  using namespace headland::training;
  if (count < 3 || count > 4) {
    fmt::print(stderr, "train_response <folder of weights> <folder of reference> [data ratio]\n");
    return 2;
  }
  const std::filesystem::path weights_folder = words[1];
  const std::filesystem::path reference_folder = words[2];
  torch::set_num_threads(1);  // repeatable, and as fast: the batches are small
  TrainingSettings settings;
  if (count == 4) settings.data_ratio = std::stod(words[3]);
  const WindowShape shape;
  const auto training = windows_for(Purpose::kTraining, shape, settings);
  const auto validation = windows_for(Purpose::kValidation, shape, settings);
  fmt::print(stderr, "{} windows, {} for validation\n", training.size(), validation.size());
  TrainingResult result = train(training, validation, shape, settings);

  const std::string text = to_text(result.network);
  const auto network = parse_network(text, "crowd_response.weights");
  if (!network) {
    fmt::print(stderr, "{}\n", to_string(network.error()));
    return 4;
  }
  result.network = *network;  // with the weights rounded as in the file
  const auto test = windows_for(Purpose::kTest, shape, settings);
  const bool written =
      write(weights_folder / "crowd_response.weights", text) &&
      write(weights_folder / "crowd_response.md",
            training_log(result, settings, shape, training.size(), test)) &&
      write(reference_folder / "crowd_response.reference", reference(*network, shape, settings));
  return written ? 0 : 2;
}
