// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/tsplib_text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>

#include <fmt/format.h>

namespace headland::tour {
namespace {

constexpr double kAnyNumber = -1e15;

std::string capitals(std::string_view word) {
  std::string upper(word);
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return upper;
}

std::string_view without_colon(std::string_view word) { return word.substr(0, word.find(':')); }

// First and last column of each row that the format writes.
std::pair<int, int> columns(const std::string& format, int row, int count) {
  if (format == "UPPER_ROW") return {row + 1, count - 1};
  if (format == "UPPER_DIAG_ROW") return {row, count - 1};
  if (format == "LOWER_ROW") return {0, row - 1};
  if (format == "LOWER_DIAG_ROW") return {0, row};
  return {0, count - 1};
}

}  // namespace

TsplibText::TsplibText(InstanceText& text) : text_(text) {
  std::vector<Word>* section = nullptr;
  for (const auto& words : text.lines()) {
    const std::string first = capitals(without_colon(words.front().text));
    const int line = words.front().line;
    if (first == "EOF") break;
    const std::string_view whole = text.line_text(line);
    const std::size_t colon = whole.find(':');
    if (first.ends_with("_SECTION")) {
      section = &sections_[first];
      section_line_.emplace(first, line);
    } else if (colon != std::string_view::npos) {
      std::string_view rest = whole.substr(colon + 1);
      rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
      header_[first] = {rest.substr(0, rest.find_first_of(" \t")), line};
      section = nullptr;
    } else if (section != nullptr) {
      section->insert(section->end(), words.begin(), words.end());
    } else {
      text.wrong(ErrorCode::kSyntax, line, "neither 'KEY: value' nor a section",
                 "allowed: the header's keys, then sections such as NODE_COORD_SECTION");
    }
  }
}

int TsplibText::line_of(const std::string& key) const {
  if (const auto found = header_.find(key); found != header_.end()) return found->second.line;
  if (const auto found = section_line_.find(key); found != section_line_.end())
    return found->second;
  return text_.last_line();
}

Word TsplibText::value(const std::string& key) {
  const auto found = header_.find(key);
  if (found != header_.end() && !found->second.text.empty()) return found->second;
  text_.wrong(ErrorCode::kMissingKey, line_of(key), key + ": required key is missing",
              fmt::format("write '{}: value' in the header", key));
  return {"0", line_of(key)};
}

std::string TsplibText::word(const std::string& key) { return capitals(value(key).text); }

double TsplibText::number(const std::string& key, double least) {
  return text_.number(value(key), key, least);
}

int TsplibText::whole(const std::string& key, int least, int most) {
  return text_.whole(value(key), key, least, most);
}

const std::vector<Word>& TsplibText::section(const std::string& name, int count) {
  const std::vector<Word>& words = sections_[name];
  if (section_line_.count(name) == 0) {
    text_.wrong(ErrorCode::kMissingKey, text_.last_line(), name + ": required section is missing",
                "the file may be cut off");
  } else if (count >= 0 && std::ssize(words) != count) {
    text_.wrong(
        ErrorCode::kSyntax, words.empty() ? line_of(name) : words.back().line,
        fmt::format("{} has {} words", name, words.size()),
        fmt::format("allowed: {}, by DIMENSION and the formats named in the header", count));
  }
  return words;
}

std::vector<Point> TsplibText::coordinates(int count) {
  const auto& words = section("NODE_COORD_SECTION", 3 * count);
  std::vector<Point> points(static_cast<std::size_t>(count));
  std::vector<bool> seen(points.size(), false);
  for (std::size_t w = 0; w + 2 < words.size() && text_.ok(); w += 3) {
    const auto id = static_cast<std::size_t>(text_.whole(words[w], "node", 1, count) - 1);
    if (seen[id]) {
      text_.wrong(ErrorCode::kSyntax, words[w].line, fmt::format("node {} a second time", id + 1),
                  "give each node once");
    }
    seen[id] = true;
    points[id] = {text_.number(words[w + 1], "coordinate", kAnyNumber),
                  text_.number(words[w + 2], "coordinate", kAnyNumber)};
  }
  return points;
}

std::vector<double> TsplibText::values(const std::string& section_name, int count) {
  const auto& words = section(section_name, 2 * count);
  std::vector<double> values(static_cast<std::size_t>(count), -1.0);
  for (std::size_t w = 0; w + 1 < words.size() && text_.ok(); w += 2) {
    double& value = values[static_cast<std::size_t>(text_.whole(words[w], "node", 1, count) - 1)];
    if (value >= 0.0) {
      text_.wrong(ErrorCode::kSyntax, words[w].line,
                  fmt::format("node {} a second time", words[w].text), "give each node once");
    }
    value = text_.number(words[w + 1], "value", 0.0);
  }
  return values;
}

std::function<double(int, int)> TsplibText::explicit_lengths(int count) {
  const std::string format = word("EDGE_WEIGHT_FORMAT");
  const bool known = format == "FULL_MATRIX" || format == "UPPER_ROW" ||
                     format == "UPPER_DIAG_ROW" || format == "LOWER_ROW" ||
                     format == "LOWER_DIAG_ROW";
  if (!known) {
    text_.wrong(ErrorCode::kUnsupported, line_of("EDGE_WEIGHT_FORMAT"),
                "EDGE_WEIGHT_FORMAT: unknown format",
                "allowed: FULL_MATRIX, UPPER_ROW, UPPER_DIAG_ROW, LOWER_ROW, LOWER_DIAG_ROW");
  }
  int total = 0;
  for (int row = 0; row < count; ++row) {
    const auto [first, last] = columns(format, row, count);
    total += last - first + 1;
  }
  const auto& words = section("EDGE_WEIGHT_SECTION", total);
  const auto n = static_cast<std::size_t>(count);
  auto matrix =
      std::make_shared<std::vector<double>>(n * n, 0.0);  // shared by copies of the answer
  std::size_t w = 0;
  for (int row = 0; row < count && text_.ok(); ++row) {
    const auto [first, last] = columns(format, row, count);
    for (int column = first; column <= last; ++column) {
      // What the diagonal says is unused: a very large number, zero or a negative one.
      const bool used = row != column;
      const double value = text_.number(words[w++], "weight", used ? 0.0 : kAnyNumber);
      const auto a = static_cast<std::size_t>(row);
      const auto b = static_cast<std::size_t>(column);
      (*matrix)[a * n + b] = value;
      if (format != "FULL_MATRIX") (*matrix)[b * n + a] = value;
    }
  }
  return [matrix, n](int from, int to) {
    return (*matrix)[static_cast<std::size_t>(from) * n + static_cast<std::size_t>(to)];
  };
}

std::function<double(int, int)> TsplibText::lengths(int count) {
  const std::string type = word("EDGE_WEIGHT_TYPE");
  if (type == "EXPLICIT") return explicit_lengths(count);
  if (type != "EUC_2D" && type != "CEIL_2D" && type != "ATT") {
    text_.wrong(ErrorCode::kUnsupported, line_of("EDGE_WEIGHT_TYPE"),
                "EDGE_WEIGHT_TYPE: unknown type", "allowed: EXPLICIT, EUC_2D, CEIL_2D, ATT");
  }
  return [points = coordinates(count), type](int a, int b) {
    const double d =
        euclidean(points[static_cast<std::size_t>(a)], points[static_cast<std::size_t>(b)]);
    if (type == "CEIL_2D") return std::ceil(d);
    if (type == "ATT") return std::ceil(d / std::sqrt(10.0));  // pseudo-Euclidean: rounded up
    return std::floor(d + 0.5);
  };
}

}  // namespace headland::tour
