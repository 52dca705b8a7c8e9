// SPDX-License-Identifier: Apache-2.0
#include "core/world/ground.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "core/base/random.hpp"
#include "core/geometry/region.hpp"

namespace headland {
namespace {

constexpr double kMargin = 60.0;     // [m] of terrain kept around a farm
constexpr double kSoilStep = 1.0;    // [m] between two looks at the soil
constexpr double kMostPoints = 1e8;  // of generated hills
constexpr double kSlopeTolerance = 1e-9;

// An area of one soil, ready for many questions.
struct Area {
  SoilClass soil;
  MapBox box;
  Region region;
};

Area area_of(SoilClass soil, const std::vector<Polygon>& polygons) {
  MapBox box;
  for (const Polygon& polygon : polygons) {
    for (const Point2& p : polygon.outer) box.extend(p);
  }
  return {soil, box, Region(polygons)};
}

// Roads first: soil areas lie on top of them.
std::vector<Area> areas_of(const Farm& farm) {
  std::vector<Area> areas;
  std::vector<Polygon> roads;
  for (const Road& road : farm.roads) {
    const auto parts = widen(road.line, road.width_m);
    roads.insert(roads.end(), parts.begin(), parts.end());
  }
  if (!roads.empty()) areas.push_back(area_of(SoilClass::kTrack, roads));
  for (const SoilArea& soil : farm.soils) areas.push_back(area_of(soil.soil, {soil.boundary}));
  return areas;
}

// Continues a hash with a number.
template <class T>
std::uint64_t mixed(std::uint64_t hash, T number) {
  static_assert(sizeof(T) == sizeof(std::uint64_t));
  char bytes[2 * sizeof(std::uint64_t)];
  std::memcpy(bytes, &hash, sizeof(hash));
  std::memcpy(bytes + sizeof(hash), &number, sizeof(number));
  return fnv1a({bytes, sizeof(bytes)});
}

}  // namespace

struct Ground::Data {
  LocalFrame frame;
  std::vector<Terrain> terrains;
  std::vector<Area> areas;
};

Ground::Ground() : data_(std::make_shared<const Data>()) {}

Ground::Ground(const Farm& farm, std::optional<Terrain> terrain)
    : Ground(farm, terrain ? std::vector<Terrain>{*std::move(terrain)} : std::vector<Terrain>{}) {}

Ground::Ground(const Farm& farm, std::vector<Terrain> terrains)
    : data_(std::make_shared<const Data>(Data{farm.frame, std::move(terrains), areas_of(farm)})) {}

bool Ground::flat() const { return data_->terrains.empty(); }
bool Ground::uniform() const { return flat() && data_->areas.empty(); }

std::optional<TerrainSample> Ground::sample(const Point2& p_map) const {
  if (flat()) return TerrainSample{};
  for (const Terrain& terrain : data_->terrains) {
    if (auto found = terrain.sample(p_map)) return found;
  }
  return std::nullopt;
}

std::optional<double> Ground::height(const Point2& p_map) const {
  if (flat()) return 0.0;
  for (const Terrain& terrain : data_->terrains) {
    if (auto found = terrain.height(p_map)) return found;
  }
  return std::nullopt;
}

Result<TerrainSample> Ground::at(const Point2& p_map) const {
  if (const auto found = sample(p_map)) return *found;
  const LatLon place = data_->frame.to_wgs84(p_map);
  return fail(ErrorCode::kOffTerrain,
              fmt::format("the terrain has no height at ({:.1f}, {:.1f}) m, [{:.6f}, {:.6f}]",
                          p_map.x(), p_map.y(), place.lon_deg, place.lat_deg),
              "terrain must cover all that is driven on");
}

SoilClass Ground::soil(const Point2& p_map) const {
  for (auto area = data_->areas.rbegin(); area != data_->areas.rend(); ++area) {
    if (area->box.contains(p_map) && area->region.contains(p_map)) return area->soil;
  }
  return SoilClass::kFirm;
}

const Terrain* Ground::terrain() const { return flat() ? nullptr : &data_->terrains.front(); }

double Ground::step() const {
  double step = data_->areas.empty() ? std::numeric_limits<double>::infinity() : kSoilStep;
  for (const Terrain& terrain : data_->terrains) step = std::min(step, 0.5 * terrain.cell());
  return step;
}

std::uint64_t Ground::fingerprint() const {
  std::uint64_t hash = fnv1a("ground");
  for (const Terrain& terrain : data_->terrains) hash = mixed(hash, terrain.fingerprint());
  const auto add = [&hash](const Polyline& ring) {
    hash = mixed(hash, static_cast<std::uint64_t>(ring.size()));
    for (const Point2& p : ring) hash = mixed(mixed(hash, p.x()), p.y());
  };
  for (const Area& area : data_->areas) {
    hash = mixed(hash, static_cast<std::uint64_t>(area.soil));
    for (const Polygon& polygon : area.region.polygons()) {
      add(polygon.outer);
      for (const Polyline& hole : polygon.holes) add(hole);
    }
  }
  return hash;
}

Result<Ground> load_ground(const Farm& farm) {
  MapBox box = extent(farm);
  if (box.isEmpty()) box.extend(Point2(0.0, 0.0));
  const Point2 margin(kMargin, kMargin);
  box = MapBox(box.min() - margin, box.max() + margin);

  std::vector<Terrain> terrains;
  std::optional<Error> elsewhere;
  for (const std::string& file : farm.terrain_files) {
    auto terrain = load_terrain(file, farm.frame, box);
    if (terrain) {
      terrains.push_back(*std::move(terrain));
    } else if (terrain.error().code == ErrorCode::kOffTerrain) {
      elsewhere = terrain.error();
    } else {
      return tl::unexpected<Error>(terrain.error());
    }
  }
  if (terrains.empty() && elsewhere) return tl::unexpected<Error>(*elsewhere);
  if (farm.terrain_files.empty() && farm.hills) {
    const double points = box.volume() / (farm.hills->cell_m * farm.hills->cell_m);
    if (points > kMostPoints) {
      return fail(ErrorCode::kOutOfRange,
                  fmt::format("hills of {:.0f} million points", points / 1e6),
                  "a larger cell_m of the hills' terrain");
    }
    terrains.push_back(Terrain::hills(*farm.hills, box.min(), box.max()));
  }
  return Ground(farm, std::move(terrains));
}

Attitude attitude(const TerrainSample& ground, double yaw) {
  const Pose2 pose{0.0, 0.0, yaw};
  return {std::atan(ground.gradient.dot(pose.heading())),
          std::atan(ground.gradient.dot(pose.left()))};
}

namespace {

// Of the steering over a stretch of a piece, where it may go from one side to the other [1/m].
double mean_abs_curvature(const PathPiece& piece, double from, double to) {
  const double a = piece.curvature_at(from);
  const double b = piece.curvature_at(to);
  if (a * b >= 0.0) return 0.5 * std::abs(a + b);
  return 0.5 * (a * a + b * b) / std::abs(a - b);
}

// Walks a path in equal steps a piece, none longer than the ground's. Calls
// `visit(piece, curvature, distance, pose)` with each step's mean curvature and the pose at its
// end; stops where it says false.
template <class Visit>
void walk(const Ground& ground, const Path& path, Visit visit) {
  const double longest = ground.step();
  for (const PathPiece& piece : path.pieces()) {
    const int count = std::max(1, static_cast<int>(std::ceil(piece.length / longest)));
    const double distance = piece.length / count;
    // The chords of equal steps of an arc turn by the same angle each.
    const double way = sign(piece.gear);
    const Pose2 turn{0.0, 0.0, piece.curvature * way * distance};
    const Point2 ahead = turn.heading();
    const Pose2 first = advance(piece.start, piece.curvature, way * distance);
    Point2 chord = first.position() - piece.start.position();
    Pose2 pose = piece.start;
    for (int k = 1; k <= count; ++k) {
      const double before = (k - 1) * distance;
      if (piece.sharpness == 0.0) {
        pose = {pose.x + chord.x(), pose.y + chord.y(), piece.start.yaw + k * turn.yaw};
        chord = {ahead.x() * chord.x() - ahead.y() * chord.y(),
                 ahead.y() * chord.x() + ahead.x() * chord.y()};
      } else {
        pose = advance(pose, piece.curvature_at(before), way * piece.sharpness, way * distance);
      }
      const double curvature = mean_abs_curvature(piece, before, before + distance);
      if (!visit(piece, curvature, distance, pose)) return;
    }
  }
}

}  // namespace

Result<DriveCost> path_cost(const Vehicle& vehicle, const Ground& ground, const Path& path,
                            LegKind kind) {
  DriveCost total;
  if (path.empty()) return total;
  const double speed = leg_speed(vehicle, kind);
  const bool uniform = ground.uniform();
  DriveStep step;
  step.speed_mps = speed;
  step.speed_before_mps = speed;
  step.working = kind == LegKind::kRow;
  const double standing_j = vehicle.energy.base_power_w * vehicle.gear_change_s;

  Point2 before = path.start_pose().position();
  Gear gear = path.pieces().front().gear;
  std::optional<double> from = ground.height(before);
  if (!from) return tl::unexpected<Error>(ground.at(before).error());
  walk(ground, path,
       [&](const PathPiece& piece, double curvature, double distance, const Pose2& pose) {
         if (piece.gear != gear) total += {0.0, vehicle.gear_change_s, standing_j, standing_j};
         gear = piece.gear;
         const Point2 here = pose.position();
         const std::optional<double> to = ground.height(here);
         if (to) {
           step.distance_m = distance;
           step.rise_m = *to - *from;
           step.duration_s = distance / speed;
           step.curvature_1pm = curvature;
           if (!uniform) step.soil = soil_resistance(ground.soil(0.5 * (before + here)));
           const double drawn = step_energy(vehicle.energy, step);
           total += {distance, step.duration_s, drawn, std::max(0.0, drawn)};
         }
         before = here;
         from = to;
         return to.has_value();
       });
  if (!from) return tl::unexpected<Error>(ground.at(before).error());
  return total;
}

std::optional<Error> check_slopes(const Vehicle& vehicle, const Ground& ground, const Path& path) {
  if (ground.flat() || path.empty()) return std::nullopt;
  std::optional<Error> error;
  const auto check = [&](const Pose2& pose) {
    const auto here = ground.at(pose.position());
    if (!here) {
      error = here.error();
      return false;
    }
    const Attitude tilt = attitude(*here, pose.yaw);
    const double pitch = rad_to_deg(std::abs(tilt.pitch));
    const double roll = rad_to_deg(std::abs(tilt.roll));
    const bool is_pitch = pitch > vehicle.max_pitch_deg + kSlopeTolerance;
    if (!is_pitch && !(roll > vehicle.max_roll_deg + kSlopeTolerance)) return true;
    error =
        Error{ErrorCode::kTooSteep,
              fmt::format("{:.1f} deg {} the path at ({:.1f}, {:.1f}) m", is_pitch ? pitch : roll,
                          is_pitch ? "along" : "across", pose.x, pose.y),
              fmt::format("vehicle '{}' may drive {} deg", vehicle.name,
                          is_pitch ? vehicle.max_pitch_deg : vehicle.max_roll_deg),
              {}};
    return false;
  };
  if (check(path.start_pose())) {
    walk(ground, path,
         [&check](const PathPiece&, double, double, const Pose2& pose) { return check(pose); });
  }
  return error;
}

}  // namespace headland
