// SPDX-License-Identifier: Apache-2.0
// Reading the tree, and telling code from comments and literals.
#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>

#include "tests/style/rules.hpp"

namespace headland::style {
namespace fs = std::filesystem;
namespace {

constexpr std::array kFolders = {
    ".ci",  "apps",  "bench", "cmake", "config",         "console",       "control",   "core",
    "docs", "fleet", "sim",   "tests", "global_planner", "local_planner", "perception"};
constexpr std::array kTextEndings = {".cpp", ".hpp", ".ts",   ".sh",   ".cmake", ".txt",
                                     ".md",  ".css", ".html", ".json", ".yaml",  ".geojson"};

bool is_text(const fs::path& path) {
  const std::string ending = path.extension().string();
  return ending.empty() ||
         std::find(kTextEndings.begin(), kTextEndings.end(), ending) != kTextEndings.end();
}

// End (exclusive) of the comment or literal that begins at `at`; `at` itself if none does.
std::size_t end_of_literal(std::string_view text, std::size_t at) {
  const auto after = [&](std::string_view mark, std::size_t from) {
    const std::size_t found = text.find(mark, from);
    return found == std::string_view::npos ? text.size() : found + mark.size();
  };
  const std::string_view rest = text.substr(at);
  if (rest.starts_with("//")) return std::min(text.find('\n', at), text.size());
  if (rest.starts_with("/*")) return after("*/", at + 2);
  if (rest.starts_with("R\"")) {
    const std::size_t open = text.find('(', at);
    if (open == std::string_view::npos) return text.size();
    return after(")" + std::string(text.substr(at + 2, open - at - 2)) + "\"", open);
  }
  const char quote = text[at];
  if (quote != '"' && quote != '\'' && quote != '`') return at;
  const bool digit_separator = quote == '\'' && at > 0 && at + 1 < text.size() &&
                               std::isxdigit(static_cast<unsigned char>(text[at - 1])) != 0 &&
                               std::isxdigit(static_cast<unsigned char>(text[at + 1])) != 0 &&
                               (at + 2 >= text.size() || text[at + 2] != '\'');
  if (digit_separator) return at;
  for (std::size_t i = at + 1; i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (text[i] == quote) {
      return i + 1;
    } else if (text[i] == '\n' && quote != '`') {
      return i;  // not a literal after all; an apostrophe
    }
  }
  return text.size();
}

}  // namespace

std::string without_literals(std::string_view text) {
  std::string code(text);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = end_of_literal(text, at);
    for (std::size_t i = at; i < end; ++i) {
      if (code[i] != '\n') code[i] = ' ';
    }
    at = std::max(end, at + 1);
  }
  return code;
}

std::vector<SourceFile> read_tree(const fs::path& root) {
  std::vector<SourceFile> tree;
  const auto add = [&](const fs::path& path) {
    if (!is_text(path)) return;
    std::ifstream in(path, std::ios::binary);
    tree.push_back({fs::relative(path, root).generic_string(),
                    {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()}});
  };
  for (const auto& entry : fs::directory_iterator(root)) {
    // .git is a file in a work tree of git's.
    if (entry.is_regular_file() && entry.path().filename() != ".git") add(entry.path());
  }
  for (const char* folder : kFolders) {
    if (!fs::exists(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.is_regular_file()) add(entry.path());
    }
  }
  std::sort(tree.begin(), tree.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return tree;
}

}  // namespace headland::style
