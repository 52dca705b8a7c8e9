// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/parallel.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace headland {
namespace {

TEST(ParallelFor, CallsEachNumberOnceWhateverTheJobs) {
  for (const int jobs : {1, 2, 7, 100}) {
    std::vector<int> calls(50, 0);
    parallel_for(50, jobs, [&](int i) { ++calls[static_cast<std::size_t>(i)]; });
    EXPECT_EQ(calls, std::vector<int>(50, 1)) << jobs;
  }
}

TEST(ParallelFor, NothingToDoIsFine) {
  parallel_for(0, 4, [](int) { FAIL(); });
}

}  // namespace
}  // namespace headland
