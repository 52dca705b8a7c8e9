// SPDX-License-Identifier: Apache-2.0
#include "perception/cloud/internal/ply_file.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "perception/cloud/internal/point_table.hpp"

namespace headland::perception::internal {
namespace {

struct PlyProperty {
  std::string name;
  NumberType type = NumberType::kFloat32;
};

struct PlyElement {
  std::string name;
  std::ptrdiff_t count = 0;
  bool has_list = false;
  std::vector<PlyProperty> properties;

  std::ptrdiff_t bytes() const {
    std::ptrdiff_t sum = 0;
    for (const PlyProperty& property : properties) sum += size_of(property.type);
    return sum;
  }
};

struct PlyHeader {
  std::string format;
  std::vector<PlyElement> elements;
};

using Words = std::vector<std::string_view>;

tl::unexpected<Error> refuse(std::string what, const Location& where) {
  return fail(ErrorCode::kSyntax, std::move(what), "write it as PLY 1.0", where);
}

std::optional<NumberType> number_type(std::string_view name) {
  constexpr std::pair<std::string_view, NumberType> kNames[] = {
      {"char", NumberType::kInt8},      {"int8", NumberType::kInt8},
      {"uchar", NumberType::kUint8},    {"uint8", NumberType::kUint8},
      {"short", NumberType::kInt16},    {"int16", NumberType::kInt16},
      {"ushort", NumberType::kUint16},  {"uint16", NumberType::kUint16},
      {"int", NumberType::kInt32},      {"int32", NumberType::kInt32},
      {"uint", NumberType::kUint32},    {"uint32", NumberType::kUint32},
      {"float", NumberType::kFloat32},  {"float32", NumberType::kFloat32},
      {"double", NumberType::kFloat64}, {"float64", NumberType::kFloat64}};
  for (const auto& [candidate, type] : kNames) {
    if (candidate == name) return type;
  }
  return std::nullopt;
}

// One line of the header; false where it cannot be understood.
bool take_line(const Words& words, PlyHeader& header) {
  const std::string_view key = words[0];
  if (key == "comment" || key == "obj_info") return true;
  if (key == "format" && words.size() == 3) {
    header.format = words[1];
    return words[2] == "1.0";
  }
  if (key == "element" && words.size() == 3) {
    const std::optional<int> count = parse_count(words[2]);
    header.elements.push_back({std::string(words[1]), count.value_or(0), false, {}});
    return count.has_value();
  }
  if (key != "property" || header.elements.empty() || words.size() < 3) return false;
  PlyElement& element = header.elements.back();
  if (words[1] == "list") {
    element.has_list = true;
    return words.size() == 5;
  }
  const std::optional<NumberType> type = number_type(words[1]);
  if (!type || words.size() != 3) return false;
  element.properties.push_back({std::string(words[2]), *type});
  return true;
}

Result<PlyHeader> parse_header(LineReader& lines, const Location& where) {
  PlyHeader header;
  std::string_view line;
  Words words;
  if (!lines.next(line) || line != "ply") {
    return refuse("the first line is not ply", {where.file, 1, {}});
  }
  while (lines.next(line)) {
    split_words(line, words);
    if (words.empty()) continue;
    if (words[0] == "end_header") return header;
    if (!take_line(words, header)) {
      return refuse(fmt::format("'{}' in the header", line.substr(0, 40)),
                    {where.file, lines.number(), {}});
    }
  }
  return refuse("a header without end_header", where);
}

Result<LidarScan> parse_ascii(const PlyElement& vertices, LineReader& lines,
                              const Location& where) {
  const std::ptrdiff_t per_line = std::ssize(vertices.properties);
  std::vector<double> numbers;
  if (auto error = parse_rows(lines, vertices.count, per_line, where, numbers)) {
    return tl::unexpected(std::move(*error));
  }
  std::vector<PointColumn> columns;
  const std::byte* first = reinterpret_cast<const std::byte*>(numbers.data());
  for (const PlyProperty& property : vertices.properties) {
    columns.push_back({property.name, NumberType::kFloat64, is_integer(property.type), first,
                       per_line * static_cast<std::ptrdiff_t>(sizeof(double))});
    first += sizeof(double);
  }
  return scan_from(columns, vertices.count, where);
}

void swap_endianness(const PlyElement& vertices, std::string& data) {
  char* at = data.data();
  for (std::ptrdiff_t i = 0; i < vertices.count; ++i) {
    for (const PlyProperty& property : vertices.properties) {
      const int size = size_of(property.type);
      std::reverse(at, at + size);
      at += size;
    }
  }
}

Result<LidarScan> parse_binary(const PlyElement& vertices, std::string_view rest, bool big_endian,
                               const Location& where) {
  const std::ptrdiff_t record = vertices.bytes();
  if (std::ssize(rest) < vertices.count * record) return refuse("the file ends early", where);
  std::string swapped;
  if (big_endian) {
    swapped = rest.substr(0, static_cast<std::size_t>(vertices.count * record));
    swap_endianness(vertices, swapped);
    rest = swapped;
  }
  std::vector<PointColumn> columns;
  const auto* first = reinterpret_cast<const std::byte*>(rest.data());
  for (const PlyProperty& property : vertices.properties) {
    columns.push_back({property.name, property.type, is_integer(property.type), first, record});
    first += size_of(property.type);
  }
  return scan_from(columns, vertices.count, where);
}

}  // namespace

Result<LidarScan> parse_ply(std::string_view content, const Location& where) {
  LineReader lines(content);
  const Result<PlyHeader> header = parse_header(lines, where);
  if (!header) return tl::unexpected(header.error());
  const bool ascii = header->format == "ascii";
  if (!ascii && header->format != "binary_little_endian" && header->format != "binary_big_endian") {
    return refuse(fmt::format("format '{}'", header->format), where);
  }
  std::ptrdiff_t skipped_bytes = 0;
  for (const PlyElement& element : header->elements) {
    if (element.has_list && (element.name == "vertex" || !ascii)) {
      return fail(ErrorCode::kUnsupported, fmt::format("element {} holds a list", element.name),
                  "vertices of plain numbers, before other elements", where);
    }
    if (element.name == "vertex") {
      if (ascii) return parse_ascii(element, lines, where);
      if (skipped_bytes > std::ssize(lines.rest())) return refuse("the file ends early", where);
      return parse_binary(element, lines.rest().substr(static_cast<std::size_t>(skipped_bytes)),
                          header->format == "binary_big_endian", where);
    }
    skipped_bytes += element.count * element.bytes();
    std::string_view line;
    for (std::ptrdiff_t i = 0; ascii && i < element.count && lines.next(line);) ++i;
  }
  return refuse("no vertices", where);
}

}  // namespace headland::perception::internal
