// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/instance_io.hpp"

#include <fstream>
#include <iterator>

#include "global_planner/tour/internal/instance_text.hpp"

namespace headland {
namespace {

enum class Format { kUnknown, kTsplib, kSchneider, kOrienteering };

// By the first line: a table's head, a header's `KEY: value`, or a budget and a number of paths.
Format recognise(const tour::InstanceText& text) {
  if (text.lines().empty()) return Format::kUnknown;
  const auto& words = text.lines().front();
  const std::string_view line = text.line_text(words.front().line);
  if (words.front().text == "StringID") return Format::kSchneider;
  if (line.find(':') != std::string_view::npos) return Format::kTsplib;
  const bool budget = std::string_view("+.0123456789").find(line.front()) != std::string_view::npos;
  if (budget || words.front().text == "n") return Format::kOrienteering;
  return Format::kUnknown;
}

}  // namespace

Result<RouteInstance> parse_instance(const std::string& file, const std::string& content) {
  tour::InstanceText text(file, content);
  RouteInstance instance;
  switch (recognise(text)) {
    case Format::kTsplib:
      instance = tour::read_tsplib(text);
      break;
    case Format::kSchneider:
      instance = tour::read_schneider(text);
      break;
    case Format::kOrienteering:
      instance = tour::read_orienteering(text);
      break;
    case Format::kUnknown:
      text.wrong(ErrorCode::kSyntax, 1, "not a routing instance",
                 "allowed: TSPLIB (TSP, ATSP, OP), EVRP (CEC-12), E-VRPTW (Schneider), OP "
                 "(Tsiligirides, Chao)");
  }
  if (!text.ok()) return tl::unexpected<Error>(*text.error());
  instance.name = text.stem();
  return instance;
}

Result<RouteInstance> load_instance(const std::filesystem::path& path) {
  std::error_code code;
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path, code)) {
    return fail(ErrorCode::kFileNotFound, stream ? "is a directory" : "no such file",
                "name a routing instance", {path.string(), 0, ""});
  }
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  return parse_instance(path.string(), content);
}

}  // namespace headland
