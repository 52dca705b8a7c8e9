// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "sim/lab/prediction/sampled_tracks.hpp"
#include "sim/lab/prediction_study.hpp"

namespace headland {

/// What a study reads from one file.
struct RecordedScene {
  std::string name;
  AgentKind kind = AgentKind::kPerson;    ///< whose errors count
  std::vector<SampledTracks> recordings;  ///< at least one
};

/// Reads a file of the study; `place` is its key there, such as `tracks[0]`, for errors.
Result<RecordedScene> read_scene(const Recording& recording, const std::string& place,
                                 const std::filesystem::path& folder);

}  // namespace headland
