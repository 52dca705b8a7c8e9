// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"

namespace headland {

/// Time since the start of a run.
using RunTime = std::chrono::nanoseconds;

/// Writes a recording as MCAP (version 0 of the format, https://mcap.dev/spec): JSON messages in
/// uncompressed chunks of one second, each with its index, and a summary at the end, so that a
/// viewer can seek. Same calls, same bytes. The file stands beside its place (".part") until it is
/// closed; one that is never closed is removed. Not thread-safe.
class McapWriter {
 public:
  static Result<McapWriter> open(const std::filesystem::path& file);

  McapWriter(McapWriter&&) = default;
  McapWriter& operator=(McapWriter&&) = delete;
  ~McapWriter();

  /// Announces a topic before its first message; messages follow a JSON Schema. Topics that name
  /// the same schema share it. Returns the channel's number for `write`.
  int add_channel(std::string_view topic, std::string_view schema_name,
                  std::string_view json_schema);

  /// Adds one message; times must not fall.
  void write(int channel, RunTime time, std::string_view json);

  /// Finishes the file and moves it to its place. Error kFileNotWritable. Call once.
  Result<void> close();

 private:
  struct Chunk {
    RunTime begin{0};
    RunTime end{0};
    std::string records;
    std::map<int, std::string> index;  // of each channel: time and offset of its messages
  };
  struct Channel {
    std::uint32_t messages = 0;
    RunTime last{0};
  };

  explicit McapWriter(std::filesystem::path file);
  void put(std::string_view bytes);
  void flush_chunk();
  std::string statistics() const;
  std::filesystem::path part() const;

  std::filesystem::path file_;
  std::ofstream out_;
  std::uint64_t offset_ = 0;  // bytes written
  Chunk chunk_;
  std::vector<Channel> channels_;
  std::map<std::string, int, std::less<>> schemas_;
  std::string schema_records_;
  std::string channel_records_;
  std::string chunk_indices_;
  std::uint32_t chunks_ = 0;
  std::uint64_t messages_ = 0;
  RunTime first_{0};
  RunTime last_{0};
};

}  // namespace headland
