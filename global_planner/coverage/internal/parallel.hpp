// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace headland::coverage {

/// Calls `work(i)` for all i in [0, count) from a few threads. Each i must write to places of its
/// own alone: then the result does not depend on the number of threads.
template <class Work>
void parallel_for(int count, const Work& work) {
  constexpr int kBlock = 8;
  constexpr int kMostThreads = 4;
  const int threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1,
                                 std::min(kMostThreads, count / kBlock + 1));
  std::atomic<int> next{0};
  const auto run = [&] {
    for (int begin = next.fetch_add(kBlock); begin < count; begin = next.fetch_add(kBlock)) {
      for (int i = begin; i < std::min(begin + kBlock, count); ++i) work(i);
    }
  };
  std::vector<std::jthread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(run);
  run();
}

}  // namespace headland::coverage
