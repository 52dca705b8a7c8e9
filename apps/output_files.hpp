// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/result.hpp"

namespace headland::apps {

/// Makes the directory and checks that files can be written there, before hours of work are.
Result<void> prepare_output(const std::filesystem::path& directory);

/// Writes all files into a directory (created if absent), each under a temporary name first: an
/// interrupted command leaves no half-written file. Outputs of earlier commands that this one does
/// not write are removed, but for those `kept`. Name -> content.
Result<void> write_files(const std::filesystem::path& directory,
                         const std::map<std::string, std::string>& files,
                         const std::vector<std::string>& kept = {});

/// The line that ends a command's output: where its report is.
std::string report_line(const std::filesystem::path& directory);

}  // namespace headland::apps
