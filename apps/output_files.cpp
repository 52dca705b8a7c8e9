// SPDX-License-Identifier: Apache-2.0
#include "apps/output_files.hpp"

#include <fstream>

namespace headland::apps {

Result<void> write_files(const std::filesystem::path& directory,
                         const std::map<std::string, std::string>& files) {
  const auto failed = [](const std::filesystem::path& path, const std::string& why) {
    return fail(ErrorCode::kFileNotWritable, "cannot be written: " + why,
                "choose another directory with --out", {path.string(), 0, ""});
  };
  std::error_code code;
  std::filesystem::create_directories(directory, code);
  if (code) return failed(directory, code.message());
  for (const auto& [name, content] : files) {
    const auto temporary = directory / (name + ".part");
    std::ofstream stream(temporary, std::ios::binary);
    stream << content;
    stream.close();
    if (!stream) {
      std::filesystem::remove(temporary, code);
      return failed(temporary, "write error");
    }
  }
  for (const auto& [name, content] : files) {
    std::filesystem::rename(directory / (name + ".part"), directory / name, code);
    if (code) return failed(directory / name, code.message());
  }
  return {};
}

std::string report_line(const std::filesystem::path& directory) {
  return "report     " +
         (std::filesystem::absolute(directory) / "report.html").lexically_normal().string() + "\n";
}

}  // namespace headland::apps
