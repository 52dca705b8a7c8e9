// SPDX-License-Identifier: Apache-2.0
#include "perception/detection/class_names.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

TEST(ClassNames, AnimalsAreLivestock) {
  for (const char* name : {"horse", "Cow", "SHEEP", " dog\r"}) {
    EXPECT_EQ(class_of_name(name), ObjectClass::kLivestock) << name;
  }
  EXPECT_EQ(class_of_name("person"), ObjectClass::kPerson);
  EXPECT_EQ(class_of_name("truck"), ObjectClass::kVehicle);
  EXPECT_EQ(class_of_name("toaster"), ObjectClass::kOther);
  EXPECT_EQ(class_of_name(""), ObjectClass::kOther);
}

TEST(ClassNames, KeepTheirPlaces) {
  const auto classes = parse_class_names("background\r\nperson\n\ncow\n\n\n");
  ASSERT_TRUE(classes);
  EXPECT_EQ(*classes, (std::vector<ObjectClass>{ObjectClass::kOther, ObjectClass::kPerson,
                                                ObjectClass::kOther, ObjectClass::kLivestock}));
}

TEST(ClassNames, WhatNamesNobodyIsRefused) {
  for (const char* text : {"", "\n\n", "chair\ntoaster\n", "\x01\x02\x03"}) {
    const auto classes = parse_class_names(text);
    ASSERT_FALSE(classes);
    EXPECT_EQ(classes.error().code, ErrorCode::kSyntax);
  }
}

}  // namespace
}  // namespace headland
