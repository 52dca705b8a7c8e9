// SPDX-License-Identifier: Apache-2.0
#include "apps/output_files.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

namespace headland::apps {

namespace {

// What any command may write; those of an earlier command in the same directory would mislead.
constexpr std::array<std::string_view, 12> kOutputs = {
    "summary.json", "plan.geojson", "metrics.json", "trace.csv",   "run.mcap",      "results.json",
    "episodes.csv", "times.csv",    "report.json",  "report.html", "solution.json", "solution.sol"};

tl::unexpected<Error> cannot_write(const std::filesystem::path& path, const std::string& why) {
  return fail(ErrorCode::kFileNotWritable, "cannot be written: " + why,
              "choose another directory with --out", {path.string(), 0, ""});
}

}  // namespace

Result<void> prepare_output(const std::filesystem::path& directory) {
  std::error_code code;
  std::filesystem::create_directories(directory, code);
  if (code) return cannot_write(directory, code.message());
  const auto probe = directory / ".headland.part";
  std::ofstream stream(probe);
  stream << "x";
  stream.close();
  const bool written = static_cast<bool>(stream);
  std::filesystem::remove(probe, code);
  if (!written) return cannot_write(directory, "no file can be made there");
  for (const std::string_view name : kOutputs) {
    if (std::filesystem::is_directory(directory / name, code)) {
      return cannot_write(directory / name, "it is a directory");
    }
  }
  return {};
}

Result<void> write_files(const std::filesystem::path& directory,
                         const std::map<std::string, std::string>& files,
                         const std::vector<std::string>& kept) {
  if (auto ready = prepare_output(directory); !ready) return ready;
  std::error_code code;
  for (const auto& [name, content] : files) {
    std::ofstream stream(directory / (name + ".part"), std::ios::binary);
    stream << content;
    stream.close();
    if (stream) continue;
    for (const auto& [part, unused] : files) {
      std::filesystem::remove(directory / (part + ".part"), code);
    }
    return cannot_write(directory / name, "no space left, or the file system failed");
  }
  for (const std::string_view name : kOutputs) {
    const bool stays = files.contains(std::string(name)) ||
                       std::find(kept.begin(), kept.end(), name) != kept.end();
    if (!stays) std::filesystem::remove(directory / name, code);
  }
  for (const auto& [name, content] : files) {
    std::filesystem::rename(directory / (name + ".part"), directory / name, code);
    if (code) return cannot_write(directory / name, code.message());
  }
  return {};
}

std::string report_line(const std::filesystem::path& directory) {
  return "report     " +
         (std::filesystem::absolute(directory) / "report.html").lexically_normal().string() + "\n";
}

}  // namespace headland::apps
