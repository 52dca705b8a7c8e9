// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace headland {

void parallel_for(int count, int jobs, const std::function<void(int)>& work) {
  std::atomic<int> next{0};
  const auto take = [&] {
    for (int i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> helpers;
  for (int j = 1; j < std::min(jobs, count); ++j) helpers.emplace_back(take);
  take();
}

}  // namespace headland
