// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/world/lidar.hpp"

namespace headland::perception::internal {

/// How a file stores a number; little-endian.
enum class NumberType {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

int size_of(NumberType type);  ///< [bytes]
bool is_integer(NumberType type);

/// One property of all points: `count` numbers `stride` bytes apart.
struct PointColumn {
  std::string name;
  NumberType type = NumberType::kFloat32;  ///< as stored
  bool is_integer = false;                 ///< as declared: text holds integers as float64
  const std::byte* first = nullptr;
  std::ptrdiff_t stride = 0;

  double at(std::ptrdiff_t index) const;
};

/// The columns x, y, z, and where there are any: intensity or reflectance, ring or channel, time or
/// timestamp or t (names may be prefixed by scalar_ and written in capitals). Points that are not
/// finite, or all zeros, are left out. Integer times are nanoseconds, others seconds. Intensity is
/// a fraction; bytes, and numbers of which any exceeds 1, are taken as of 255 (as of 65535 where
/// any exceeds 255). kSyntax where x, y or z is absent, `where` being the file.
Result<LidarScan> scan_from(std::span<const PointColumn> columns, std::ptrdiff_t count,
                            const Location& where);

/// Lines of a text, without their ends, and their numbers from 1 on.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}

  bool next(std::string_view& line);
  int number() const { return number_; }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  int number_ = 0;
};

/// Words between blanks. Overwrites `words`.
void split_words(std::string_view line, std::vector<std::string_view>& words);

/// A whole number of at most nine digits and not negative.
std::optional<int> parse_count(std::string_view word);

/// Reads `count` lines of at least `words_per_line` numbers into `numbers`, row by row. Empty lines
/// do not count.
std::optional<Error> parse_rows(LineReader& lines, std::ptrdiff_t count,
                                std::ptrdiff_t words_per_line, const Location& where,
                                std::vector<double>& numbers);

}  // namespace headland::perception::internal
