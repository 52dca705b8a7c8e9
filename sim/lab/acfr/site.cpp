// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/acfr/site.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/base/random.hpp"
#include "global_planner/roadmap/roadmap.hpp"
#include "sim/lab/goal_tour.hpp"

namespace headland {
namespace {

constexpr double kBorder = 15.0;  // of the pasture, without waypoints [m]
constexpr double kApart = 0.25;   // of the spacing: no two waypoints are nearer
constexpr int kTries = 1000;
constexpr const char* kWhere = "study/acfr/waypoints";

// Places in the order of the shortest round tour, the first (the station) in front.
using Places = std::vector<Point2>;

double tour_length(const Places& places) {
  double length = (places.front() - places.back()).norm();
  for (std::size_t i = 1; i < places.size(); ++i) length += (places[i] - places[i - 1]).norm();
  return length;
}

struct Box {
  Point2 low;
  Point2 high;
};
Box around(const Places& places) {
  Box box{places.front(), places.front()};
  for (const Point2& p : places) {
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  return box;
}

bool too_near(const Places& places, double apart) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if ((places[i] - places[j]).norm() < apart) return true;
    }
  }
  return false;
}

}  // namespace

struct AcfrSite::Impl {
  AcfrSiteConfig config;
  Vehicle vehicle;
  Ground ground;
  Region area;
  std::optional<Roadmap> roadmap;

  Result<Places> draw(RandomStream& random) const;
  std::vector<Site> poses(const Places& places) const;
};

std::optional<Error> AcfrSiteConfig::check() const {
  if (waypoints_min_count <= waypoints_max_count) return std::nullopt;
  return Error{ErrorCode::kOutOfRange,
               "more than waypoints_max_count",
               "at most waypoints_max_count",
               {{}, 0, "waypoints_min_count"}};
}

// Random places, spread until the mean distance along their tour is the wanted spacing.
Result<Places> AcfrSite::Impl::draw(RandomStream& random) const {
  const int spread = config.waypoints_max_count - config.waypoints_min_count + 1;
  const int count = config.waypoints_min_count + random.index(spread) + 1;
  const double room = config.side_m - 2.0 * kBorder;
  for (int tries = 0; tries < kTries; ++tries) {
    Places places(static_cast<std::size_t>(count));
    for (Point2& p : places) p = {random.uniform(), random.uniform()};
    const auto order = round_tour(count, [&](int from, int to) {
      return (places[static_cast<std::size_t>(from)] - places[static_cast<std::size_t>(to)]).norm();
    });
    if (!order) return tl::unexpected<Error>(order.error());
    Places sorted{places.front()};
    for (const int i : *order) sorted.push_back(places[static_cast<std::size_t>(i)]);
    const double scale = config.spacing_m * count / tour_length(sorted);
    for (Point2& p : sorted) p *= scale;
    const Box box = around(sorted);
    const Point2 play = Point2(room, room) - (box.high - box.low);
    if (play.minCoeff() < 0.0 || too_near(sorted, kApart * config.spacing_m)) continue;
    const Point2 corner(kBorder + random.uniform() * play.x(),
                        kBorder + random.uniform() * play.y());
    const Point2 shift = corner - box.low;
    for (Point2& p : sorted) p += shift;
    return sorted;
  }
  return fail(ErrorCode::kOutOfRange, "the pasture is too small for the tours",
              "a larger side_m, or a smaller spacing_m", {{}, 0, "side_m"});
}

// Each place is passed in the direction from the one before it to the one after it.
std::vector<Site> AcfrSite::Impl::poses(const Places& places) const {
  std::vector<Site> sites;
  const std::size_t n = places.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 along = places[(i + 1) % n] - places[(i + n - 1) % n];
    const Pose2 pose{places[i].x(), places[i].y(), std::atan2(along.y(), along.x())};
    sites.push_back({pose, pose, i == 0 ? "the station" : fmt::format("waypoint {}", i)});
  }
  return sites;
}

AcfrSite::AcfrSite(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
AcfrSite::~AcfrSite() = default;
AcfrSite::AcfrSite(AcfrSite&&) noexcept = default;
AcfrSite& AcfrSite::operator=(AcfrSite&&) noexcept = default;

const Ground& AcfrSite::ground() const { return impl_->ground; }

Result<AcfrSite> AcfrSite::build(const AcfrSiteConfig& config, const Vehicle& vehicle,
                                 std::uint64_t seed) {
  auto impl = std::make_unique<Impl>();
  impl->config = config;
  impl->vehicle = vehicle;
  HillSpec hills;
  hills.seed = seed;
  hills.relief_m = config.relief_m;
  hills.wavelength_m = config.wavelength_m;
  hills.cell_m = config.cell_m;
  const double side = config.side_m;
  const Point2 rim(kBorder, kBorder);
  impl->ground = Ground(Farm{}, Terrain::hills(hills, -rim, Point2(side, side) + rim));
  impl->area = Region({{{{0.0, 0.0}, {side, 0.0}, {side, side}, {0.0, side}}, {}}});
  RoadmapOptions options;
  options.samples = config.samples_count;
  options.seed = seed;
  auto roadmap = Roadmap::build(impl->area, impl->ground, vehicle, options);
  if (!roadmap) return tl::unexpected<Error>(roadmap.error());
  impl->roadmap.emplace(std::move(*roadmap));
  return AcfrSite(std::move(impl));
}

Result<AcfrTour> AcfrSite::tour(std::uint64_t seed) const {
  RandomStream random(seed, kWhere);
  const auto places = impl_->draw(random);
  if (!places) return tl::unexpected<Error>(places.error());
  const auto graph = impl_->roadmap->connect(impl_->poses(*places), Objective::kEnergy);
  if (!graph) return tl::unexpected<Error>(graph.error());
  const auto order = round_tour(graph->goals(), [&](int from, int to) {
    return graph->edge(from, to).cost.value(Objective::kEnergy);
  });
  if (!order) return tl::unexpected<Error>(order.error());
  AcfrTour tour;
  tour.low = around(*places).low;
  tour.high = around(*places).high;
  std::vector<int> stops = *order;
  stops.push_back(0);
  int at = 0;
  for (const int stop : stops) {
    const GoalGraph::Edge& edge = graph->edge(at, stop);
    const Point2 place = (*places)[static_cast<std::size_t>(stop)];
    tour.path.append(edge.path);
    tour.places.push_back(place);
    tour.place_s.push_back(tour.path.length());
    tour.energy_j += edge.cost.energy_j;
    at = stop;
  }
  const Battery& battery = impl_->vehicle.battery;
  if (tour.energy_j > battery.capacity_j() - battery.reserve_j()) {
    return fail(ErrorCode::kEnergyInfeasible,
                fmt::format("a tour takes {:.0f} Wh, more than the battery holds above its reserve",
                            tour.energy_j / 3600.0),
                "a larger battery, or a smaller spacing_m", {{}, 0, "capacity_wh"});
  }
  return tour;
}

}  // namespace headland
