// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace headland {

/// A seeded stream of random numbers. Streams of different names are independent, so that adding a
/// consumer does not change what the others draw. Same seed and name, same numbers on every
/// platform (the distributions are our own: the standard leaves its own unspecified).
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  /// Uniform in [0, 1).
  double uniform();
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform integer in [0, count); requires count > 0.
  int index(int count);
  /// Standard normal (Marsaglia's polar method).
  double normal();

 private:
  std::mt19937_64 engine_;
  double spare_normal_ = 0.0;
  bool has_spare_ = false;
};

/// 64-bit FNV-1a; names streams and stamps configurations.
std::uint64_t fnv1a(std::string_view bytes);

}  // namespace headland
