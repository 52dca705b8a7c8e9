// SPDX-License-Identifier: Apache-2.0
#include "perception/cloud/cloud_file.hpp"

#include <cstring>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/random.hpp"
#include "tests/perception/cloud/real_clouds.hpp"

namespace headland {
namespace {

using ::testing::HasSubstr;

std::filesystem::path write_file(const std::string& name, const std::string& content) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("headland_" + std::to_string(::getpid()) + "_" + name);
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

Result<LidarScan> load_text(const std::string& name, const std::string& content) {
  const auto file = write_file(name, content);
  auto scan = load_cloud(file);
  std::filesystem::remove(file);
  return scan;
}

template <class T>
std::string bytes(T value) {
  std::string text(sizeof value, '\0');
  std::memcpy(text.data(), &value, sizeof value);
  return text;
}

std::string pcd(const std::string& fields, const std::string& sizes, const std::string& types,
                int points, const std::string& data) {
  return "# a comment\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types +
         "\nWIDTH " + std::to_string(points) + "\nHEIGHT 1\nPOINTS " + std::to_string(points) +
         "\nDATA " + data;
}

LidarScan random_scan(int points) {
  RandomStream random(1, "scan");
  LidarScan scan;
  scan.time_s = 1234.5;
  for (int i = 0; i < points; ++i) {
    scan.points.push_back({{static_cast<float>(random.uniform(-50.0, 50.0)),
                            static_cast<float>(random.uniform(-50.0, 50.0)),
                            static_cast<float>(random.uniform(-2.0, 5.0))},
                           static_cast<float>(random.uniform()),
                           static_cast<float>(i) * 1e-4f,
                           static_cast<std::uint16_t>(random.index(16))});
  }
  return scan;
}

TEST(CloudFile, WhatIsSavedIsReadAgain) {
  const LidarScan saved = random_scan(100);
  const auto file = write_file("saved.pcd", "");
  ASSERT_FALSE(save_pcd(saved, file));
  const auto read = load_cloud(file);
  std::filesystem::remove(file);
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->time_s, saved.time_s);
  ASSERT_EQ(read->points.size(), saved.points.size());
  for (std::size_t i = 0; i < saved.points.size(); ++i) {
    EXPECT_EQ(read->points[i].position, saved.points[i].position);
    EXPECT_EQ(read->points[i].intensity, saved.points[i].intensity);
    EXPECT_NEAR(read->points[i].offset_s, saved.points[i].offset_s, 1e-7);
    EXPECT_EQ(read->points[i].ring, saved.points[i].ring);
  }
}

TEST(CloudFile, AsciiPcdWithAnyOrderAndTypesOfFields) {
  const auto scan = load_text(
      "a.pcd", pcd("ring z y x t intensity", "2 4 8 4 8 1", "U F F F U U", 3,
                   "ascii\n7 3 2 1 1000000000 255\n8 nan 2 1 0 0\n\n9 -3 -2 -1e1 500000000 51\n"));
  ASSERT_TRUE(scan) << to_string(scan.error());
  ASSERT_EQ(scan->points.size(), 2u) << "the one that is not finite is left out";
  EXPECT_EQ(scan->points[0].position, Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(scan->points[0].ring, 7);
  EXPECT_FLOAT_EQ(scan->points[0].intensity, 1.0f);
  EXPECT_FLOAT_EQ(scan->points[0].offset_s, 0.5f) << "integers are nanoseconds";
  EXPECT_EQ(scan->points[1].position, Eigen::Vector3f(-10, -2, -3));
  EXPECT_FLOAT_EQ(scan->points[1].intensity, 0.2f);
}

TEST(CloudFile, BinaryPcdWithPaddingAndBytes) {
  std::string data;
  for (int i = 0; i < 2; ++i) {
    data += bytes(1.0f + static_cast<float>(i)) + bytes(std::int32_t{-1}) + bytes(2.0f) +
            bytes(3.0f) + bytes(std::uint8_t{51});
  }
  const std::string header =
      pcd("x _ y z intensity", "4 1 4 4 1", "F U F F U\nCOUNT 1 4 1 1 1", 2, "binary\n");
  const auto scan = load_text("b.pcd", header + data);
  ASSERT_TRUE(scan) << to_string(scan.error());
  ASSERT_EQ(scan->points.size(), 2u);
  EXPECT_EQ(scan->points[1].position, Eigen::Vector3f(2, 2, 3));
  EXPECT_FLOAT_EQ(scan->points[1].intensity, 0.2f);
}

TEST(CloudFile, CompressedPcdWithRunsAndCopies) {
  // 48 times 0x3f: one plain byte, and a copy of 47 bytes from one back.
  const std::string packed = std::string("\x00\x3f", 2) + std::string("\xe0\x26\x00", 3);
  const std::string data = bytes(std::uint32_t{5}) + bytes(std::uint32_t{48}) + packed;
  const auto scan =
      load_text("c.pcd", pcd("x y z", "4 4 4", "F F F", 4, "binary_compressed\n" + data));
  ASSERT_TRUE(scan) << to_string(scan.error());
  ASSERT_EQ(scan->points.size(), 4u);
  EXPECT_NEAR(scan->points[3].position.z(), 0.747059, 1e-6) << "0x3f3f3f3f as a float";
}

TEST(CloudFile, PlyInTextAndInBothEndiannesses) {
  const auto header = [](const std::string& format) {
    return "ply\nformat " + format + " 1.0\ncomment none\nelement vertex 1\nproperty float x\n" +
           "property double y\nproperty float z\nproperty short scalar_Ring\nend_header\n";
  };
  std::string little = bytes(1.5f) + bytes(-2.0) + bytes(3.0f) + bytes(std::int16_t{12});
  std::string big = bytes(1.5f) + bytes(-2.0) + bytes(3.0f) + bytes(std::int16_t{12});
  std::reverse(big.begin(), big.begin() + 4);
  std::reverse(big.begin() + 4, big.begin() + 12);
  std::reverse(big.begin() + 12, big.begin() + 16);
  std::reverse(big.begin() + 16, big.end());
  for (const std::string& content :
       {header("ascii") + "1.5 -2 3 12\r\n", header("binary_little_endian") + little,
        header("binary_big_endian") + big}) {
    const auto scan = load_text("d.ply", content);
    ASSERT_TRUE(scan) << to_string(scan.error());
    ASSERT_EQ(scan->points.size(), 1u);
    EXPECT_EQ(scan->points[0].position, Eigen::Vector3f(1.5f, -2.0f, 3.0f));
    EXPECT_EQ(scan->points[0].ring, 12);
  }
}

TEST(CloudFile, KittiIsFourFloatsAPoint) {
  const auto scan = load_text("e.bin", bytes(1.0f) + bytes(2.0f) + bytes(3.0f) + bytes(0.25f));
  ASSERT_TRUE(scan) << to_string(scan.error());
  ASSERT_EQ(scan->points.size(), 1u);
  EXPECT_FLOAT_EQ(scan->points[0].intensity, 0.25f);
  const auto cut = load_text("e.bin", "not a cloud");
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().code, ErrorCode::kSyntax);
}

TEST(CloudFile, ErrorsNameTheFileAndTheLine) {
  const auto absent = load_cloud("/nowhere/at_all.pcd");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::kFileNotFound);
  EXPECT_THAT(to_string(absent.error()), HasSubstr("at_all.pcd"));
  const auto other = load_cloud("cloud.laz");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, ErrorCode::kUnsupported);
  const auto word =
      load_text("f.pcd", pcd("x y z", "4 4 4", "F F F", 2, "ascii\n1 2 3\n1 two 3\n"));
  ASSERT_FALSE(word);
  EXPECT_EQ(word.error().code, ErrorCode::kSyntax);
  EXPECT_THAT(to_string(word.error()), HasSubstr("f.pcd:11: 'two'"));
  EXPECT_TRUE(save_pcd(LidarScan{}, "/nowhere/at_all.pcd"));
  EXPECT_EQ(load_cloud(std::filesystem::temp_directory_path() / "..pcd").error().code,
            ErrorCode::kFileNotFound);
}

TEST(CloudFile, DamagedFilesAreRefused) {
  const std::string xyz = pcd("x y z", "4 4 4", "F F F", 1000, "");
  for (const std::string& content :
       {std::string("\x7f"
                    "ELF"),
        pcd("x y", "4 4", "F F", 1, "ascii\n1 2\n"),
        pcd("x y z", "4 4", "F F F", 1, "ascii\n1 2 3\n"),
        pcd("x y z", "4 4 3", "F F F", 1, "ascii\n1 2 3\n"),
        pcd("x y z", "4 4 4", "F F F", -1, "ascii\n"), xyz + "binary\n12", xyz + "ascii\n1 2 3\n",
        xyz + "ascii\n1 2\n", xyz + "parquet\n", xyz + "binary_compressed\nabc",
        xyz + "binary_compressed\n" + bytes(std::uint32_t{4}) + bytes(std::uint32_t{12000}) +
            "abcd",
        xyz + "binary_compressed\n" + bytes(std::uint32_t{100}) + bytes(std::uint32_t{12000}) +
            std::string(100, '\xff'),
        pcd("x y z", "8 8 8", "F F F", 999999999, "binary_compressed\n") + bytes(std::uint32_t{4}) +
            bytes(std::uint32_t{0}) + "abcd"}) {
    const auto scan = load_text("g.pcd", content);
    ASSERT_FALSE(scan) << content.substr(0, 200);
    EXPECT_EQ(scan.error().code, ErrorCode::kSyntax);
  }
  const std::string ply = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& content :
       {std::string("plx\n"), ply, ply + "element vertex many\nend_header\n",
        ply + "element vertex 3\nproperty float x\nend_header\nab", ply + "end_header\n",
        ply + "element camera 9999\nproperty float f\nelement vertex 1\nend_header\n",
        ply + "property float x\nend_header\n", ply + "element vertex 1\nproperty half x\n"}) {
    const auto scan = load_text("h.ply", content);
    ASSERT_FALSE(scan) << content;
    EXPECT_EQ(scan.error().code, ErrorCode::kSyntax);
  }
  const auto list =
      load_text("i.ply", ply + "element vertex 1\nproperty list uchar int x\nend_header\n");
  ASSERT_FALSE(list);
  EXPECT_EQ(list.error().code, ErrorCode::kUnsupported);
}

// A flipped byte gives an error or a scan, never more than the file can hold.
TEST(CloudFile, NoByteOfAFileBringsItDown) {
  const auto file = write_file("j.pcd", "");
  ASSERT_FALSE(save_pcd(random_scan(5), file));
  std::ifstream in(file, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  std::filesystem::remove(file);
  int refused = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x15);
    const auto scan = load_text("j.pcd", damaged);
    if (!scan) ++refused;
    EXPECT_LE(scan ? scan->points.size() : 0u, 15u);
  }
  EXPECT_GT(refused, 50);
}

struct RealCloud {
  const char* name;
  std::size_t points;
  bool has_rings;
  bool has_times;
};

class RealCloudFile : public ::testing::TestWithParam<RealCloud> {};

TEST_P(RealCloudFile, HasItsPointsRingsAndTimes) {
  const auto file = real_cloud(GetParam().name);
  if (!file) GTEST_SKIP() << "no data";
  const auto scan = load_cloud(*file);
  ASSERT_TRUE(scan) << to_string(scan.error());
  EXPECT_EQ(scan->points.size(), GetParam().points);
  int ring = 0;
  float offset = 0.0f;
  float brightest = 0.0f;
  for (const LidarPoint& point : scan->points) {
    ring = std::max<int>(ring, point.ring);
    offset = std::max(offset, point.offset_s);
    brightest = std::max(brightest, point.intensity);
    ASSERT_LE(point.intensity, 1.0f);
  }
  EXPECT_EQ(ring, GetParam().has_rings ? 127 : 0);
  EXPECT_NEAR(offset, GetParam().has_times ? 0.1 : 0.0, 0.02);
}

INSTANTIATE_TEST_SUITE_P(
    All, RealCloudFile,
    ::testing::Values(RealCloud{"kitti_000000/velodyne_000000.bin", 115384, false, false},
                      RealCloud{"ring128/000000.pcd", 205898, true, true},
                      RealCloud{"scan_pair/source.ply", 64685, false, false},
                      RealCloud{"scan_pair/target.ply", 64056, false, false},
                      RealCloud{"pine_plot/pine_plot.pcd", 114024, false, false},
                      RealCloud{"isprs/samp11-utm.pcd", 38010, false, false}));

}  // namespace
}  // namespace headland
