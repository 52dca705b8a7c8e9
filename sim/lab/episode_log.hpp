// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/result.hpp"

namespace headland {

/// Which episode of a study.
struct EpisodeKey {
  int cell = 0;
  int run = 0;
  auto operator<=>(const EpisodeKey&) const = default;
};

/// The rows that an episode gives to a file, at least one.
using EpisodeRows = std::vector<std::vector<double>>;

/// A CSV file of episodes that grows while a study runs and outlives its sudden end: an episode is
/// appended whole and flushed; what was cut off or damaged is recognised by what each line says of
/// its episode, and left out. Numbers read back are the ones written, to the bit. The first line
/// names the study and the configuration, the second the columns. Not thread-safe.
class EpisodeLog {
 public:
  /// `cells` are the names that stand for EpisodeKey::cell, without commas or line breaks;
  /// `config_hash` stands for all that the episodes depend on.
  EpisodeLog(std::filesystem::path file, const std::string& study, std::uint64_t config_hash,
             std::vector<std::string> columns, std::vector<std::string> cells);

  /// The whole episodes of the file; none if it is absent, or is something else than such a file.
  /// kFileNotWritable if they are of another study or configuration.
  Result<std::map<EpisodeKey, EpisodeRows>> read() const;
  /// The file anew, in order; the file that is there stays whole until then.
  Result<void> write(const std::map<EpisodeKey, EpisodeRows>& episodes) const;
  /// One episode more. Requires that the file was written.
  Result<void> append(const EpisodeKey& key, const EpisodeRows& rows) const;

 private:
  std::string lines_of(const EpisodeKey& key, const EpisodeRows& rows) const;

  std::filesystem::path file_;
  std::string title_;
  std::vector<std::string> columns_;
  std::vector<std::string> cells_;
};

}  // namespace headland
