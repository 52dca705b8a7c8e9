// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace headland {

/// Writes an MCAP recording (mcap.dev, format version 0) into memory: JSON messages on named
/// topics, uncompressed chunks with their indexes, a summary. Foxglove, Lichtblick and rosbag2 read
/// it.
class McapWriter {
 public:
  explicit McapWriter(std::string_view library);

  /// Registers a topic whose messages are JSON of the named schema (JSON Schema text); returns its
  /// number. Before the first message.
  std::uint16_t add_channel(std::string_view topic, std::string_view schema_name,
                            std::string_view json_schema);
  /// Times are in nanoseconds and must not decrease.
  void write(std::uint16_t channel, std::uint64_t time_ns, std::string_view json);
  /// The whole file. The writer is spent afterwards.
  std::string finish();

 private:
  struct Channel {
    std::string schema_record;
    std::string channel_record;
    std::uint32_t sequence = 0;
    std::uint64_t messages = 0;
    std::string index;  // of the open chunk: (time, offset) pairs
  };
  void close_chunk();

  std::string file_;
  std::vector<Channel> channels_;
  std::string chunk_;
  std::uint64_t chunk_begin_ns_ = 0;
  std::uint64_t last_ns_ = 0;
  std::uint64_t first_ns_ = 0;
  std::uint64_t messages_ = 0;
  std::vector<std::string> chunk_indexes_;
};

}  // namespace headland
