// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.hpp"

namespace headland {
namespace {

// Of a sorted sample; linear between its values.
double quantile(const std::vector<double>& sorted, double fraction) {
  const double at = fraction * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (at - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

}  // namespace

double student_t_95(int freedom) {
  // Small samples from the table; beyond, the Cornish-Fisher expansion (error below 1e-3).
  constexpr std::array<double, 6> kTable = {12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469};
  HEADLAND_CHECK(freedom >= 1, "a spread needs two values");
  if (freedom <= static_cast<int>(kTable.size())) {
    return kTable[static_cast<std::size_t>(freedom - 1)];
  }
  const double z = 1.959964;
  const double z3 = z * z * z;
  const double z5 = z3 * z * z;
  const double n = freedom;
  return z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n) +
         (3.0 * z5 * z * z + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n);
}

Statistic summarize(std::vector<double> sample) {
  HEADLAND_CHECK(!sample.empty(), "a statistic of nothing");
  const double n = static_cast<double>(sample.size());
  Statistic result;
  for (const double x : sample) result.mean += x / n;
  if (sample.size() < 2) return result;
  double squares = 0.0;
  for (const double x : sample) squares += (x - result.mean) * (x - result.mean);
  const double spread = std::sqrt(squares / (n - 1.0));
  const double half = student_t_95(static_cast<int>(sample.size()) - 1) * spread / std::sqrt(n);
  std::sort(sample.begin(), sample.end());
  result.median = quantile(sample, 0.5);
  result.std = spread;
  result.p95 = quantile(sample, 0.95);
  result.ci_low = result.mean - half;
  result.ci_high = result.mean + half;
  return result;
}

}  // namespace headland
