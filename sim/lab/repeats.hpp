// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace headland {

/// @return kOutOfRange at `key` if something is in its list twice: a study's cells would share
/// their names.
template <class T>
std::optional<Error> check_repeats(const std::vector<T>& values, const std::string& key) {
  for (auto it = values.begin(); it != values.end(); ++it) {
    if (std::find(values.begin(), it, *it) == it) continue;
    return Error{ErrorCode::kOutOfRange, "the same is named twice", "name each once", {{}, 0, key}};
  }
  return std::nullopt;
}

}  // namespace headland
