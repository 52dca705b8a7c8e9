// SPDX-License-Identifier: Apache-2.0
// The records of MCAP: one byte of kind, eight of length, then the content, all little-endian.
#include "sim/lab/mcap_writer.hpp"

#include <stdexcept>
#include <system_error>
#include <type_traits>

#include <fmt/format.h>

namespace headland {
namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr RunTime kChunkTime = std::chrono::seconds(1);

enum class Kind : unsigned char {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

template <class T>
void add(std::string& bytes, T value) {
  static_assert(std::is_unsigned_v<T>);
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes += static_cast<char>(static_cast<unsigned char>(value >> (8 * i)));
  }
}

void add_u16(std::string& bytes, int value) { add(bytes, static_cast<std::uint16_t>(value)); }

void add_time(std::string& bytes, RunTime time) {
  add(bytes, static_cast<std::uint64_t>(time.count()));
}

void add_text(std::string& bytes, std::string_view text) {
  add(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
}

std::string record(Kind kind, std::string_view content) {
  std::string bytes(1, static_cast<char>(kind));
  add(bytes, static_cast<std::uint64_t>(content.size()));
  bytes += content;
  return bytes;
}

tl::unexpected<Error> not_writable(const std::filesystem::path& file, std::string what) {
  return fail(ErrorCode::kFileNotWritable, std::move(what),
              "check the folder's rights and the free space", {file.string(), 0, {}});
}

}  // namespace

McapWriter::McapWriter(std::filesystem::path file)
    : file_(std::move(file)), out_(part(), std::ios::binary | std::ios::trunc) {}

McapWriter::~McapWriter() {
  if (!out_.is_open()) return;  // closed, or moved from
  out_.close();
  std::error_code ignored;
  std::filesystem::remove(part(), ignored);
}

Result<McapWriter> McapWriter::open(const std::filesystem::path& file) {
  McapWriter writer(file);
  if (!writer.out_) return not_writable(file, "cannot be opened for writing");
  std::string header;
  add_text(header, "");  // no profile
  add_text(header, "headland");
  writer.put(kMagic);
  writer.put(record(Kind::kHeader, header));
  return writer;
}

int McapWriter::add_channel(std::string_view topic, std::string_view schema_name,
                            std::string_view json_schema) {
  flush_chunk();  // what chunks refer to stands before them
  auto schema = schemas_.find(schema_name);
  if (schema == schemas_.end()) {
    const int id = static_cast<int>(schemas_.size()) + 1;  // 0 means "no schema"
    schema = schemas_.emplace(schema_name, id).first;
    std::string content;
    add_u16(content, id);
    add_text(content, schema_name);
    add_text(content, "jsonschema");
    add_text(content, json_schema);
    const std::string bytes = record(Kind::kSchema, content);
    schema_records_ += bytes;
    put(bytes);
  }
  const int id = static_cast<int>(channels_.size());
  channels_.emplace_back();
  std::string content;
  add_u16(content, id);
  add_u16(content, schema->second);
  add_text(content, topic);
  add_text(content, "json");
  add_text(content, "");  // no metadata
  const std::string bytes = record(Kind::kChannel, content);
  channel_records_ += bytes;
  put(bytes);
  return id;
}

void McapWriter::write(int channel, RunTime time, std::string_view json) {
  if (channel < 0 || channel >= static_cast<int>(channels_.size()) || time < last_) {
    throw std::invalid_argument(fmt::format(
        "message of channel {} at {} ns: {} channels are known, and times must not fall below {}",
        channel, time.count(), channels_.size(), last_.count()));
  }
  if (!chunk_.records.empty() && time - chunk_.begin >= kChunkTime) flush_chunk();
  if (chunk_.records.empty()) chunk_.begin = time;
  if (messages_ == 0) first_ = time;
  chunk_.end = last_ = time;
  std::string& index = chunk_.index[channel];
  add_time(index, time);
  add(index, static_cast<std::uint64_t>(chunk_.records.size()));
  std::string content;
  add_u16(content, channel);
  add(content, channels_[static_cast<std::size_t>(channel)].messages++);
  add_time(content, time);  // of logging
  add_time(content, time);  // of publishing
  content += json;
  chunk_.records += record(Kind::kMessage, content);
  ++messages_;
}

void McapWriter::put(std::string_view bytes) {
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  offset_ += bytes.size();
}

void McapWriter::flush_chunk() {
  if (chunk_.records.empty()) return;
  std::string content;
  add_time(content, chunk_.begin);
  add_time(content, chunk_.end);
  add(content, static_cast<std::uint64_t>(chunk_.records.size()));
  add(content, std::uint32_t{0});  // no checksum
  add_text(content, "");           // no compression
  add(content, static_cast<std::uint64_t>(chunk_.records.size()));
  content += chunk_.records;
  const std::uint64_t chunk_at = offset_;
  put(record(Kind::kChunk, content));
  const std::uint64_t indices_at = offset_;
  std::string places;  // channel -> where its index stands
  for (const auto& [channel, entries] : chunk_.index) {
    add_u16(places, channel);
    add(places, offset_);
    std::string index;
    add_u16(index, channel);
    add_text(index, entries);
    put(record(Kind::kMessageIndex, index));
  }
  std::string entry;
  add_time(entry, chunk_.begin);
  add_time(entry, chunk_.end);
  add(entry, chunk_at);
  add(entry, indices_at - chunk_at);
  add_text(entry, places);
  add(entry, offset_ - indices_at);
  add_text(entry, "");
  add(entry, static_cast<std::uint64_t>(chunk_.records.size()));
  add(entry, static_cast<std::uint64_t>(chunk_.records.size()));
  chunk_indices_ += record(Kind::kChunkIndex, entry);
  ++chunks_;
  chunk_ = {};
}

std::string McapWriter::statistics() const {
  std::string content;
  add(content, messages_);
  add_u16(content, static_cast<int>(schemas_.size()));
  add(content, static_cast<std::uint32_t>(channels_.size()));
  add(content, std::uint32_t{0});  // attachments
  add(content, std::uint32_t{0});  // metadata
  add(content, chunks_);
  add_time(content, first_);
  add_time(content, last_);
  std::string counts;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    add_u16(counts, static_cast<int>(i));
    add(counts, static_cast<std::uint64_t>(channels_[i].messages));
  }
  add_text(content, counts);
  return record(Kind::kStatistics, content);
}

Result<void> McapWriter::close() {
  flush_chunk();
  put(record(Kind::kDataEnd, std::string(4, '\0')));  // no checksum
  const std::uint64_t summary_at = offset_;
  const std::pair<Kind, std::string> groups[] = {{Kind::kSchema, schema_records_},
                                                 {Kind::kChannel, channel_records_},
                                                 {Kind::kStatistics, statistics()},
                                                 {Kind::kChunkIndex, chunk_indices_}};
  std::string offsets;
  for (const auto& [kind, bytes] : groups) {
    if (bytes.empty()) continue;
    std::string content(1, static_cast<char>(kind));
    add(content, offset_);
    add(content, static_cast<std::uint64_t>(bytes.size()));
    offsets += record(Kind::kSummaryOffset, content);
    put(bytes);
  }
  std::string footer;
  add(footer, summary_at);
  add(footer, offset_);  // where the offsets begin
  add(footer, std::uint32_t{0});
  put(offsets);
  put(record(Kind::kFooter, footer));
  put(kMagic);
  out_.close();
  const bool good = static_cast<bool>(out_);
  std::error_code error;
  if (good) std::filesystem::rename(part(), file_, error);
  if (good && !error) return {};
  const std::string what = error ? error.message() : "cannot be written";
  std::filesystem::remove(part(), error);
  return not_writable(file_, what);
}

std::filesystem::path McapWriter::part() const {
  std::filesystem::path path = file_;
  path += ".part";
  return path;
}

}  // namespace headland
