// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace headland {

/// Numbers as unsigned ones of 16 bits, little end first, in base64: from 0 for the lowest to 65534
/// for the highest; 65535 where there is none (NaN).
struct PackedNumbers {
  double low = 0.0;
  double high = 0.0;
  std::string base64;
};
PackedNumbers pack(const std::vector<double>& numbers);

/// Base64 as RFC 4648, section 4.
std::string base64(const std::vector<unsigned char>& bytes);

}  // namespace headland
