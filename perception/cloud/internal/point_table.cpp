// SPDX-License-Identifier: Apache-2.0
#include "perception/cloud/internal/point_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>

#include <fmt/format.h>

namespace headland::perception::internal {
namespace {

template <class T>
double load(const std::byte* place) {
  T value;
  std::memcpy(&value, place, sizeof value);
  return static_cast<double>(value);
}

std::string plain_name(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  });
  constexpr std::string_view kPrefix = "scalar_";
  if (name.starts_with(kPrefix)) name.erase(0, kPrefix.size());
  return name;
}

const PointColumn* find(std::span<const PointColumn> columns,
                        std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    for (const PointColumn& column : columns) {
      if (plain_name(column.name) == name) return &column;
    }
  }
  return nullptr;
}

double largest(const PointColumn& column, std::ptrdiff_t count) {
  double most = 0.0;
  for (std::ptrdiff_t i = 0; i < count; ++i) most = std::max(most, column.at(i));
  return most;
}

double full_scale(const PointColumn& intensity, std::ptrdiff_t count) {
  if (intensity.type == NumberType::kUint8) return 255.0;
  const double most = largest(intensity, count);
  return most <= 1.0 ? 1.0 : most <= 255.0 ? 255.0 : 65535.0;
}

// A beam without a return has no point: drivers write it as NaN or as zeros.
bool is_return(const Eigen::Vector3f& position) {
  return position.allFinite() && !position.isZero(0.0f);
}

// `value`, but 0 where it is below or no number, and at most `most`.
double within(double value, double most) { return value > 0.0 ? std::min(value, most) : 0.0; }

// Offsets from the earliest time; 0 for points whose time is no number.
void set_times(const std::vector<double>& times, LidarScan& scan) {
  double first = std::numeric_limits<double>::infinity();
  for (const double t : times) {
    if (t < first) first = t;  // NaN is not
  }
  scan.time_s = std::isfinite(first) ? first : 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double offset = times[i] - scan.time_s;
    scan.points[i].offset_s = std::isfinite(offset) ? static_cast<float>(offset) : 0.0f;
  }
}

}  // namespace

int size_of(NumberType type) {
  constexpr int kSizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<int>(type)];
}

bool is_integer(NumberType type) {
  return type != NumberType::kFloat32 && type != NumberType::kFloat64;
}

double PointColumn::at(std::ptrdiff_t index) const {
  const std::byte* place = first + index * stride;
  switch (type) {
    case NumberType::kInt8:
      return load<std::int8_t>(place);
    case NumberType::kUint8:
      return load<std::uint8_t>(place);
    case NumberType::kInt16:
      return load<std::int16_t>(place);
    case NumberType::kUint16:
      return load<std::uint16_t>(place);
    case NumberType::kInt32:
      return load<std::int32_t>(place);
    case NumberType::kUint32:
      return load<std::uint32_t>(place);
    case NumberType::kInt64:
      return load<std::int64_t>(place);
    case NumberType::kUint64:
      return load<std::uint64_t>(place);
    case NumberType::kFloat32:
      return load<float>(place);
    case NumberType::kFloat64:
      return load<double>(place);
  }
  return 0.0;
}

Result<LidarScan> scan_from(std::span<const PointColumn> columns, std::ptrdiff_t count,
                            const Location& where) {
  const PointColumn* axes[] = {find(columns, {"x"}), find(columns, {"y"}), find(columns, {"z"})};
  if (axes[0] == nullptr || axes[1] == nullptr || axes[2] == nullptr) {
    return fail(ErrorCode::kSyntax, "points without x, y and z", "name the columns x, y, z", where);
  }
  const PointColumn* intensity = find(columns, {"intensity", "reflectance", "reflectivity"});
  const PointColumn* ring = find(columns, {"ring", "channel"});
  const PointColumn* time = find(columns, {"timestamp", "time", "t", "offset_time"});
  const double per_intensity = intensity == nullptr ? 0.0 : 1.0 / full_scale(*intensity, count);
  const double second = time != nullptr && time->is_integer ? 1e9 : 1.0;

  LidarScan scan;
  scan.points.reserve(static_cast<std::size_t>(count));
  std::vector<double> times;  // [s]
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    LidarPoint point;
    for (int axis = 0; axis < 3; ++axis) {
      point.position[axis] = static_cast<float>(axes[axis]->at(i));
    }
    if (!is_return(point.position)) continue;
    if (intensity != nullptr) {
      point.intensity = static_cast<float>(within(intensity->at(i) * per_intensity, 1.0));
    }
    if (ring != nullptr) point.ring = static_cast<std::uint16_t>(within(ring->at(i), 65535.0));
    if (time != nullptr) times.push_back(time->at(i) / second);
    scan.points.push_back(point);
  }
  if (!times.empty()) set_times(times, scan);
  return scan;
}

bool LineReader::next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  ++number_;
  return true;
}

void split_words(std::string_view line, std::vector<std::string_view>& words) {
  constexpr std::string_view kBlanks = " \t";
  words.clear();
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = line.find_first_of(kBlanks, at);
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
}

std::optional<int> parse_count(std::string_view word) {
  int value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  if (value < 0 || value > 999'999'999) return std::nullopt;
  return value;
}

std::optional<Error> parse_rows(LineReader& lines, std::ptrdiff_t count,
                                std::ptrdiff_t words_per_line, const Location& where,
                                std::vector<double>& numbers) {
  numbers.clear();
  std::string_view line;
  std::vector<std::string_view> words;
  for (std::ptrdiff_t row = 0; row < count;) {
    const bool more = lines.next(line);
    const Location place{where.file, lines.number(), {}};
    if (!more) {
      return Error{ErrorCode::kSyntax, fmt::format("{} of {} points", row, count),
                   "the file ends early", place};
    }
    split_words(line, words);
    if (words.empty()) continue;
    if (std::ssize(words) < words_per_line) {
      return Error{ErrorCode::kSyntax,
                   fmt::format("{} numbers instead of {}", words.size(), words_per_line), "",
                   place};
    }
    for (std::ptrdiff_t i = 0; i < words_per_line; ++i) {
      const std::string_view word = words[static_cast<std::size_t>(i)];
      double value = 0.0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || end != word.data() + word.size()) {
        return Error{ErrorCode::kSyntax, fmt::format("'{}' is no number", word), "", place};
      }
      numbers.push_back(value);
    }
    ++row;
  }
  return std::nullopt;
}

}  // namespace headland::perception::internal
