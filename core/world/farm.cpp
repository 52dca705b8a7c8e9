// SPDX-License-Identifier: Apache-2.0
#include "core/world/farm.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kStandingRadius = 4.0;  // [m] drivable around POIs and chargers
constexpr int kDiscCorners = 64;

template <class T>
const T* find(const std::vector<T>& list, std::string_view id) {
  const auto at = std::find_if(list.begin(), list.end(), [&](const T& t) { return t.id == id; });
  return at == list.end() ? nullptr : &*at;
}

Polygon disc(const Point2& center, double radius) {
  Polygon polygon;
  for (int i = 0; i < kDiscCorners; ++i) {
    const double angle = 2.0 * kPi * i / kDiscCorners;
    polygon.outer.push_back(center + radius * Point2(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

}  // namespace

const RowParcel* Farm::find_parcel(std::string_view id) const { return find(row_parcels, id); }
const Row& Farm::row(RowRef ref) const {
  return row_parcels[static_cast<std::size_t>(ref.parcel)].rows[static_cast<std::size_t>(ref.row)];
}

std::string Farm::row_name(RowRef ref) const {
  return row_parcels[static_cast<std::size_t>(ref.parcel)].id + "/" + row(ref).id;
}

std::vector<RowRef> Farm::all_rows() const {
  std::vector<RowRef> refs;
  for (int p = 0; p < static_cast<int>(row_parcels.size()); ++p) {
    const auto& rows = row_parcels[static_cast<std::size_t>(p)].rows;
    for (int r = 0; r < static_cast<int>(rows.size()); ++r) refs.push_back({p, r});
  }
  return refs;
}

const Poi* Farm::find_poi(std::string_view id) const { return find(pois, id); }
const Charger* Farm::find_charger(std::string_view id) const { return find(chargers, id); }

std::vector<Polygon> drivable_area(const Farm& farm) {
  std::vector<Polygon> drivable;
  const auto add = [&drivable](std::vector<Polygon> parts) {
    std::move(parts.begin(), parts.end(), std::back_inserter(drivable));
  };
  for (const RowParcel& p : farm.row_parcels) {
    add(p.headland_outside_m > 0.0 ? grow({p.boundary}, p.headland_outside_m)
                                   : std::vector<Polygon>{p.boundary});
  }
  for (const FreeParcel& p : farm.free_parcels) drivable.push_back(p.boundary);
  for (const Road& road : farm.roads) add(widen(road.line, road.width_m));
  for (const Gate& gate : farm.gates) drivable.push_back(disc(gate.position, 0.5 * gate.width_m));
  for (const Poi& poi : farm.pois) drivable.push_back(disc(poi.pose.position(), kStandingRadius));
  for (const Charger& charger : farm.chargers) {
    drivable.push_back(disc(charger.pose.position(), kStandingRadius));
  }
  std::vector<Polygon> forbidden;
  for (const KeepOut& keep_out : farm.keep_outs) forbidden.push_back(keep_out.boundary);
  return subtract(drivable, forbidden);
}

MapBox extent(const Farm& farm) {
  MapBox box;
  const auto add = [&box](const Polyline& points, double around) {
    for (const Point2& p : points) {
      box.extend(p - Point2(around, around));
      box.extend(p + Point2(around, around));
    }
  };
  for (const RowParcel& p : farm.row_parcels) {
    add(p.boundary.outer, p.headland_outside_m);
    for (const Row& row : p.rows) add(row.line, 0.0);
  }
  for (const FreeParcel& p : farm.free_parcels) add(p.boundary.outer, 0.0);
  for (const Road& road : farm.roads) add(road.line, 0.5 * road.width_m);
  for (const Gate& gate : farm.gates) add({gate.position}, 0.5 * gate.width_m);
  for (const Poi& poi : farm.pois) add({poi.pose.position()}, kStandingRadius);
  for (const Charger& charger : farm.chargers) add({charger.pose.position()}, kStandingRadius);
  return box;
}

}  // namespace headland
