// SPDX-License-Identifier: Apache-2.0
#include "core/base/mcap_writer.hpp"

#include <cstring>

#include <gtest/gtest.h>

namespace headland {
namespace {

struct Record {
  int opcode = 0;
  std::string content;
};

std::uint64_t number(const std::string& bytes, std::size_t at, int size) {
  std::uint64_t value = 0;
  for (int i = size - 1; i >= 0; --i) {
    value = value << 8 | static_cast<unsigned char>(bytes.at(at + static_cast<std::size_t>(i)));
  }
  return value;
}

std::vector<Record> records(const std::string& bytes, std::size_t begin, std::size_t end) {
  std::vector<Record> found;
  while (begin < end) {
    const std::uint64_t size = number(bytes, begin + 1, 8);
    found.push_back({bytes.at(begin), bytes.substr(begin + 9, size)});
    begin += 9 + size;
  }
  EXPECT_EQ(begin, end);
  return found;
}

std::string recording(int messages) {
  McapWriter writer("test");
  const auto pose = writer.add_channel("/pose", "Pose", "{}");
  const auto soc = writer.add_channel("/soc", "Soc", "{}");
  for (int i = 0; i < messages; ++i) {
    writer.write(i % 2 == 0 ? pose : soc, static_cast<std::uint64_t>(i) * 1'000'000'000,
                 "{\"i\":" + std::to_string(i) + "}");
  }
  return writer.finish();
}

TEST(McapWriter, StartsAndEndsWithTheMagicAndParsesAsRecords) {
  const std::string file = recording(25);
  const std::string magic("\x89MCAP0\r\n", 8);
  EXPECT_EQ(file.substr(0, 8), magic);
  EXPECT_EQ(file.substr(file.size() - 8), magic);
  const auto all = records(file, 8, file.size() - 8);
  EXPECT_EQ(all.front().opcode, 0x01);
  EXPECT_EQ(all.back().opcode, 0x02);
}

TEST(McapWriter, ChunksHoldAllMessagesInOrder) {
  const std::string file = recording(25);
  int next = 0;
  for (const Record& record : records(file, 8, file.size() - 8)) {
    if (record.opcode != 0x06) continue;
    const std::size_t head = 8 + 8 + 8 + 4 + 4 + 8;
    for (const Record& message : records(record.content, head, record.content.size())) {
      ASSERT_EQ(message.opcode, 0x05);
      EXPECT_EQ(number(message.content, 6, 8), static_cast<std::uint64_t>(next) * 1'000'000'000);
      EXPECT_EQ(message.content.substr(22), "{\"i\":" + std::to_string(next) + "}");
      ++next;
    }
  }
  EXPECT_EQ(next, 25);
}

TEST(McapWriter, IndexesPointToWhatTheyName) {
  const std::string file = recording(25);
  const auto all = records(file, 8, file.size() - 8);
  int chunks = 0;
  for (const Record& record : all) {
    if (record.opcode != 0x08) continue;
    ++chunks;
    const std::uint64_t offset = number(record.content, 16, 8);
    EXPECT_EQ(file.at(offset), 0x06);
    EXPECT_EQ(number(record.content, 24, 8), 9 + number(file, offset + 1, 8));
    const std::uint64_t first_index = number(record.content, 36 + 2, 8);
    EXPECT_EQ(file.at(first_index), 0x07);
    // The first entry of that index leads to a message of its channel inside the chunk.
    const std::size_t entry = first_index + 9 + 2 + 4;
    const std::uint64_t message = offset + 9 + 40 + number(file, entry + 8, 8);
    EXPECT_EQ(file.at(message), 0x05);
    EXPECT_EQ(number(file, message + 9, 2), number(file, first_index + 9, 2));
  }
  EXPECT_EQ(chunks, 3);
  const std::uint64_t summary = number(all.back().content, 0, 8);
  EXPECT_EQ(file.at(summary), 0x03);
}

TEST(McapWriter, StatisticsCountTheMessages) {
  for (const Record& record : records(recording(25), 8, recording(25).size() - 8)) {
    if (record.opcode == 0x0B) {
      EXPECT_EQ(number(record.content, 0, 8), 25u);
    }
  }
}

TEST(McapWriter, AnEmptyRecordingIsValid) {
  const std::string file = recording(0);
  EXPECT_GT(records(file, 8, file.size() - 8).size(), 5u);
}

}  // namespace
}  // namespace headland
