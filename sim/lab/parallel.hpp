// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace headland {

/// Calls work(0), ..., work(count - 1), `jobs` at once. Each call must write to its own place only;
/// then the result does not depend on `jobs`. Returns when all are done.
void parallel_for(int count, int jobs, const std::function<void(int)>& work);

}  // namespace headland
