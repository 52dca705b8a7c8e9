// SPDX-License-Identifier: Apache-2.0
#include "perception/cloud/internal/pcd_file.hpp"

#include <cstring>
#include <limits>
#include <span>
#include <string>

#include <fmt/format.h>

#include "perception/cloud/internal/point_table.hpp"

namespace headland::perception::internal {
namespace {

struct PcdField {
  std::string name;
  int size = 4;
  char type = 'F';
  int count = 1;
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::ptrdiff_t points = 0;
  std::string data;
};

using Words = std::vector<std::string_view>;

tl::unexpected<Error> refuse(std::string what, const Location& where) {
  return fail(ErrorCode::kSyntax, std::move(what), "write it as PCD 0.7", where);
}

std::optional<NumberType> number_type(char type, int size) {
  const bool is_signed = type == 'I';
  if (type == 'F' && size == 4) return NumberType::kFloat32;
  if (type == 'F' && size == 8) return NumberType::kFloat64;
  if (type != 'I' && type != 'U') return std::nullopt;
  if (size == 1) return is_signed ? NumberType::kInt8 : NumberType::kUint8;
  if (size == 2) return is_signed ? NumberType::kInt16 : NumberType::kUint16;
  if (size == 4) return is_signed ? NumberType::kInt32 : NumberType::kUint32;
  if (size == 8) return is_signed ? NumberType::kInt64 : NumberType::kUint64;
  return std::nullopt;
}

// One value per field into what `assign` says; false where one is missing or wrong.
template <class Assign>
bool per_field(const Words& words, std::vector<PcdField>& fields, Assign assign) {
  if (words.size() != fields.size() + 1) return false;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!assign(fields[i], words[i + 1])) return false;
  }
  return true;
}

bool take_number(std::string_view word, int most, int& value) {
  const std::optional<int> number = parse_count(word);
  if (!number || *number < 1 || *number > most) return false;
  value = *number;
  return true;
}

// One line of the header into `header`; false where it cannot be understood. `width` and `height`
// give the number of points where POINTS does not.
bool take_line(const Words& words, PcdHeader& header, std::ptrdiff_t& width,
               std::ptrdiff_t& height) {
  const std::string_view key = words[0];
  if (key == "FIELDS" || key == "COLUMNS") {
    for (std::size_t i = 1; i < words.size(); ++i) {
      header.fields.push_back({.name = std::string(words[i])});
    }
    return words.size() > 1;
  }
  if (key == "SIZE") {
    return per_field(words, header.fields, [](PcdField& field, std::string_view word) {
      return take_number(word, 8, field.size);
    });
  }
  if (key == "TYPE") {
    return per_field(words, header.fields, [](PcdField& field, std::string_view word) {
      field.type = word[0];
      return word.size() == 1;
    });
  }
  if (key == "COUNT") {
    return per_field(words, header.fields, [](PcdField& field, std::string_view word) {
      return take_number(word, 100'000, field.count);
    });
  }
  if (key == "DATA") {
    header.data = words.size() == 2 ? words[1] : "";
    return words.size() == 2;
  }
  if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
    const std::optional<int> number = words.size() == 2 ? parse_count(words[1]) : std::nullopt;
    if (!number) return false;
    (key == "WIDTH" ? width : key == "HEIGHT" ? height : header.points) = *number;
    return true;
  }
  return key == "VERSION" || key == "VIEWPOINT";
}

Result<PcdHeader> parse_header(LineReader& lines, const Location& where) {
  PcdHeader header;
  header.points = -1;
  std::ptrdiff_t width = 0;
  std::ptrdiff_t height = 1;
  std::string_view line;
  Words words;
  while (header.data.empty()) {
    if (!lines.next(line)) return refuse("a header without DATA", where);
    split_words(line, words);
    if (words.empty() || words[0].starts_with('#')) continue;
    if (!take_line(words, header, width, height)) {
      return refuse(fmt::format("'{}' in the header", line.substr(0, 40)),
                    {where.file, lines.number(), {}});
    }
  }
  if (header.points < 0) header.points = width * height;
  for (const PcdField& field : header.fields) {
    if (!number_type(field.type, field.size)) {
      return refuse(fmt::format("field {} of type {}{}", field.name, field.type, field.size),
                    where);
    }
  }
  if (header.points > std::numeric_limits<int>::max()) return refuse("too many points", where);
  return header;
}

// Columns of points that lie one after the other (`interleaved`), or of fields that do.
std::vector<PointColumn> columns_of(const PcdHeader& header, const std::byte* data,
                                    bool interleaved) {
  std::ptrdiff_t record = 0;
  for (const PcdField& field : header.fields) record += field.size * field.count;
  std::vector<PointColumn> columns;
  for (const PcdField& field : header.fields) {
    const NumberType type = *number_type(field.type, field.size);
    const std::ptrdiff_t bytes = field.size * field.count;
    columns.push_back({field.name, type, is_integer(type), data, interleaved ? record : bytes});
    data += interleaved ? bytes : bytes * header.points;
  }
  return columns;
}

std::ptrdiff_t bytes_of(const PcdHeader& header) {
  std::ptrdiff_t record = 0;
  for (const PcdField& field : header.fields) record += field.size * field.count;
  return record * header.points;
}

// Lehmann's LZF: a byte below 32 leads that many plus one plain bytes; any other is a copy of 3 to
// 264 bytes from up to 8192 back. False where it does not fill `out` exactly.
bool unpack_lzf(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) {
  std::size_t read = 0;
  std::size_t written = 0;
  while (read < in.size()) {
    const std::size_t control = in[read++];
    if (control < 32) {
      const std::size_t run = control + 1;
      if (run > in.size() - read || run > out.size() - written) return false;
      std::memcpy(out.data() + written, in.data() + read, run);
      read += run;
      written += run;
      continue;
    }
    std::size_t length = (control >> 5) + 2;
    if (length == 9) {
      if (read == in.size()) return false;
      length += in[read++];
    }
    if (read == in.size()) return false;
    const std::size_t back = ((control & 31) << 8) + in[read++] + 1;
    if (back > written || length > out.size() - written) return false;
    for (std::size_t i = 0; i < length; ++i, ++written) out[written] = out[written - back];
  }
  return written == out.size();
}

Result<LidarScan> parse_compressed(const PcdHeader& header, std::string_view rest,
                                   const Location& where) {
  std::uint32_t sizes[2];  // packed, unpacked
  if (rest.size() < sizeof sizes) return refuse("the file ends early", where);
  std::memcpy(sizes, rest.data(), sizeof sizes);
  rest.remove_prefix(sizeof sizes);
  constexpr std::ptrdiff_t kMostPerByte = 132;  // three bytes unpack to 264 at most
  if (sizes[0] > rest.size() || sizes[1] != bytes_of(header) ||
      sizes[1] > kMostPerByte * static_cast<std::ptrdiff_t>(sizes[0])) {
    return refuse("the sizes of the compressed part are wrong", where);
  }
  std::vector<std::uint8_t> plain(sizes[1]);
  const auto* packed = reinterpret_cast<const std::uint8_t*>(rest.data());
  if (!unpack_lzf({packed, sizes[0]}, plain)) {
    return refuse("the compressed part is damaged", where);
  }
  const auto* data = reinterpret_cast<const std::byte*>(plain.data());
  return scan_from(columns_of(header, data, false), header.points, where);
}

Result<LidarScan> parse_ascii(const PcdHeader& header, LineReader& lines, const Location& where) {
  std::ptrdiff_t per_line = 0;
  for (const PcdField& field : header.fields) per_line += field.count;
  std::vector<double> numbers;
  if (auto error = parse_rows(lines, header.points, per_line, where, numbers)) {
    return tl::unexpected(std::move(*error));
  }
  std::vector<PointColumn> columns;
  std::ptrdiff_t at = 0;
  for (const PcdField& field : header.fields) {
    const auto* first = reinterpret_cast<const std::byte*>(numbers.data() + at);
    const auto stride = per_line * static_cast<std::ptrdiff_t>(sizeof(double));
    columns.push_back({field.name, NumberType::kFloat64, field.type != 'F', first, stride});
    at += field.count;
  }
  return scan_from(columns, header.points, where);
}

}  // namespace

Result<LidarScan> parse_pcd(std::string_view content, const Location& where) {
  LineReader lines(content);
  const Result<PcdHeader> header = parse_header(lines, where);
  if (!header) return tl::unexpected(header.error());
  if (header->data == "ascii") return parse_ascii(*header, lines, where);
  if (header->data == "binary_compressed") return parse_compressed(*header, lines.rest(), where);
  if (header->data != "binary") return refuse(fmt::format("DATA {}", header->data), where);
  if (std::ssize(lines.rest()) < bytes_of(*header)) return refuse("the file ends early", where);
  const auto* data = reinterpret_cast<const std::byte*>(lines.rest().data());
  return scan_from(columns_of(*header, data, true), header->points, where);
}

std::string to_pcd(const LidarScan& scan) {
  std::string text = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
      "FIELDS x y z intensity timestamp ring\nSIZE 4 4 4 4 8 2\nTYPE F F F F F U\n"
      "COUNT 1 1 1 1 1 1\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\n"
      "DATA binary\n",
      scan.points.size());
  const auto append = [&text](const auto& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const LidarPoint& point : scan.points) {
    for (int axis = 0; axis < 3; ++axis) append(point.position[axis]);
    append(point.intensity);
    append(scan.time_s + static_cast<double>(point.offset_s));
    append(point.ring);
  }
  return text;
}

}  // namespace headland::perception::internal
