// SPDX-License-Identifier: Apache-2.0
#include "core/base/mcap_writer.hpp"

#include "core/base/error.hpp"

namespace headland {
namespace {

constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
constexpr std::uint64_t kChunkPeriodNs = 10'000'000'000;

enum Opcode : char {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kDataEnd = 0x0F,
};

// Little-endian numbers and length-prefixed texts, as the format has them.
class Bytes {
 public:
  template <class Integer>
  Bytes& number(Integer value) {
    auto bits = static_cast<std::uint64_t>(value);
    for (std::size_t i = 0; i < sizeof(Integer); ++i, bits >>= 8) {
      text_ += static_cast<char>(bits & 0xFF);
    }
    return *this;
  }
  Bytes& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    text_ += value;
    return *this;
  }
  Bytes& raw(std::string_view value) {
    text_ += value;
    return *this;
  }
  std::string record(Opcode opcode) const {
    return std::string(1, opcode) + Bytes().number(std::uint64_t{text_.size()}).text_ + text_;
  }
  const std::string& bytes() const { return text_; }

 private:
  std::string text_;
};

}  // namespace

McapWriter::McapWriter(std::string_view library) : file_(kMagic) {
  file_ += Bytes().text("").text(library).record(kHeader);
}

std::uint16_t McapWriter::add_channel(std::string_view topic, std::string_view schema_name,
                                      std::string_view json_schema) {
  HEADLAND_CHECK(messages_ == 0, "topics come before messages");
  const auto number = static_cast<std::uint16_t>(channels_.size() + 1);
  Channel channel;
  channel.schema_record =
      Bytes().number(number).text(schema_name).text("jsonschema").text(json_schema).record(kSchema);
  channel.channel_record = Bytes()
                               .number(number)
                               .number(number)
                               .text(topic)
                               .text("json")
                               .number(std::uint32_t{0})
                               .record(kChannel);
  file_ += channel.schema_record + channel.channel_record;
  channels_.push_back(std::move(channel));
  return number;
}

void McapWriter::write(std::uint16_t channel_number, std::uint64_t time_ns, std::string_view json) {
  HEADLAND_CHECK(channel_number >= 1 && channel_number <= channels_.size(), "no such channel");
  HEADLAND_CHECK(time_ns >= last_ns_, "messages come in the order of their times");
  if (!chunk_.empty() && time_ns - chunk_begin_ns_ >= kChunkPeriodNs) close_chunk();
  if (chunk_.empty()) chunk_begin_ns_ = time_ns;
  if (messages_ == 0) first_ns_ = time_ns;
  Channel& channel = channels_[channel_number - 1U];
  channel.index += Bytes().number(time_ns).number(std::uint64_t{chunk_.size()}).bytes();
  chunk_ += Bytes()
                .number(channel_number)
                .number(channel.sequence++)
                .number(time_ns)
                .number(time_ns)
                .raw(json)
                .record(kMessage);
  ++channel.messages;
  ++messages_;
  last_ns_ = time_ns;
}

void McapWriter::close_chunk() {
  if (chunk_.empty()) return;
  const std::uint64_t chunk_offset = file_.size();
  const auto size = std::uint64_t{chunk_.size()};
  const std::string chunk = Bytes()
                                .number(chunk_begin_ns_)
                                .number(last_ns_)
                                .number(size)
                                .number(std::uint32_t{0})  // no checksum
                                .text("")                  // no compression
                                .number(size)
                                .raw(chunk_)
                                .record(kChunk);
  file_ += chunk;
  const std::uint64_t indexes_offset = file_.size();
  Bytes offsets;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const auto number = static_cast<std::uint16_t>(i + 1);
    if (channels_[i].index.empty()) continue;
    offsets.number(number).number(std::uint64_t{file_.size()});
    file_ += Bytes().number(number).text(channels_[i].index).record(kMessageIndex);
    channels_[i].index.clear();
  }
  chunk_indexes_.push_back(Bytes()
                               .number(chunk_begin_ns_)
                               .number(last_ns_)
                               .number(chunk_offset)
                               .number(std::uint64_t{chunk.size()})
                               .text(offsets.bytes())
                               .number(file_.size() - indexes_offset)
                               .text("")
                               .number(size)
                               .number(size)
                               .record(kChunkIndex));
  chunk_.clear();
}

std::string McapWriter::finish() {
  close_chunk();
  file_ += Bytes().number(std::uint32_t{0}).record(kDataEnd);
  const std::uint64_t summary_offset = file_.size();
  Bytes counts;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    file_ += channels_[i].schema_record + channels_[i].channel_record;
    counts.number(static_cast<std::uint16_t>(i + 1)).number(channels_[i].messages);
  }
  for (const std::string& index : chunk_indexes_) file_ += index;
  file_ += Bytes()
               .number(messages_)
               .number(static_cast<std::uint16_t>(channels_.size()))
               .number(static_cast<std::uint32_t>(channels_.size()))
               .number(std::uint32_t{0})
               .number(std::uint32_t{0})
               .number(static_cast<std::uint32_t>(chunk_indexes_.size()))
               .number(first_ns_)
               .number(last_ns_)
               .text(counts.bytes())
               .record(kStatistics);
  file_ += Bytes()
               .number(summary_offset)
               .number(std::uint64_t{0})
               .number(std::uint32_t{0})
               .record(kFooter);
  file_ += kMagic;
  return std::move(file_);
}

}  // namespace headland
