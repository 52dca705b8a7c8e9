// SPDX-License-Identifier: Apache-2.0
// Rules that look at the words of a file, or at which files there are.
#include <algorithm>
#include <array>
#include <regex>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "tests/style/rules.hpp"

namespace headland::style {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

bool is_build_file(std::string_view path) {
  return path.ends_with("CMakeLists.txt") || path.ends_with(".cmake") ||
         path.ends_with("CMakePresets.json");
}

template <class Matches>
Complaints complain_where(const SourceFile& file, Matches matches) {
  Complaints complaints;
  int number = 0;
  for (const std::string& line : lines_of(file.text)) {
    ++number;
    const std::string what = matches(line);
    if (!what.empty()) complaints.push_back(fmt::format("{}:{}: {}", file.path, number, what));
  }
  return complaints;
}

bool has_unit(const std::string& key) {
  // DESIGN section 4, and the units built from them; then what has none.
  static const std::regex kUnit(
      R"(_(m|m2|s|ms|rad|deg|mps|kmh|mps2|mps3|radps|radps2|1pm|kg|n|w|wh|j|hz|percent))"
      R"((_per_(m|s|j|kg|rad))?$)");
  static const std::regex kNone(R"((^|_)(ratio|count|weight|weights|soc|probability|factor)$)");
  return std::regex_search(key, kUnit) || std::regex_search(key, kNone);
}

}  // namespace

Complaints check_licence(const SourceFile& file) {
  const bool due = file.path.ends_with(".cpp") || file.path.ends_with(".hpp") ||
                   file.path.ends_with(".ts") || file.path.ends_with(".sh") ||
                   file.path.ends_with(".css") ||
                   (is_build_file(file.path) && !file.path.ends_with(".json"));
  if (!due) return {};
  const auto lines = lines_of(file.text);
  for (std::size_t i = 0; i < std::min<std::size_t>(2, lines.size()); ++i) {
    if (lines[i].find("SPDX-License-Identifier: Apache-2.0") != std::string::npos) return {};
  }
  return {fmt::format("{}:1: no SPDX line", file.path)};
}

Complaints check_units(const SourceFile& file) {
  if (!file.path.ends_with(".hpp") && !file.path.ends_with(".cpp")) return {};
  // The members that are doubles, or hold doubles.
  static const std::regex kMember(
      R"(^\s*(?:double|std::optional<double>|std::vector<double>|std::array<double, \w+>)\s+(\w+)\s*(?:=|;|\{))");
  static const std::regex kVisited(R"rx(\bv(?:\.required)?\(\s*"(\w+)"\s*,\s*(\w+))rx");
  std::set<std::string> doubles;
  for (const std::string& line : lines_of(file.text)) {
    std::smatch match;
    if (std::regex_search(line, match, kMember)) doubles.insert(match[1]);
  }
  Complaints complaints;
  const auto end = std::sregex_iterator();
  for (auto it = std::sregex_iterator(file.text.begin(), file.text.end(), kVisited); it != end;
       ++it) {
    const std::string key = (*it)[1];
    if (doubles.count((*it)[2]) == 0 || has_unit(key)) continue;
    const auto line = std::count(file.text.begin(), file.text.begin() + it->position(), '\n') + 1;
    complaints.push_back(fmt::format("{}:{}: key \"{}\" has no unit", file.path, line, key));
  }
  return complaints;
}

Complaints check_flags(const SourceFile& file) {
  if (!is_build_file(file.path)) return {};
  static const std::regex kFlag(R"(-march|-mavx|-mtune=native|-ffast-math|-Ofast)");
  return complain_where(file, [](const std::string& line) {
    std::smatch match;
    const std::string code = line.substr(0, line.find('#'));
    return std::regex_search(code, match, kFlag) ? "flag " + match[0].str() : std::string();
  });
}

Complaints check_machine_paths(const SourceFile& file) {
  static const std::regex kPath(R"((^|[^\w./])/(work|root|home/\w+|Users)(/|$))");
  return complain_where(file, [](const std::string& line) {
    std::smatch match;
    return std::regex_search(line, match, kPath) ? "path of a machine: " + match[0].str()
                                                 : std::string();
  });
}

Complaints check_readmes(const std::vector<SourceFile>& tree) {
  static constexpr std::array kFolders = {"apps",           "console",       "control",
                                          "core",           "fleet",         "sim",
                                          "global_planner", "local_planner", "perception"};
  std::set<std::string> folders;
  std::set<std::string> readmes;
  for (const SourceFile& file : tree) {
    if (file.path.ends_with("/README.md")) {
      readmes.insert(file.path.substr(0, file.path.rfind('/')));
    }
    const std::size_t first = file.path.find('/');
    if (first == std::string::npos || file.path.ends_with(".md")) continue;
    const std::string top = file.path.substr(0, first);
    if (std::find(kFolders.begin(), kFolders.end(), top) == kFolders.end()) continue;
    folders.insert(top);
    const std::size_t second = file.path.find('/', first + 1);
    if (second != std::string::npos && top != "console")
      folders.insert(file.path.substr(0, second));
  }
  Complaints complaints;
  for (const std::string& folder : folders) {
    if (readmes.count(folder) == 0) complaints.push_back(folder + ":1: no README.md");
  }
  return complaints;
}

Complaints check_papers(const SourceFile& papers, const std::vector<SourceFile>& tree) {
  static const std::regex kFile(R"(`([\w/.-]+/[\w.-]+\.\w+)(?:[:#][^`]*)?`)");
  return complain_where(papers, [&](const std::string& line) {
    if (!line.starts_with("|")) return std::string();
    const auto end = std::sregex_iterator();
    for (auto it = std::sregex_iterator(line.begin(), line.end(), kFile); it != end; ++it) {
      const std::string path = (*it)[1];
      const bool exists = std::any_of(tree.begin(), tree.end(),
                                      [&](const SourceFile& file) { return file.path == path; });
      if (!exists) return "there is no " + path;
    }
    return std::string();
  });
}

}  // namespace headland::style
