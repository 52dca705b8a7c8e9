// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "perception/cloud/cloud_file.hpp"

namespace headland {

/// A file below the folder of real lidar data, or none where that is absent.
inline std::optional<std::filesystem::path> real_cloud(const std::string& name) {
  const char* data = std::getenv("HEADLAND_DATA");
  const std::filesystem::path root =
      data != nullptr ? data : std::string(HEADLAND_SOURCE_DIR) + "/../shared/data";
  const auto file = root / "lidar" / name;
  if (!std::filesystem::exists(file)) return std::nullopt;
  return file;
}

}  // namespace headland
