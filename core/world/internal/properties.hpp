// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"

namespace headland::internal {

enum class Need { kOptional, kRequired };

/// Reads the members of a JSON object one by one and remembers the first that is wrong. finish()
/// reports it, and members that nobody asked for.
class Properties {
 public:
  /// `where` is the object's place; both must outlive this.
  Properties(const nlohmann::json& object, const Location& where)
      : object_(object), where_(where) {}

  /// A text; empty where absent. A required text is not empty.
  std::string text(const std::string& key, Need need);
  /// A finite number in range; `otherwise` where absent.
  double number(const std::string& key, config::Range range, Need need, double otherwise);
  int whole(const std::string& key, config::Range range, Need need, int otherwise);
  /// The value as it is, or null.
  nlohmann::json raw(const std::string& key);
  bool has(const std::string& key) const { return object_.contains(key); }

  /// Errors in this order: a wrong value, an unknown key (a misspelt one is more likely than a
  /// missing one), a missing key.
  Result<void> finish() const;

 private:
  const nlohmann::json* find(const std::string& key, Need need);
  void wrong(ErrorCode code, const std::string& key, std::string what, std::string remedy);

  const nlohmann::json& object_;
  const Location& where_;
  std::vector<std::string> known_;
  std::optional<Error> error_;
  std::optional<Error> missing_;
};

}  // namespace headland::internal
