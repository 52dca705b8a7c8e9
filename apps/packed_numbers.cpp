// SPDX-License-Identifier: Apache-2.0
#include "apps/packed_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace headland {
namespace {

constexpr double kSteps = 65534.0;
constexpr std::uint16_t kNone = 65535;

}  // namespace

PackedNumbers pack(const std::vector<double>& numbers) {
  PackedNumbers packed;
  bool first = true;
  for (const double number : numbers) {
    if (!std::isfinite(number)) continue;
    packed.low = first ? number : std::min(packed.low, number);
    packed.high = first ? number : std::max(packed.high, number);
    first = false;
  }
  const double range = packed.high - packed.low;
  std::vector<unsigned char> bytes;
  for (const double number : numbers) {
    const double step = range > 0.0 ? kSteps / range * (number - packed.low) : 0.0;
    const auto value =
        std::isfinite(number) ? static_cast<std::uint16_t>(std::lround(step)) : kNone;
    bytes.push_back(static_cast<unsigned char>(value % 256));
    bytes.push_back(static_cast<unsigned char>(value / 256));
  }
  packed.base64 = base64(bytes);
  return packed;
}

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8U | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[group >> (18U - 6U * k) & 63U] : '=';
    }
  }
  return text;
}

}  // namespace headland
