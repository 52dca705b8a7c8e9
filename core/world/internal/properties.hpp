// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "core/model/charge_curve.hpp"

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
  /// One of an enum's names (config::EnumNames), required; `otherwise` where it is wrong.
  template <class E>
  E choice(const std::string& key, E otherwise) {
    std::vector<std::string> names;
    for (const auto& [value, name] : config::EnumNames<E>::values) names.emplace_back(name);
    const auto index = choice(key, names);
    return index ? config::EnumNames<E>::values[*index].first : otherwise;
  }
  /// A power in watts, or a list of [soc, power] by rising soc.
  ChargeCurve charge_curve(const std::string& key, const ChargeCurve& otherwise);
  /// The value as it is, or null.
  nlohmann::json raw(const std::string& key);
  bool has(const std::string& key) const { return object_.contains(key); }

  /// Errors in this order: a wrong value, an unknown key (a misspelt one is more likely than a
  /// missing one), a missing key.
  Result<void> finish() const;

 private:
  const nlohmann::json* find(const std::string& key, Need need);
  void wrong(ErrorCode code, const std::string& key, std::string what, std::string remedy);
  std::optional<std::size_t> choice(const std::string& key, const std::vector<std::string>& names);

  const nlohmann::json& object_;
  const Location& where_;
  std::vector<std::string> known_;
  std::optional<Error> error_;
  std::optional<Error> missing_;
};

}  // namespace headland::internal
