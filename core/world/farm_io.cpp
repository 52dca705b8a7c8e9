// SPDX-License-Identifier: Apache-2.0
#include "core/world/farm_io.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/config/messages.hpp"
#include "core/world/internal/agrids.hpp"
#include "core/world/internal/geojson.hpp"
#include "core/world/internal/properties.hpp"
#include "core/world/internal/row_fit.hpp"

namespace headland {
namespace {

using config::kPositive;
using config::Range;
using internal::below;
using internal::Feature;
using internal::Need;
using internal::Properties;

constexpr double kRowTolerance = 0.5;  // [m] rows hug, and surveyed ones pass, their boundary
constexpr double kProbeWidth = 0.002;  // [m] of the strip that stands for a row in set operations
constexpr Range kHeadingDeg{-360.0, 360.0};
constexpr Range kHeadlandM{0.0, 1000.0};
constexpr Range kWidthM{0.1, 1000.0};

const std::vector<std::string> kKinds{"row_parcel", "row", "free_parcel", "road",    "keep_out",
                                      "gate",       "poi", "charger",     "terrain", "soil"};

// Puts features together to a farm. What one feature alone can tell is checked when it is added,
// the rest in finish().
class FarmBuilder {
 public:
  FarmBuilder(LocalFrame frame, const FarmDefaults& defaults) : defaults_(defaults) {
    farm_.frame = frame;
  }

  Result<void> add(const Feature& feature);
  Result<Farm> finish(const std::string& name);

 private:
  struct PendingRow {
    Row row;
    std::string parcel;
    Location where;
  };
  struct ParcelSource {
    Location where;
    bool has_spacing = false;
    bool has_heading = false;
    std::vector<Location> rows;  // where each of its rows stands
  };

  Result<void> add_row_parcel(const Feature& feature, Properties& properties);
  Result<void> add_row(const Feature& feature, Properties& properties);
  Result<void> add_free_parcel(const Feature& feature, Properties& properties);
  Result<void> add_road(const Feature& feature, Properties& properties);
  Result<void> add_keep_out(const Feature& feature, Properties& properties);
  Result<void> add_gate(const Feature& feature, Properties& properties);
  Result<void> add_poi(const Feature& feature, Properties& properties);
  Result<void> add_charger(const Feature& feature, Properties& properties);
  Result<void> add_terrain(const Feature& feature, Properties& properties);
  Result<void> add_soil(const Feature& feature, Properties& properties);

  Result<void> take_id(const std::string& id, const Location& where);
  template <class T>
  void name_the_nameless(std::vector<T>& list, const std::string& kind);
  Result<void> assign_rows();
  Result<void> complete(RowParcel& parcel, const ParcelSource& source) const;

  const FarmDefaults& defaults_;
  Farm farm_;
  std::map<std::string, Location> ids_;
  std::vector<PendingRow> pending_rows_;
  std::vector<ParcelSource> sources_;  // of farm_.row_parcels
};

Result<void> FarmBuilder::take_id(const std::string& id, const Location& where) {
  if (id.empty()) return {};
  const auto [at, is_new] = ids_.emplace(id, where);
  if (is_new) return {};
  return fail(ErrorCode::kBadGeometry, fmt::format("the id '{}' is taken", id),
              fmt::format("by {}:{}; ids are unique", at->second.file, at->second.line),
              below(where, "properties.id"));
}

Result<void> FarmBuilder::add(const Feature& feature) {
  using Adder = Result<void> (FarmBuilder::*)(const Feature&, Properties&);
  static const std::map<std::string, Adder> kAdders{{"row_parcel", &FarmBuilder::add_row_parcel},
                                                    {"row", &FarmBuilder::add_row},
                                                    {"free_parcel", &FarmBuilder::add_free_parcel},
                                                    {"road", &FarmBuilder::add_road},
                                                    {"keep_out", &FarmBuilder::add_keep_out},
                                                    {"gate", &FarmBuilder::add_gate},
                                                    {"poi", &FarmBuilder::add_poi},
                                                    {"charger", &FarmBuilder::add_charger},
                                                    {"terrain", &FarmBuilder::add_terrain},
                                                    {"soil", &FarmBuilder::add_soil}};
  const Location where = below(feature.where, "properties");
  Properties properties(feature.properties, where);
  const nlohmann::json kind = properties.raw("kind");
  if (kind.is_null()) {
    return fail(ErrorCode::kMissingKey, "required key is missing",
                fmt::format("allowed: {}", fmt::join(kKinds, ", ")), below(where, "kind"));
  }
  const auto adder = kind.is_string() ? kAdders.find(kind.get<std::string>()) : kAdders.end();
  if (adder == kAdders.end()) {
    return fail(ErrorCode::kUnknownName, internal::describe(kind) + " is not a known kind",
                kind.is_string() ? config::suggestion(kind.get<std::string>(), kKinds)
                                 : fmt::format("allowed: {}", fmt::join(kKinds, ", ")),
                below(where, "kind"));
  }
  return (this->*adder->second)(feature, properties);
}

Result<void> FarmBuilder::add_row_parcel(const Feature& feature, Properties& properties) {
  RowParcel parcel;
  ParcelSource source{
      feature.where, properties.has("row_spacing_m"), properties.has("row_heading_deg"), {}};
  parcel.id = properties.text("id", Need::kRequired);
  parcel.name = properties.text("name", Need::kOptional);
  parcel.row_spacing_m = properties.number("row_spacing_m", kPositive, Need::kOptional, 0.0);
  parcel.row_heading_rad =
      deg_to_rad(properties.number("row_heading_deg", kHeadingDeg, Need::kOptional, 0.0));
  parcel.headland_width_m = properties.number("headland_width_m", kHeadlandM, Need::kOptional, 0.0);
  parcel.headland_outside_m = properties.number("headland_outside_m", kHeadlandM, Need::kOptional,
                                                defaults_.headland_outside_m);
  if (auto ok = properties.finish(); !ok) return ok;
  if (auto ok = take_id(parcel.id, feature.where); !ok) return ok;
  auto boundary = internal::polygon_of(feature, farm_.frame);
  if (!boundary) return tl::unexpected<Error>(boundary.error());
  parcel.boundary = std::move(*boundary);
  farm_.row_parcels.push_back(std::move(parcel));
  sources_.push_back(std::move(source));
  return {};
}

Result<void> FarmBuilder::add_row(const Feature& feature, Properties& properties) {
  PendingRow pending;
  pending.where = feature.where;
  pending.row.id = properties.text("id", Need::kOptional);
  pending.parcel = properties.text("parcel", Need::kRequired);
  if (auto ok = properties.finish(); !ok) return ok;
  auto line = internal::line_of(feature, farm_.frame);
  if (!line) return tl::unexpected<Error>(line.error());
  pending.row.line = std::move(*line);
  pending_rows_.push_back(std::move(pending));
  return {};
}

Result<void> FarmBuilder::add_free_parcel(const Feature& feature, Properties& properties) {
  const std::string id = properties.text("id", Need::kRequired);
  if (auto ok = properties.finish(); !ok) return ok;
  if (auto ok = take_id(id, feature.where); !ok) return ok;
  auto boundary = internal::polygon_of(feature, farm_.frame);
  if (!boundary) return tl::unexpected<Error>(boundary.error());
  farm_.free_parcels.push_back({id, std::move(*boundary)});
  return {};
}

Result<void> FarmBuilder::add_road(const Feature& feature, Properties& properties) {
  Road road;
  road.id = properties.text("id", Need::kOptional);
  road.width_m = properties.number("width_m", kWidthM, Need::kOptional, road.width_m);
  if (auto ok = properties.finish(); !ok) return ok;
  if (auto ok = take_id(road.id, feature.where); !ok) return ok;
  auto line = internal::line_of(feature, farm_.frame);
  if (!line) return tl::unexpected<Error>(line.error());
  road.line = std::move(*line);
  farm_.roads.push_back(std::move(road));
  return {};
}

Result<void> FarmBuilder::add_keep_out(const Feature& feature, Properties& properties) {
  const std::string id = properties.text("id", Need::kOptional);
  if (auto ok = properties.finish(); !ok) return ok;
  if (auto ok = take_id(id, feature.where); !ok) return ok;
  auto boundary = internal::polygon_of(feature, farm_.frame);
  if (!boundary) return tl::unexpected<Error>(boundary.error());
  farm_.keep_outs.push_back({id, std::move(*boundary)});
  return {};
}

Result<void> FarmBuilder::add_gate(const Feature& feature, Properties& properties) {
  Gate gate;
  gate.id = properties.text("id", Need::kOptional);
  gate.width_m = properties.number("width_m", kWidthM, Need::kOptional, gate.width_m);
  if (auto ok = properties.finish(); !ok) return ok;
  if (auto ok = take_id(gate.id, feature.where); !ok) return ok;
  const auto position = internal::point_of(feature, farm_.frame);
  if (!position) return tl::unexpected<Error>(position.error());
  gate.position = *position;
  farm_.gates.push_back(std::move(gate));
  return {};
}

Result<void> FarmBuilder::add_poi(const Feature& feature, Properties& properties) {
  Poi poi;
  poi.id = properties.text("id", Need::kRequired);
  poi.role = properties.text("role", Need::kRequired);
  poi.pose.yaw = deg_to_rad(properties.number("heading_deg", kHeadingDeg, Need::kOptional, 0.0));
  if (auto ok = properties.finish(); !ok) return ok;
  if (auto ok = take_id(poi.id, feature.where); !ok) return ok;
  const auto position = internal::point_of(feature, farm_.frame);
  if (!position) return tl::unexpected<Error>(position.error());
  poi.pose.x = position->x();
  poi.pose.y = position->y();
  farm_.pois.push_back(std::move(poi));
  return {};
}

Result<void> FarmBuilder::add_charger(const Feature& feature, Properties& properties) {
  Charger charger;
  charger.id = properties.text("id", Need::kRequired);
  charger.curve = properties.charge_curve("power_w", charger.curve);
  charger.slots = properties.whole("slots", Range{1.0, 1000.0}, Need::kOptional, charger.slots);
  charger.pose.yaw =
      deg_to_rad(properties.number("heading_deg", kHeadingDeg, Need::kOptional, 0.0));
  if (auto ok = properties.finish(); !ok) return ok;
  if (auto ok = take_id(charger.id, feature.where); !ok) return ok;
  const auto position = internal::point_of(feature, farm_.frame);
  if (!position) return tl::unexpected<Error>(position.error());
  charger.pose.x = position->x();
  charger.pose.y = position->y();
  farm_.chargers.push_back(std::move(charger));
  return {};
}

// Either a file or generated hills.
Result<void> FarmBuilder::add_terrain(const Feature& feature, Properties& properties) {
  const bool generated = properties.has("hills_seed");
  const std::string path = properties.text("path", generated ? Need::kOptional : Need::kRequired);
  HillSpec hills;
  hills.seed =
      static_cast<std::uint64_t>(properties.whole("hills_seed", {0.0, 2e9}, Need::kOptional, 1));
  if (generated) {  // else these are unknown keys
    hills.relief_m =
        properties.number("hills_relief_m", {0.0, 3000.0}, Need::kOptional, hills.relief_m);
    hills.wavelength_m =
        properties.number("hills_wavelength_m", {1.0, 1e5}, Need::kOptional, hills.wavelength_m);
    hills.cell_m = properties.number("cell_m", {0.1, 1000.0}, Need::kOptional, hills.cell_m);
  }
  if (auto ok = properties.finish(); !ok) return ok;
  if (!generated) {
    const auto folder = std::filesystem::path(feature.where.file).parent_path();
    farm_.terrain_files.push_back((folder / path).lexically_normal().string());
    return {};
  }
  if (!path.empty() || farm_.hills) {
    return fail(ErrorCode::kBadGeometry, "a second terrain",
                "a terrain has a path or hills, and a farm has hills once",
                below(feature.where, "properties.hills_seed"));
  }
  farm_.hills = hills;
  return {};
}

Result<void> FarmBuilder::add_soil(const Feature& feature, Properties& properties) {
  const std::string id = properties.text("id", Need::kOptional);
  const auto soil = properties.choice("class", SoilClass::kFirm);
  if (auto ok = properties.finish(); !ok) return ok;
  if (auto ok = take_id(id, feature.where); !ok) return ok;
  auto boundary = internal::polygon_of(feature, farm_.frame);
  if (!boundary) return tl::unexpected<Error>(boundary.error());
  farm_.soils.push_back({id, soil, std::move(*boundary)});
  return {};
}

template <class T>
void FarmBuilder::name_the_nameless(std::vector<T>& list, const std::string& kind) {
  int n = 0;
  for (T& item : list) {
    while (item.id.empty()) {
      const std::string id = fmt::format("{}-{}", kind, ++n);
      if (ids_.emplace(id, Location{}).second) item.id = id;
    }
  }
}

Result<void> FarmBuilder::assign_rows() {
  std::vector<std::string> parcel_ids;
  for (const RowParcel& parcel : farm_.row_parcels) parcel_ids.push_back(parcel.id);
  for (PendingRow& pending : pending_rows_) {
    const auto at = std::find(parcel_ids.begin(), parcel_ids.end(), pending.parcel);
    if (at == parcel_ids.end()) {
      return fail(ErrorCode::kUnknownName,
                  fmt::format("'{}' is not the id of a row_parcel", pending.parcel),
                  config::suggestion(pending.parcel, parcel_ids),
                  below(pending.where, "properties.parcel"));
    }
    const auto index = static_cast<std::size_t>(at - parcel_ids.begin());
    std::vector<Row>& rows = farm_.row_parcels[index].rows;
    const auto taken = [&rows](const std::string& id) {
      return std::any_of(rows.begin(), rows.end(), [&](const Row& r) { return r.id == id; });
    };
    if (!pending.row.id.empty() && taken(pending.row.id)) {
      return fail(ErrorCode::kBadGeometry,
                  fmt::format("parcel '{}' has a row '{}' already", pending.parcel, pending.row.id),
                  "the ids of a parcel's rows are unique", below(pending.where, "properties.id"));
    }
    for (std::size_t n = rows.size() + 1; pending.row.id.empty(); ++n) {
      if (const std::string id = fmt::format("r{}", n); !taken(id)) pending.row.id = id;
    }
    rows.push_back(std::move(pending.row));
    sources_[index].rows.push_back(pending.where);
  }
  return {};
}

// Spacing, heading and rows, each from the file or else from the others.
Result<void> FarmBuilder::complete(RowParcel& parcel, const ParcelSource& source) const {
  if (parcel.rows.empty()) {
    for (const auto& [key, given] : {std::pair{"row_spacing_m", source.has_spacing},
                                     std::pair{"row_heading_deg", source.has_heading}}) {
      if (given) continue;
      return fail(ErrorCode::kMissingKey, "required key is missing",
                  "a row_parcel without row features needs row_spacing_m and row_heading_deg",
                  below(source.where, std::string("properties.") + key));
    }
    auto rows = generate_rows(parcel);
    if (!rows) {
      Location where = below(source.where, "properties");
      if (!rows.error().where.key.empty()) where = below(where, rows.error().where.key);
      rows.error().where = where;
      return tl::unexpected<Error>(std::move(rows.error()));
    }
    parcel.rows = std::move(*rows);
    return {};
  }
  const internal::RowFit fit = internal::fit_rows(parcel);
  if (!source.has_spacing) parcel.row_spacing_m = fit.spacing_m;
  if (!source.has_heading) parcel.row_heading_rad = fit.heading_rad;
  const auto roomy = grow({parcel.boundary}, kRowTolerance);
  for (std::size_t i = 0; i < parcel.rows.size(); ++i) {
    const Row& row = parcel.rows[i];
    const auto outside = subtract(widen(row.line, kProbeWidth), roomy);
    if (outside.empty()) continue;
    const Point2 place = outside.front().outer.front();
    return fail(ErrorCode::kBadGeometry,
                fmt::format("row '{}' leaves its parcel '{}' at ({:.1f}, {:.1f}) m", row.id,
                            parcel.id, place.x(), place.y()),
                fmt::format("rows lie inside their parcel, up to {} m", kRowTolerance),
                below(source.rows[i], "geometry"));
  }
  return {};
}

Result<Farm> FarmBuilder::finish(const std::string& name) {
  farm_.name = name;
  if (auto ok = assign_rows(); !ok) return tl::unexpected<Error>(ok.error());
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (auto ok = complete(farm_.row_parcels[i], sources_[i]); !ok) {
      return tl::unexpected<Error>(ok.error());
    }
  }
  name_the_nameless(farm_.roads, "road");
  name_the_nameless(farm_.keep_outs, "keep_out");
  name_the_nameless(farm_.gates, "gate");
  name_the_nameless(farm_.soils, "soil");
  return std::move(farm_);
}

}  // namespace

Result<Farm> load_farm(const std::vector<std::filesystem::path>& files,
                       const FarmDefaults& defaults) {
  if (files.empty()) return fail(ErrorCode::kFileNotFound, "no farm file is given", "name one");
  std::vector<internal::Document> documents;
  for (const std::filesystem::path& file : files) {
    auto document = internal::read_document(file);
    if (!document) return tl::unexpected<Error>(document.error());
    if (!document->is_headland) {
      document->features = internal::from_agrids(std::move(document->features));
    }
    documents.push_back(std::move(*document));
  }
  const internal::Document& first = documents.front();
  std::optional<LatLon> origin = first.origin;
  if (!origin) origin = internal::center_of(first.features);
  FarmBuilder builder(LocalFrame(origin.value_or(LatLon{})), defaults);
  for (const internal::Document& document : documents) {
    for (const Feature& feature : document.features) {
      if (auto ok = builder.add(feature); !ok) return tl::unexpected<Error>(ok.error());
    }
  }
  return builder.finish(first.name.empty() ? first.file.stem().string() : first.name);
}

}  // namespace headland
