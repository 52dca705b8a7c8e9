// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/acfr/tables.hpp"

#include <gtest/gtest.h>

#include "sim/lab/statistics.hpp"

namespace headland {
namespace {

// The tree search where it is dense, at 1 m; nothing else was run.
StudyResult one_cell() {
  StudyResult result{"acfr"};
  StudyCell cell{"mcts/dense/1m", 200};
  cell.metrics.emplace_back("fail_1min", proportion(3, 200));
  cell.metrics.emplace_back("fail_5min", proportion(0, 200));
  result.cells = {cell};
  StudyCell dense{"mcts/dense", 200};
  dense.metrics.emplace_back("displacement_m", summarize({1.0, 2.0, 3.0}));
  dense.metrics.emplace_back("near_collision", proportion(1, 100));
  dense.metrics.emplace_back("least_m", summarize({2.0, 4.0}));
  result.cells.push_back(dense);
  add_acfr_tables(result);
  return result;
}

TEST(AcfrTables, StandInThePapersLayoutBesideItsFiguresWithIntervals) {
  const StudyResult result = one_cell();
  ASSERT_EQ(result.tables.size(), 3U);
  const auto& failures = result.tables[0];
  EXPECT_EQ(failures.header[4], "dense 1m");
  EXPECT_EQ(failures.rows[0][1], "mcts");
  EXPECT_EQ(failures.rows[0][4], "1.5 [0.5, 4.3] (2.8)") << "Wilson, and Table I";
  EXPECT_EQ(failures.rows[3][4], "0.0 [0.0, 1.9] (0.6)");
  EXPECT_EQ(result.tables[1].rows[0][1], "2.00 (1.63)");
  EXPECT_EQ(result.tables[2].rows[0][2], "3.00 (2.61)");
}

TEST(AcfrTables, SayWhatWasNotRun) {
  for (const StudyTable& table : one_cell().tables) {
    for (const auto& row : table.rows) ASSERT_EQ(row.size(), table.header.size()) << table.title;
  }
  const auto tables = one_cell().tables;
  ASSERT_EQ(tables[0].rows.size(), 6U) << "all planners of the paper, two timeouts";
  EXPECT_EQ(tables[0].rows[0][2], "not run (0.0)") << "another accuracy";
  EXPECT_EQ(tables[0].rows[1][1], "pf");
  EXPECT_EQ(tables[0].rows[1][4], "not run (4.6)") << "another planner";
  EXPECT_EQ(tables[1].rows[2][1], "not run (0.05)");
}

}  // namespace
}  // namespace headland
