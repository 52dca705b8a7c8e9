// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.hpp"

namespace headland {
namespace {

constexpr double kZ95 = 1.959964;  // two-sided quantile of the normal distribution

// Of a sorted sample; linear between its values.
double quantile_of_sorted(const std::vector<double>& sorted, double fraction) {
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
  const double z = kZ95;
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
  for (const double x : sample) result.mean += x;
  result.mean /= n;
  if (sample.size() < 2) return result;
  double squares = 0.0;
  for (const double x : sample) squares += (x - result.mean) * (x - result.mean);
  const double spread = std::sqrt(squares / (n - 1.0));
  const double half = student_t_95(static_cast<int>(sample.size()) - 1) * spread / std::sqrt(n);
  std::sort(sample.begin(), sample.end());
  result.median = quantile_of_sorted(sample, 0.5);
  result.std = spread;
  result.p95 = quantile_of_sorted(sample, 0.95);
  result.ci_low = result.mean - half;
  result.ci_high = result.mean + half;
  return result;
}

double quantile(std::vector<double> sample, double fraction) {
  HEADLAND_CHECK(!sample.empty(), "a quantile of nothing");
  std::sort(sample.begin(), sample.end());
  return quantile_of_sorted(sample, fraction);
}

double cvar5(std::vector<double> sample) {
  HEADLAND_CHECK(!sample.empty(), "the worst of nothing");
  const std::size_t count = (sample.size() + 19) / 20;
  std::sort(sample.begin(), sample.end());
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += sample[i];
  return sum / static_cast<double>(count);
}

Statistic proportion(int hits, int count) {
  HEADLAND_CHECK(count > 0 && hits >= 0 && hits <= count, "a share of something");
  const double n = count;
  const double share = hits / n;
  const double z2 = kZ95 * kZ95 / n;
  const double middle = (share + z2 / 2.0) / (1.0 + z2);
  const double half = std::sqrt(z2 * (share * (1.0 - share) + z2 / 4.0)) / (1.0 + z2);
  Statistic result{share};
  result.ci_low = hits == 0 ? 0.0 : middle - half;
  result.ci_high = hits == count ? 1.0 : middle + half;
  return result;
}

double mcnemar(int only_first, int only_second) {
  HEADLAND_CHECK(only_first >= 0 && only_second >= 0, "numbers of cases");
  const int n = only_first + only_second;
  const double log_half = std::log(0.5) * n;
  double tail = 0.0;  // of the binomial distribution with 1/2
  for (int k = 0; k <= std::min(only_first, only_second); ++k) {
    tail +=
        std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) + log_half);
  }
  return std::min(1.0, 2.0 * tail);
}

}  // namespace headland
