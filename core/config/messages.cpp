// SPDX-License-Identifier: Apache-2.0
#include "core/config/messages.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace headland::config {
namespace {

// Levenshtein's distance, for "did you mean".
int distance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row.back();
}

}  // namespace

std::string allowed(Range range) {
  const bool low = std::isfinite(range.min);
  const bool high = std::isfinite(range.max);
  if (range.min == kPositive.min && !high) return "must be greater than 0";
  if (low && high) return fmt::format("allowed: {} to {}", range.min, range.max);
  if (low) return fmt::format("must be at least {}", range.min);
  return fmt::format("must be at most {}", range.max);
}

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  const auto nearest = std::min_element(
      known.begin(), known.end(),
      [&](const auto& a, const auto& b) { return distance(a, name) < distance(b, name); });
  if (nearest != known.end() && distance(*nearest, name) <= 3) {
    return "did you mean '" + *nearest + "'?";
  }
  return fmt::format("allowed: {}", fmt::join(known, ", "));
}

}  // namespace headland::config
