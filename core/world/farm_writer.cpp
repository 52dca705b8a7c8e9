// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "core/world/farm_io.hpp"

namespace headland {
namespace {

using Json = nlohmann::ordered_json;  // keys in the order of writing

// 1e-9 degrees are 0.1 mm on the ground: rounding makes files short, and the same on rewriting.
double rounded(double degrees) { return std::round(degrees * 1e9) / 1e9; }

class Writer {
 public:
  explicit Writer(const LocalFrame& frame) : frame_(frame) {}

  Json position(const Point2& p_map) const {
    const LatLon p = frame_.to_wgs84(p_map);
    return {rounded(p.lon_deg), rounded(p.lat_deg)};
  }
  Json point(const Point2& p_map) const {
    return {{"type", "Point"}, {"coordinates", position(p_map)}};
  }
  Json line(const Polyline& points) const {
    return {{"type", "LineString"}, {"coordinates", positions(points)}};
  }
  Json polygon(const Polygon& p) const {
    Json rings = Json::array({ring(p.outer)});
    for (const Polyline& hole : p.holes) rings.push_back(ring(hole));
    return {{"type", "Polygon"}, {"coordinates", std::move(rings)}};
  }
  // One feature a line, so that the line in an error message names the feature.
  void feature(Json properties, Json geometry) {
    const Json object = {{"type", "Feature"},
                         {"properties", std::move(properties)},
                         {"geometry", std::move(geometry)}};
    text_ += text_.empty() ? "\n" : ",\n";
    text_ += object.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  const std::string& text() const { return text_; }

 private:
  Json positions(const Polyline& points) const {
    Json list = Json::array();
    for (const Point2& p : points) list.push_back(position(p));
    return list;
  }
  Json ring(const Polyline& points) const {
    Json list = positions(points);
    if (!points.empty()) list.push_back(position(points.front()));
    return list;
  }

  const LocalFrame& frame_;
  std::string text_;
};

double heading_deg(double yaw) { return rounded(rad_to_deg(wrap_angle(yaw))); }

void write_row_parcel(const RowParcel& p, Writer& out) {
  Json properties{{"kind", "row_parcel"}, {"id", p.id}};
  if (!p.name.empty()) properties["name"] = p.name;
  properties["row_spacing_m"] = p.row_spacing_m;
  properties["row_heading_deg"] = heading_deg(p.row_heading_rad);
  properties["headland_width_m"] = p.headland_width_m;
  properties["headland_outside_m"] = p.headland_outside_m;
  out.feature(std::move(properties), out.polygon(p.boundary));
  for (const Row& row : p.rows) {
    out.feature({{"kind", "row"}, {"id", row.id}, {"parcel", p.id}}, out.line(row.line));
  }
}

// A number for constant power, or else a list.
Json power(const ChargeCurve& curve) {
  const auto& points = curve.points();
  const bool constant = std::all_of(points.begin(), points.end(), [&](const ChargePoint& p) {
    return p.power_w == points.front().power_w;
  });
  if (constant) return points.front().power_w;
  Json list = Json::array();
  for (const ChargePoint& p : points) list.push_back({p.soc, p.power_w});
  return list;
}

void write_ground(const Farm& farm, Writer& out) {
  for (const std::string& path : farm.terrain_files) {
    out.feature({{"kind", "terrain"}, {"path", path}}, nullptr);
  }
  if (farm.hills) {
    const HillSpec& h = *farm.hills;
    out.feature({{"kind", "terrain"},
                 {"hills_seed", h.seed},
                 {"hills_relief_m", h.relief_m},
                 {"hills_wavelength_m", h.wavelength_m},
                 {"cell_m", h.cell_m}},
                nullptr);
  }
  for (const SoilArea& s : farm.soils) {
    out.feature({{"kind", "soil"}, {"id", s.id}, {"class", config::enum_name(s.soil)}},
                out.polygon(s.boundary));
  }
}

void write_places(const Farm& farm, Writer& out) {
  for (const Gate& g : farm.gates) {
    out.feature({{"kind", "gate"}, {"id", g.id}, {"width_m", g.width_m}}, out.point(g.position));
  }
  for (const Poi& p : farm.pois) {
    out.feature(
        {{"kind", "poi"}, {"id", p.id}, {"role", p.role}, {"heading_deg", heading_deg(p.pose.yaw)}},
        out.point(p.pose.position()));
  }
  for (const Charger& c : farm.chargers) {
    out.feature({{"kind", "charger"},
                 {"id", c.id},
                 {"power_w", power(c.curve)},
                 {"slots", c.slots},
                 {"heading_deg", heading_deg(c.pose.yaw)}},
                out.point(c.pose.position()));
  }
}

}  // namespace

std::string to_geojson(const Farm& farm) {
  Writer out(farm.frame);
  for (const RowParcel& p : farm.row_parcels) write_row_parcel(p, out);
  for (const FreeParcel& p : farm.free_parcels) {
    out.feature({{"kind", "free_parcel"}, {"id", p.id}}, out.polygon(p.boundary));
  }
  for (const Road& r : farm.roads) {
    out.feature({{"kind", "road"}, {"id", r.id}, {"width_m", r.width_m}}, out.line(r.line));
  }
  for (const KeepOut& k : farm.keep_outs) {
    out.feature({{"kind", "keep_out"}, {"id", k.id}}, out.polygon(k.boundary));
  }
  write_places(farm, out);
  write_ground(farm, out);
  const LatLon origin = farm.frame.origin();
  const Json header{
      {"version", 1}, {"name", farm.name}, {"origin", {origin.lon_deg, origin.lat_deg}}};
  return "{\"type\": \"FeatureCollection\",\n\"headland\": " +
         header.dump(-1, ' ', false, Json::error_handler_t::replace) + ",\n\"features\": [" +
         out.text() + "\n]}\n";
}

}  // namespace headland
