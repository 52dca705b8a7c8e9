// SPDX-License-Identifier: Apache-2.0
// A small reader of its own follows the format's description, from the front and from the index.
#include "sim/lab/mcap_writer.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <tuple>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sim/lab/mcap_messages.hpp"

namespace headland {
namespace {

using std::chrono::milliseconds;

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  bool done() const { return at_ == bytes_.size(); }
  std::string_view take(std::uint64_t count) {
    if (count > bytes_.size() - at_) throw std::runtime_error("the file ends too early");
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  std::uint64_t number(std::size_t size) {
    std::uint64_t value = 0;
    const std::string_view bytes = take(size);
    for (std::size_t i = size; i-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes[i]);
    return value;
  }
  std::string_view text() { return take(number(4)); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

struct Message {
  std::uint64_t channel = 0;
  std::uint64_t sequence = 0;
  std::uint64_t time = 0;
  std::string json;
  bool operator==(const Message&) const = default;
};

struct Recording {
  std::vector<std::string> schemas;  // "id name encoding"
  std::vector<std::string> topics;   // "id schema topic encoding"
  std::vector<Message> messages;
  std::vector<Message> indexed;  // the same, found through the chunk and message indices
  std::uint64_t chunks = 0;
  std::uint64_t counted_messages = 0;  // by the statistics
  std::uint64_t counted_chunks = 0;
  std::vector<int> kinds;  // of the records at top level
};

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

Message read_message(Reader content, std::uint64_t length) {
  Message message;
  message.channel = content.number(2);
  message.sequence = content.number(4);
  message.time = content.number(8);
  EXPECT_EQ(content.number(8), message.time);
  message.json = content.take(length - 22);
  return message;
}

void follow_index(Recording& recording, std::string_view file, Reader entry) {
  entry.number(8);
  entry.number(8);
  Reader chunk(file.substr(entry.number(8)));
  EXPECT_EQ(chunk.number(1), 0x06U);
  const std::uint64_t chunk_length = chunk.number(8);
  EXPECT_EQ(entry.number(8), chunk_length + 9);
  chunk.take(28);
  EXPECT_EQ(chunk.text(), "");
  const std::string_view records = chunk.take(chunk.number(8));
  Reader places(entry.text());
  while (!places.done()) {
    const std::uint64_t channel = places.number(2);
    Reader index(file.substr(places.number(8)));
    EXPECT_EQ(index.number(1), 0x07U);
    index.number(8);
    EXPECT_EQ(index.number(2), channel);
    Reader entries(index.text());
    while (!entries.done()) {
      const std::uint64_t time = entries.number(8);
      Reader message(records.substr(entries.number(8)));
      EXPECT_EQ(message.number(1), 0x05U);
      const std::uint64_t length = message.number(8);
      recording.indexed.push_back(read_message(Reader(message.take(length)), length));
      EXPECT_EQ(recording.indexed.back().time, time);
    }
  }
}

void read_chunk(Recording& recording, Reader content) {
  const std::uint64_t begin = content.number(8);
  const std::uint64_t end = content.number(8);
  const std::uint64_t size = content.number(8);
  EXPECT_EQ(content.number(4), 0U) << "no checksum";
  EXPECT_EQ(content.text(), "");
  EXPECT_EQ(content.number(8), size);
  Reader records(content.take(size));
  ++recording.chunks;
  while (!records.done()) {
    EXPECT_EQ(records.number(1), 0x05U);
    const std::uint64_t length = records.number(8);
    recording.messages.push_back(read_message(Reader(records.take(length)), length));
    EXPECT_GE(recording.messages.back().time, begin);
    EXPECT_LE(recording.messages.back().time, end);
  }
}

Recording read(const std::string& file) {
  Recording recording;
  Reader reader(file);
  EXPECT_EQ(reader.take(8), kMagic);
  bool in_summary = false;
  for (int kind = 0; kind != 0x02;) {
    kind = static_cast<int>(reader.number(1));
    const std::string_view bytes = reader.take(reader.number(8));
    Reader content(bytes);
    recording.kinds.push_back(kind);
    if (kind == 0x0f) in_summary = true;
    if (kind == 0x03 && !in_summary) {
      std::string text = std::to_string(content.number(2)) + " ";
      text += content.text();
      text += " ";
      recording.schemas.push_back(text.append(content.text()));
      EXPECT_TRUE(nlohmann::json::accept(content.text()));
    }
    if (kind == 0x04 && !in_summary) {
      std::string text = std::to_string(content.number(2)) + " ";
      text += std::to_string(content.number(2)) + " ";
      text += content.text();
      text += " ";
      recording.topics.push_back(text.append(content.text()));
    }
    if (kind == 0x06) read_chunk(recording, content);
    if (kind == 0x08) follow_index(recording, file, content);
    if (kind == 0x0b) {
      recording.counted_messages = content.number(8);
      content.take(14);
      recording.counted_chunks = content.number(4);
    }
    if (kind == 0x02) {
      Reader summary(std::string_view(file).substr(content.number(8)));
      EXPECT_EQ(summary.number(1), 0x03U) << "the summary begins with the schemas";
      Reader offsets(std::string_view(file).substr(content.number(8)));
      EXPECT_EQ(offsets.number(1), 0x0eU);
    }
  }
  EXPECT_EQ(reader.take(8), kMagic);
  EXPECT_TRUE(reader.done());
  return recording;
}

std::filesystem::path place(const std::string& name) {
  const auto file = std::filesystem::path(::testing::TempDir()) / ("headland_" + name + ".mcap");
  std::filesystem::remove(file);
  return file;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write_sample(const std::filesystem::path& file) {
  auto writer = McapWriter::open(file);
  ASSERT_TRUE(writer) << to_string(writer.error());
  const auto add = [&](std::string_view topic, const McapSchema& schema) {
    return writer->add_channel(topic, schema.name, schema.json_schema);
  };
  const int pose = add("/t1/pose", kPoseInFrameSchema);
  const int state = add("/t1/state", kVehicleStateSchema);
  for (int i = 0; i < 35; ++i) {
    const RunTime time = milliseconds(100 * i);
    writer->write(pose, time, pose_in_frame_json(time, {1.0 * i, 2.0, 0.5}));
    if (i % 5 == 0) writer->write(state, time, vehicle_state_json(time, {.s_m = 1.0 * i}));
  }
  ASSERT_TRUE(writer->close());
}

TEST(McapWriter, EveryMessageIsReadBackFromTheFrontAndThroughTheIndex) {
  const auto file = place("sample");
  write_sample(file);
  Recording recording = read(bytes_of(file));
  EXPECT_EQ(recording.schemas, (std::vector<std::string>{"1 foxglove.PoseInFrame jsonschema",
                                                         "2 headland.VehicleState jsonschema"}));
  EXPECT_EQ(recording.topics,
            (std::vector<std::string>{"0 1 /t1/pose json", "1 2 /t1/state json"}));
  ASSERT_EQ(recording.messages.size(), 42U);
  EXPECT_EQ(recording.counted_messages, 42U);
  EXPECT_EQ(recording.chunks, 4U) << "one a second";
  EXPECT_EQ(recording.counted_chunks, 4U);
  EXPECT_EQ(recording.messages.front().time, 0U);
  EXPECT_EQ(recording.messages.back().time, 3'400'000'000U);
  EXPECT_EQ(recording.messages.back().sequence, 34U);
  const auto order = [](const Message& a, const Message& b) {
    return std::tie(a.channel, a.sequence) < std::tie(b.channel, b.sequence);
  };
  std::sort(recording.messages.begin(), recording.messages.end(), order);
  std::sort(recording.indexed.begin(), recording.indexed.end(), order);
  EXPECT_EQ(recording.indexed, recording.messages);
}

TEST(McapWriter, SameCallsGiveTheSameBytes) {
  write_sample(place("first"));
  write_sample(place("second"));
  EXPECT_EQ(bytes_of(std::filesystem::path(::testing::TempDir()) / "headland_first.mcap"),
            bytes_of(std::filesystem::path(::testing::TempDir()) / "headland_second.mcap"));
}

TEST(McapWriter, TopicsOfOneSchemaShareItAndMayComeLate) {
  const auto file = place("late");
  auto writer = McapWriter::open(file);
  ASSERT_TRUE(writer);
  const int a = writer->add_channel("/a", "s", "{}");
  writer->write(a, milliseconds(1), "{}");
  const int b = writer->add_channel("/b", "s", "{}");
  writer->write(b, milliseconds(1), "{}");
  ASSERT_TRUE(writer->close());
  const Recording recording = read(bytes_of(file));
  EXPECT_EQ(recording.schemas.size(), 1U);
  EXPECT_EQ(recording.topics.size(), 2U);
  EXPECT_EQ(recording.indexed.size(), 2U);
}

TEST(McapWriter, FileStandsInItsPlaceOnlyOnceItIsClosed) {
  const auto file = place("unclosed");
  {
    auto writer = McapWriter::open(file);
    ASSERT_TRUE(writer);
    EXPECT_FALSE(std::filesystem::exists(file));
  }
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_FALSE(std::filesystem::exists(file.string() + ".part"));
}

TEST(McapWriter, WrongCallsAndFoldersAreReported) {
  const auto missing = McapWriter::open("/proc/none/run.mcap");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kFileNotWritable);
  auto writer = McapWriter::open(place("wrong"));
  ASSERT_TRUE(writer);
  EXPECT_THROW(writer->write(0, milliseconds(0), "{}"), std::invalid_argument);
  const int channel = writer->add_channel("/a", "s", "{}");
  writer->write(channel, milliseconds(5), "{}");
  EXPECT_THROW(writer->write(channel, milliseconds(4), "{}"), std::invalid_argument);
}

TEST(McapMessages, AreJsonWithUnitsAndUnitQuaternions) {
  const RunTime time = milliseconds(1500);
  const auto pose = nlohmann::json::parse(pose_in_frame_json(time, {3.0, -4.0, 1.2}));
  EXPECT_EQ(pose["timestamp"]["sec"], 1);
  EXPECT_EQ(pose["timestamp"]["nsec"], 500'000'000);
  const double z = pose["pose"]["orientation"]["z"];
  const double w = pose["pose"]["orientation"]["w"];
  EXPECT_NEAR(2.0 * std::atan2(z, w), 1.2, 1e-9);
  const auto fix = nlohmann::json::parse(location_fix_json(time, {41.97912345, 2.8212345}));
  EXPECT_NEAR(fix["latitude"], 41.97912345, 1e-8);
  EXPECT_EQ(fix["position_covariance"].size(), 9U);
  const auto state =
      nlohmann::json::parse(vehicle_state_json(time, {.error_m = std::nan(""), .soc = 0.5}));
  EXPECT_TRUE(state["error_m"].is_null());
  EXPECT_EQ(state["soc"], 0.5);
  EXPECT_EQ(state["time_s"], 1.5);
}

}  // namespace
}  // namespace headland
