// SPDX-License-Identifier: Apache-2.0
#include "apps/command.hpp"

#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "core/base/random.hpp"

namespace headland::apps {

std::string styled(const std::string& text, const char* ansi_code) {
  if (isatty(STDERR_FILENO) == 0 || std::getenv("NO_COLOR") != nullptr) return text;
  return fmt::format("\033[{}m{}\033[0m", ansi_code, text);
}

int report_error(const Error& error, const CommonOptions& options) {
  fmt::print(stderr, "{} {}\n", styled("error:", "1;31"), to_string(error));
  const int code = exit_code(error.code);
  if (options.json) {
    const nlohmann::ordered_json document = {{"error",
                                              {{"code", static_cast<int>(error.code)},
                                               {"what", error.what},
                                               {"remedy", error.remedy},
                                               {"file", error.where.file},
                                               {"line", error.where.line},
                                               {"key", error.where.key}}},
                                             {"exit_code", code}};
    fmt::print("{}\n", document.dump(2));
  }
  return code;
}

namespace {

Result<config::Node> with_overrides(Result<config::Node> node, const CommonOptions& options) {
  if (!node) return node;
  for (const std::string& assignment : options.set) {
    const auto equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) {
      return fail(ErrorCode::kSyntax, "'" + assignment + "' is no assignment",
                  "write --set key=value", {"--set", 0, ""});
    }
    if (auto set = node->set(assignment.substr(0, equals), assignment.substr(equals + 1)); !set) {
      return tl::unexpected<Error>(set.error());
    }
  }
  return node;
}

}  // namespace

Result<config::Node> load_with_overrides(const CommonOptions& options) {
  return with_overrides(config::Node::load(options.file), options);
}

Result<config::Node> overrides_only(const CommonOptions& options) {
  return with_overrides(config::Node::parse("{}", "--set"), options);
}

Stamp make_stamp(std::uint64_t seed, std::string config_yaml) {
  Stamp stamp{HEADLAND_VERSION, seed, std::move(config_yaml), ""};
  stamp.config_hash = fmt::format("{:016x}", fnv1a(stamp.config_yaml));
  return stamp;
}

ProgressBar::ProgressBar(std::string label)
    : label_(std::move(label)), terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (terminal_ && shown_percent_ >= 0) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::update(double fraction, const std::string& note) {
  const int percent = static_cast<int>(100.0 * fraction);
  if (!terminal_ || (percent == shown_percent_ && note == shown_note_)) return;
  shown_percent_ = percent;
  shown_note_ = note;
  constexpr int kWidth = 32;
  const int filled = kWidth * percent / 100;
  fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {:3d} % {}\033[K", label_, "", filled, "",
             kWidth - filled, percent, note);
  std::fflush(stderr);
}

}  // namespace headland::apps
