// SPDX-License-Identifier: Apache-2.0
#include "apps/study_output.hpp"

#include <gtest/gtest.h>

namespace headland::apps {
namespace {

TEST(StudyText, IsTheTablesWithTheirColumnsAligned) {
  StudyResult result{"s"};
  result.cells = {{"a/b", 3}};
  result.tables = {{"Table I", {"planner", "x"}, {{"mcts", "1.5 [0, 2]"}, {"a long name", "-"}}}};
  EXPECT_EQ(study_text(result),
            "Table I\n"
            "  planner      x\n"
            "  mcts         1.5 [0, 2]\n"
            "  a long name  -\n\n");
}

TEST(StudyText, IsALineForEachCellWhereThereAreNoTables) {
  StudyResult result{"s"};
  StudyCell cell{"a/b", 3};
  cell.add("cost_m", 2.5);
  result.cells = {cell};
  EXPECT_EQ(study_text(result), "a/b                              cost_m=2.5\n");
}

}  // namespace
}  // namespace headland::apps
