// SPDX-License-Identifier: Apache-2.0
#include "core/world/internal/agrids.hpp"

#include <map>
#include <set>

#include <fmt/format.h>

namespace headland::internal {
namespace {

using nlohmann::json;

std::string text(const Feature& feature, const char* key) {
  const auto at = feature.properties.find(key);
  return at != feature.properties.end() && at->is_string() ? at->get<std::string>() : "";
}

bool has_type(const Feature& feature, const char* suffix) {
  if (!feature.geometry.is_object()) return false;
  const json type = feature.geometry.value("type", json());
  return type.is_string() && type.get<std::string>().ends_with(suffix);
}

// `wanted`, or else with "-2", "-3", ... behind it.
std::string unique(const std::string& wanted, std::set<std::string>& taken) {
  std::string id = wanted;
  for (int n = 2; !taken.insert(id).second; ++n) id = fmt::format("{}-{}", wanted, n);
  return id;
}

// Blocks by their shortCode and by their long id: rows may name either. Of a repeated shortCode the
// first block counts.
std::map<std::string, std::string> name_blocks(std::vector<Feature>& features,
                                               std::set<std::string>& taken) {
  std::map<std::string, std::string> block_ids;
  for (Feature& f : features) {
    if (text(f, "class") != "block") continue;
    const std::string code = text(f, "shortCode");
    const std::string long_id = text(f, "id");
    const std::string id = unique(code.empty() ? "block" : code, taken);
    if (!code.empty()) block_ids.emplace(code, id);
    if (!long_id.empty()) block_ids.emplace(long_id, id);
    f.properties = {{"kind", "row_parcel"}, {"id", id}, {"name", text(f, "name")}};
  }
  return block_ids;
}

json row_properties(const Feature& f, const std::map<std::string, std::string>& block_ids,
                    std::set<std::string>& taken) {
  const std::string block = text(f, "block");
  const auto known = block_ids.find(block);
  const std::string parcel = known == block_ids.end() ? block : known->second;
  const std::string code = text(f, "shortCode");
  return {{"kind", "row"}, {"parcel", parcel}, {"id", unique(code.empty() ? "row" : code, taken)}};
}

// Properties in our schema, or null for what has no meaning to us.
json other_properties(const Feature& f, std::set<std::string>& taken) {
  const std::string type = text(f, "class");
  const std::string code = text(f, "shortCode");
  if (type == "entrance_exit" && has_type(f, "Point")) {
    return {{"kind", "gate"}, {"id", unique(code.empty() ? "gate" : code, taken)}};
  }
  if ((type == "building" || type == "conservation") && has_type(f, "Polygon")) {
    return {{"kind", "keep_out"}, {"id", unique(code.empty() ? type : code, taken)}};
  }
  const bool place = type == "building" || type == "toilet" || type == "chemical_storage" ||
                     text(f, "category") == "hazardous_material";
  if (place && has_type(f, "Point")) {
    return {{"kind", "poi"}, {"role", type}, {"id", unique(code.empty() ? type : code, taken)}};
  }
  return nullptr;
}

}  // namespace

std::vector<Feature> from_agrids(std::vector<Feature> features) {
  std::set<std::string> taken;
  std::set<std::string> taken_rows;
  const auto block_ids = name_blocks(features, taken);
  std::vector<Feature> ours;
  for (Feature& f : features) {
    if (text(f, "kind") != "row_parcel") {
      f.properties = text(f, "class") == "row" ? row_properties(f, block_ids, taken_rows)
                                               : other_properties(f, taken);
    }
    if (!f.properties.is_null()) ours.push_back(std::move(f));
  }
  return ours;
}

}  // namespace headland::internal
