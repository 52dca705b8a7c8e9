// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.hpp"

#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

namespace headland {

std::string to_string(const Error& error) {
  std::string text;
  if (!error.where.file.empty()) {
    text += error.where.file;
    if (error.where.line > 0) text += fmt::format(":{}", error.where.line);
    text += ": ";
  }
  if (!error.where.key.empty()) text += error.where.key + ": ";
  text += error.what;
  if (!error.remedy.empty()) text += "; " + error.remedy;
  return text + fmt::format(" [E{}]", static_cast<int>(error.code));
}

int exit_code(ErrorCode code) {
  const int number = static_cast<int>(code);
  if (number < 200) return 2;
  if (number < 300) return 3;
  return 4;
}

void fail_check(std::string_view condition, std::string_view what, const char* file, int line) {
  fmt::print(stderr, "headland: internal error: {} ({}) at {}:{}\n", what, condition, file, line);
  std::abort();
}

}  // namespace headland
