// SPDX-License-Identifier: Apache-2.0
// The rules of the house, on the whole tree.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/style/rules.hpp"

namespace headland::style {
namespace {

const std::vector<SourceFile>& tree() {
  static const std::vector<SourceFile> kTree = read_tree(HEADLAND_SOURCE_DIR);
  return kTree;
}

std::string joined(const Complaints& complaints) {
  std::string text;
  for (const std::string& complaint : complaints) text += "\n  " + complaint;
  return text;
}

void expect_everywhere(Complaints (*rule)(const SourceFile&)) {
  for (const SourceFile& file : tree()) {
    const Complaints complaints = rule(file);
    EXPECT_TRUE(complaints.empty()) << joined(complaints);
  }
}

TEST(HouseStyle, TheTreeIsSeen) {
  const auto seen = [](const char* path) {
    return std::any_of(tree().begin(), tree().end(),
                       [&](const SourceFile& file) { return file.path == path; });
  };
  EXPECT_GT(tree().size(), 50U);
  for (const char* path : {"CMakeLists.txt", "core/base/error.hpp", "console/src/report.ts"}) {
    EXPECT_TRUE(seen(path)) << path;
  }
}

TEST(HouseStyle, FoldersIncludeOnlyWhatDesignAllows) { expect_everywhere(check_layering); }
TEST(HouseStyle, FilesAndFunctionsAreShort) { expect_everywhere(check_size); }
TEST(HouseStyle, FilesNameTheirLicence) { expect_everywhere(check_licence); }
TEST(HouseStyle, KeysEndInTheirUnit) { expect_everywhere(check_units); }
TEST(HouseStyle, NoFlagTiesTheBuildToAProcessor) { expect_everywhere(check_flags); }
TEST(HouseStyle, NoTextNamesAMachine) { expect_everywhere(check_machine_paths); }

TEST(HouseStyle, FoldersExplainThemselves) {
  const Complaints complaints = check_readmes(tree());
  EXPECT_TRUE(complaints.empty()) << joined(complaints);
}

TEST(HouseStyle, PapersPointToFilesThatExist) {
  for (const SourceFile& file : tree()) {
    if (file.path != "docs/papers.md") continue;
    const Complaints complaints = check_papers(file, tree());
    EXPECT_TRUE(complaints.empty()) << joined(complaints);
  }
}

}  // namespace
}  // namespace headland::style
