// SPDX-License-Identifier: Apache-2.0
#include "core/config/yaml.hpp"

#include <gtest/gtest.h>

#include "core/model/vehicle.hpp"

namespace headland {
namespace {

Result<Vehicle> read(const std::string& text) {
  auto node = config::Node::parse(text, "tractor.yaml");
  if (!node) return tl::unexpected<Error>(node.error());
  Vehicle vehicle;
  if (auto ok = config::read_into(*node, vehicle); !ok) return tl::unexpected<Error>(ok.error());
  return vehicle;
}

TEST(Yaml, ReadsNestedStructs) {
  const auto vehicle = read("name: t\nwheelbase_m: 2.5\nbattery: {capacity_wh: 12.5}\n");
  ASSERT_TRUE(vehicle) << to_string(vehicle.error());
  EXPECT_EQ(vehicle->wheelbase_m, 2.5);
  EXPECT_EQ(vehicle->battery.capacity_wh, 12.5);
}

TEST(Yaml, UnknownKeyNamesLineAndNearestKey) {
  const auto vehicle = read("name: t\nwheelbas_m: 2.5\n");
  ASSERT_FALSE(vehicle);
  EXPECT_EQ(to_string(vehicle.error()),
            "tractor.yaml:2: wheelbas_m: unknown key; did you mean 'wheelbase_m'? [E103]");
}

TEST(Yaml, OutOfRangeNamesDottedKeyAndBounds) {
  const auto vehicle = read("name: t\nbattery:\n  capacity_wh: -1\n");
  ASSERT_FALSE(vehicle);
  EXPECT_EQ(
      to_string(vehicle.error()),
      "tractor.yaml:3: battery.capacity_wh: -1 is out of range; allowed: 1 to 10000000 [E106]");
}

TEST(Yaml, MissingRequiredKeyIsAnError) {
  const auto vehicle = read("wheelbase_m: 2\n");
  ASSERT_FALSE(vehicle);
  EXPECT_EQ(vehicle.error().code, ErrorCode::kMissingKey);
  EXPECT_EQ(vehicle.error().where.key, "name");
}

TEST(Yaml, BadSyntaxNamesTheLine) {
  const auto vehicle = read("name: t\nbattery: {capacity_wh: 1\n");
  ASSERT_FALSE(vehicle);
  EXPECT_EQ(vehicle.error().code, ErrorCode::kSyntax);
  EXPECT_GE(vehicle.error().where.line, 2);
}

TEST(Yaml, WrittenTextReadsBackToTheSameText) {
  Vehicle vehicle;
  vehicle.name = "a \"quoted\": name";
  vehicle.battery.reserve_soc = 0.25;
  const std::string text = config::to_yaml(vehicle);
  const auto again = read(text);
  ASSERT_TRUE(again) << to_string(again.error()) << text;
  EXPECT_EQ(config::to_yaml(*again), text);
}

TEST(Yaml, AKeyThatStandsTwiceIsAnError) {
  const auto vehicle = read("name: t\nwheelbase_m: 2\nname: u\n");
  ASSERT_FALSE(vehicle);
  EXPECT_NE(to_string(vehicle.error()).find("name: the key stands here twice"), std::string::npos)
      << to_string(vehicle.error());
}

TEST(Yaml, LongAndUnprintableTextsAreCutInMessages) {
  const auto vehicle = read("name: t\nwheelbase_m: \"" + std::string(5000, 'x') + "\\x01\"\n");
  ASSERT_FALSE(vehicle);
  EXPECT_LT(to_string(vehicle.error()).size(), 200u);
}

TEST(Yaml, SetOverridesNestedKeysAndListItems) {
  auto node = config::Node::parse("a: {b: 1}\nlist: [{x: 1}, {x: 2}]\n", "f");
  ASSERT_TRUE(node);
  ASSERT_TRUE(node->set("a.b", "7"));
  ASSERT_TRUE(node->set("list.1.x", "9"));
  ASSERT_TRUE(node->set("new.deep", "z"));
  EXPECT_EQ(node->child("a")->child("b")->scalar(), "7");
  EXPECT_EQ(node->child("list")->items()[1].child("x")->scalar(), "9");
  EXPECT_EQ(node->child("new")->child("deep")->scalar(), "z");
  EXPECT_FALSE(node->set("list.5.x", "9"));
}

}  // namespace
}  // namespace headland
