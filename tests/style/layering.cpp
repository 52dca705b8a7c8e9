// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <regex>
#include <sstream>

#include <fmt/format.h>

#include "tests/style/rules.hpp"

namespace headland::style {
namespace {

using Folders = std::vector<std::string_view>;

// The longest folder that holds a file decides. Itself is always allowed.
struct Layer {
  std::string_view folder;
  Folders may_include;
};

const std::vector<Layer>& layers() {
  static const std::vector<Layer> kLayers = {
      {"core", {}},
      {"global_planner", {"core"}},
      {"local_planner", {"core"}},
      {"control", {"core"}},
      {"perception", {"core"}},
      {"fleet/behavior", {"core"}},
      {"fleet/vehicle",
       {"core", "global_planner", "local_planner", "control", "perception", "fleet/behavior"}},
      {"fleet/coordinator", {"core", "global_planner"}},
      {"fleet/store", {"core", "fleet"}},
      {"fleet/dds", {"core", "fleet"}},
      {"fleet/server", {"core", "fleet"}},
      {"sim", {"core"}},
      {"sim/lab",
       {"core", "global_planner", "local_planner", "control", "perception", "fleet", "sim"}},
      {"apps",
       {"core", "global_planner", "local_planner", "control", "perception", "fleet", "sim"}},
  };
  return kLayers;
}

// Libraries by how their headers begin, and the only folders that may know them. They stay out of
// public headers; the three that may stand there have no folder.
struct Library {
  std::string_view prefix;
  Folders folders;
};

const std::vector<Library>& libraries() {
  static const std::vector<Library> kLibraries = {
      {"Eigen/", {}},
      {"unsupported/Eigen/", {}},
      {"tl/", {}},
      {"fmt/", {}},
      {"sys/", {}},
      {"unistd.h", {}},
      {"yaml-cpp/", {"core"}},
      {"nlohmann/", {"core", "sim/lab", "apps"}},
      {"geos_c.h", {"core"}},
      {"geos/", {"core"}},
      {"GeographicLib/", {"core"}},
      {"gdal", {"core"}},
      {"ogr", {"core"}},
      {"cpl_", {"core"}},
      {"pugixml", {"core"}},
      {"ompl/", {"global_planner/roadmap"}},
      {"coin", {"control/receding_horizon"}},
      {"Ip", {"control/receding_horizon"}},
      {"pcl/", {"perception"}},
      {"opencv2/", {"perception"}},
      {"octomap/", {"perception"}},
      {"nanoflann", {"perception"}},
      {"dds/", {"fleet/dds"}},
      {"boost/", {"fleet/server"}},
      {"sqlite3", {"fleet/store"}},
      {"openssl/", {"fleet"}},
      {"spdlog/", {"core", "apps"}},
      {"CLI/", {"apps"}},
      {"torch/", {"sim/lab/training"}},
  };
  return kLibraries;
}

bool is_below(std::string_view path, std::string_view folder) {
  return path.starts_with(folder) && path.size() > folder.size() && path[folder.size()] == '/';
}

bool is_below_any(std::string_view path, const Folders& folders) {
  return std::any_of(folders.begin(), folders.end(),
                     [&](std::string_view folder) { return is_below(path, folder); });
}

const Layer* layer_of(std::string_view path) {
  const Layer* best = nullptr;
  for (const Layer& layer : layers()) {
    if (is_below(path, layer.folder) && (!best || layer.folder.size() > best->folder.size())) {
      best = &layer;
    }
  }
  return best;
}

bool is_ours(std::string_view header) {
  const std::string_view top = header.substr(0, header.find('/'));
  return std::any_of(layers().begin(), layers().end(), [&](const Layer& layer) {
    return layer.folder.substr(0, layer.folder.find('/')) == top;
  });
}

std::string check_own(const SourceFile& file, const Layer& layer, std::string_view header) {
  const Layer* target = layer_of(header);
  const bool same = target == &layer;
  // sim must not reach into sim/lab, though it lies below.
  const bool allowed = same || (is_below_any(header, layer.may_include) &&
                                !(target && target->folder == "sim/lab" && layer.folder != "apps"));
  if (!allowed) return fmt::format("{} must not include \"{}\"", layer.folder, header);
  const std::size_t inner = header.find("/internal/");
  if (inner != std::string_view::npos && !is_below(file.path, header.substr(0, inner))) {
    return fmt::format("\"{}\" is private to {}", header, header.substr(0, inner));
  }
  return {};
}

std::string check_library(const SourceFile& file, std::string_view header) {
  const bool standard = header.find_first_of("/.") == std::string_view::npos;
  if (standard) return {};
  for (const Library& library : libraries()) {
    if (!header.starts_with(library.prefix)) continue;
    if (library.folders.empty()) return {};
    if (!is_below_any(file.path, library.folders)) {
      return fmt::format("<{}> belongs to {} alone", header, fmt::join(library.folders, ", "));
    }
    const bool hidden =
        file.path.ends_with(".cpp") || file.path.find("/internal/") != std::string::npos;
    return hidden ? std::string() : fmt::format("<{}> in a public header", header);
  }
  return fmt::format("<{}> is of a library that tests/style/layering.cpp does not know", header);
}

}  // namespace

Complaints check_layering(const SourceFile& file) {
  const Layer* layer = layer_of(file.path);
  if (!layer || !(file.path.ends_with(".cpp") || file.path.ends_with(".hpp"))) return {};
  static const std::regex kInclude(R"(^\s*#\s*include\s*["<]([^">]+)[">])");
  Complaints complaints;
  std::istringstream lines(file.text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::smatch match;
    if (!std::regex_search(line, match, kInclude)) continue;
    const std::string header = match[1];
    const std::string what =
        is_ours(header) ? check_own(file, *layer, header) : check_library(file, header);
    if (!what.empty()) complaints.push_back(fmt::format("{}:{}: {}", file.path, number, what));
  }
  return complaints;
}

}  // namespace headland::style
