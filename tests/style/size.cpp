// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <regex>

#include <fmt/format.h>

#include "tests/style/rules.hpp"

namespace headland::style {
namespace {

constexpr int kMaxFileLines = 600;
constexpr int kMaxFunctionLines = 80;

bool is_code(std::string_view path) {
  return path.ends_with(".cpp") || path.ends_with(".hpp") || path.ends_with(".ts");
}

// Whether a brace opens the body of a function, by what stands between it and the statement before.
bool opens_function(const std::string& before) {
  static const std::regex kOther(
      R"(^\s*(if|for|while|switch|catch|do|else|namespace|class|struct|enum|union|interface)\b)");
  return before.find('(') != std::string::npos && before.find(')') != std::string::npos &&
         !std::regex_search(before, kOther);
}

}  // namespace

Complaints check_size(const SourceFile& file) {
  if (!is_code(file.path)) return {};
  Complaints complaints;
  const auto lines = std::count(file.text.begin(), file.text.end(), '\n');
  if (lines > kMaxFileLines) {
    complaints.push_back(
        fmt::format("{}:1: {} lines, more than {}", file.path, lines, kMaxFileLines));
  }
  struct Brace {
    int line;
    bool function;
  };
  std::vector<Brace> open;
  std::string before;
  int line = 1;
  for (const char c : without_literals(file.text)) {
    if (c == '\n') ++line;
    if (c == '{') {
      open.push_back({line, opens_function(before)});
    } else if (c == '}' && !open.empty()) {
      const Brace brace = open.back();
      open.pop_back();
      const int length = line - brace.line + 1;
      if (brace.function && length > kMaxFunctionLines) {
        complaints.push_back(fmt::format("{}:{}: a function of {} lines, more than {}", file.path,
                                         brace.line, length, kMaxFunctionLines));
      }
    }
    // A semicolon inside parentheses, as in for (;;), ends no statement.
    const bool inside = std::count(before.begin(), before.end(), '(') >
                        std::count(before.begin(), before.end(), ')');
    if (c == '{' || c == '}' || (c == ';' && !inside)) {
      before.clear();
    } else {
      before += c;
    }
  }
  return complaints;
}

}  // namespace headland::style
