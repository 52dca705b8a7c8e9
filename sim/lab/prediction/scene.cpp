// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/prediction/scene.hpp"

#include <fmt/format.h>

#include "global_planner/mission/mission_config.hpp"

namespace headland {
namespace {

Result<std::vector<TrackSet>> read_tracks(RecordingKind kind, const std::string& file) {
  if (kind == RecordingKind::kSheep) return read_sheep_dog(file);
  auto tracks = read_obsmat(file);
  if (!tracks) return tl::unexpected<Error>(tracks.error());
  return std::vector<TrackSet>{std::move(*tracks)};
}

bool is_in(RecordingPart part, std::size_t index) {
  return part == RecordingPart::kAll || (part == RecordingPart::kOdd) == (index % 2 == 0);
}

}  // namespace

Result<RecordedScene> read_scene(const Recording& recording, const std::string& place,
                                 const std::filesystem::path& folder) {
  const auto file = std::filesystem::absolute(resolve_path(recording.file, folder));
  const auto tracks = read_tracks(recording.kind, file.lexically_normal().string());
  if (!tracks) {
    Error error = tracks.error();
    if (error.code == ErrorCode::kFileNotFound) {
      error.remedy = fmt::format(
          "{}.file is \"{}\"; name another file, or set HEADLAND_DATA to the folder of data", place,
          recording.file);
    }
    return tl::unexpected<Error>(error);
  }
  RecordedScene scene;
  scene.name = recording.name.empty() ? file.parent_path().filename().string() : recording.name;
  if (recording.kind == RecordingKind::kSheep) scene.kind = AgentKind::kSheep;
  for (std::size_t i = 0; i < tracks->size(); ++i) {
    if (!is_in(recording.part, i)) continue;
    scene.recordings.emplace_back((*tracks)[i], recording.noise_m);
  }
  if (scene.recordings.empty()) {
    return fail(ErrorCode::kOutOfRange, fmt::format("{}.part leaves no recording", place),
                "allowed: all", {file.string(), 0, {}});
  }
  return scene;
}

}  // namespace headland
