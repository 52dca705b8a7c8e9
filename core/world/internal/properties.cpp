// SPDX-License-Identifier: Apache-2.0
#include "core/world/internal/properties.hpp"

#include <algorithm>
#include <cmath>

#include "core/config/messages.hpp"
#include "core/world/internal/geojson.hpp"

namespace headland::internal {

const nlohmann::json* Properties::find(const std::string& key, Need need) {
  known_.push_back(key);
  const auto at = object_.find(key);
  if (at != object_.end() && !at->is_null()) return &*at;
  if (need == Need::kRequired && !missing_) {
    missing_ = Error{ErrorCode::kMissingKey, "required key is missing", "", below(where_, key)};
  }
  return nullptr;
}

void Properties::wrong(ErrorCode code, const std::string& key, std::string what,
                       std::string remedy) {
  if (!error_) error_ = Error{code, std::move(what), std::move(remedy), below(where_, key)};
}

std::string Properties::text(const std::string& key, Need need) {
  const auto* value = find(key, need);
  if (value == nullptr) return {};
  if (!value->is_string()) {
    wrong(ErrorCode::kWrongType, key, describe(*value) + " is not a text", "");
    return {};
  }
  if (need == Need::kRequired && value->get_ref<const std::string&>().empty()) {
    wrong(ErrorCode::kOutOfRange, key, "the text is empty", "give it a name");
  }
  return value->get<std::string>();
}

double Properties::number(const std::string& key, config::Range range, Need need,
                          double otherwise) {
  const auto* value = find(key, need);
  if (value == nullptr) return otherwise;
  if (!value->is_number()) {
    wrong(ErrorCode::kWrongType, key, describe(*value) + " is not a number", "");
    return otherwise;
  }
  const double number = value->get<double>();
  if (!(number >= range.min && number <= range.max) || !std::isfinite(number)) {
    wrong(ErrorCode::kOutOfRange, key, value->dump() + " is out of range", config::allowed(range));
  }
  return number;
}

int Properties::whole(const std::string& key, config::Range range, Need need, int otherwise) {
  const auto* value = find(key, need);
  if (value == nullptr) return otherwise;
  if (!value->is_number_integer()) {
    wrong(ErrorCode::kWrongType, key, describe(*value) + " is not a whole number", "");
    return otherwise;
  }
  const double number = value->get<double>();
  if (!(number >= range.min && number <= range.max)) {
    wrong(ErrorCode::kOutOfRange, key, value->dump() + " is out of range", config::allowed(range));
    return otherwise;
  }
  return static_cast<int>(number);
}

nlohmann::json Properties::raw(const std::string& key) {
  const auto* value = find(key, Need::kOptional);
  return value == nullptr ? nlohmann::json() : *value;
}

Result<void> Properties::finish() const {
  if (error_) return tl::unexpected<Error>(*error_);
  for (const auto& [key, value] : object_.items()) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
      return fail(ErrorCode::kUnknownKey, "unknown key", config::suggestion(key, known_),
                  below(where_, key));
    }
  }
  if (missing_) return tl::unexpected<Error>(*missing_);
  return {};
}

}  // namespace headland::internal
