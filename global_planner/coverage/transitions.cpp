// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/transitions.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "global_planner/coverage/internal/lane_graph.hpp"
#include "global_planner/coverage/internal/lanes.hpp"
#include "global_planner/coverage/internal/parallel.hpp"
#include "global_planner/coverage/internal/row_bodies.hpp"

namespace headland {

using namespace coverage;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLaneSlack = 0.15;         // [m] by which lanes keep more than the margin
constexpr double kFarthestTurnR = 6.0;      // turns are sought up to this many radii
constexpr double kFarthestTurnRows = 12.0;  // or row spacings, but
constexpr double kFarthestTurnM = 40.0;     // [m] for the latter
constexpr int kPassagesPerParcel = 6;

const char* compass(double yaw) {
  constexpr std::array names{"east", "north-east", "north", "north-west",
                             "west", "south-west", "south", "south-east"};
  const int k = static_cast<int>(std::lround(yaw / (kPi / 4.0)));
  return names[static_cast<std::size_t>(((k % 8) + 8) % 8)];
}

enum class WayType : std::int8_t { kNone, kTurn, kLanes, kThroughRow, kGiven };

// How one site is reached from another.
struct Way {
  DriveCost cost;
  int index = -1;  // kTurn: of the turn; kThroughRow: the end of the row by which it is entered;
                   // kGiven: of the path
  WayType type = WayType::kNone;
  double smoothing = 0.0;  // kTurn: what of the cost its clothoids ask for
};

}  // namespace

struct Transitions::Impl {
  Impl(const Farm& farm, const Ground& ground, const std::vector<RowRef>& rows_in,
       const std::vector<Site>& stops, const Vehicle& vehicle_in,
       const TransitionOptions& options_in, const RowBodies& bodies);

  // Each site has a port where it is left and one where it is entered.
  int ports() const { return static_cast<int>(ports_.size()); }
  static int out_port(int site) { return 2 * site; }
  static int in_port(int site) { return 2 * site + 1; }
  const Port& port(int p) const { return ports_[static_cast<std::size_t>(p)]; }
  Way& way(int from, int to) {
    return ways[static_cast<std::size_t>(from) * sites.size() + static_cast<std::size_t>(to)];
  }
  const Way& way(int from, int to) const {
    return ways[static_cast<std::size_t>(from) * sites.size() + static_cast<std::size_t>(to)];
  }

  void add_ports();
  void find_turns();
  std::vector<int> turn_partners(int from) const;
  void join_lanes(const Farm& farm, const std::vector<Polygon>& drivable, const RowBodies& bodies);
  void add_passages(const RowBodies& bodies);
  void find_lane_ways();
  void offer_lane_way(int from, int to, const WayCost& found);
  void find_ways_through_rows();
  std::optional<Error> shut_in_row() const;
  LegKind kind(const Way& w, int from, int to) const;
  double value(const DriveCost& cost) const { return cost.value(options.objective); }
  Path lane_path(int from, int to) const;
  Path path(int from, int to) const;

  std::vector<Row> rows;
  std::vector<Site> sites;
  Vehicle vehicle;
  TransitionOptions options;
  int ends = 0;  // of rows
  double radius;
  double spacing;
  WayPricer pricer;
  FreeSpace space;
  std::vector<Port> ports_;
  std::vector<Turn> turns;
  std::unique_ptr<LaneGraph> lanes;
  std::vector<std::vector<Connection>> connections;  // of ports
  std::vector<Path> row_paths;                       // from first to last end
  std::vector<Way> ways;
  std::vector<Path> given;
  std::atomic<bool> steep_turns = false;  // some were left out
};

Transitions::Impl::Impl(const Farm& farm, const Ground& ground, const std::vector<RowRef>& row_refs,
                        const std::vector<Site>& stops, const Vehicle& vehicle_in,
                        const TransitionOptions& options_in, const RowBodies& bodies)
    : vehicle(vehicle_in),
      options(options_in),
      ends(2 * static_cast<int>(row_refs.size())),
      radius(vehicle_in.turning_radius()),
      spacing(bodies.widest),
      pricer(vehicle_in, ground, options_in.objective),
      space(drivable_area(farm), bodies.bodies, vehicle_in.footprint, options_in.margin_m,
            bodies.margin) {
  for (const RowRef ref : row_refs) {
    const Row& row = farm.row(ref);
    const std::string name = farm.row_name(ref);
    rows.push_back(row);
    row_paths.push_back(row_path(row, 0, radius));
    const Path back = row_path(row, 1, radius);
    const Pose2 first_out = back.end_pose();
    const Pose2 last_out = row_paths.back().end_pose();
    sites.push_back({first_out, row_paths.back().start_pose(),
                     fmt::format("row {}, {} end", name, compass(first_out.yaw))});
    sites.push_back(
        {last_out, back.start_pose(), fmt::format("row {}, {} end", name, compass(last_out.yaw))});
  }
  sites.insert(sites.end(), stops.begin(), stops.end());
  ways.resize(sites.size() * sites.size());
  add_ports();
  find_turns();
  join_lanes(farm, space.drivable(), bodies);
  find_lane_ways();
  find_ways_through_rows();
}

void Transitions::Impl::add_ports() {
  const auto add = [this](const Pose2& out, int row, Travel travel) {
    const double run =
        space.free_run(out, options.max_lead_m, TurnSearch::kLeadStep, travel, {row, -1});
    ports_.push_back({{out, row, run}, travel});
  };
  for (int s = 0; s < static_cast<int>(sites.size()); ++s) {
    const Site& site = sites[static_cast<std::size_t>(s)];
    add(site.depart, s < ends ? s / 2 : space.row_at(site.depart.position()), Travel::kForth);
    add(reversed(site.arrive), s < ends ? s / 2 : space.row_at(site.arrive.position()),
        Travel::kBack);
  }
}

// Sites that a single manoeuvre may lead to: near, and neither far behind the other.
std::vector<int> Transitions::Impl::turn_partners(int from) const {
  std::vector<int> partners;
  const double farthest =
      std::max(kFarthestTurnR * radius, std::min(kFarthestTurnRows * spacing, kFarthestTurnM));
  const TurnEnd& a = port(out_port(from)).end;
  for (int to = 0; to < static_cast<int>(sites.size()); ++to) {
    if (to == from || (to < ends && to / 2 == from / 2)) continue;
    const TurnEnd& b = port(in_port(to)).end;
    const Point2 d = b.out.position() - a.out.position();
    if (d.squaredNorm() > farthest * farthest || b.free_run < 0.0) continue;
    if (d.dot(a.out.heading()) < -farthest / 2.0 || -d.dot(b.out.heading()) < -farthest / 2.0) {
      continue;
    }
    partners.push_back(to);
  }
  return partners;
}

void Transitions::Impl::find_turns() {
  struct Found {
    int from;
    int to;
    Turn turn;
    DriveCost cost;
  };
  std::vector<std::vector<Found>> found(sites.size());
  const bool reverses = vehicle.can_reverse;
  const TurnKinds kinds{true, reverses && options.fishtail, reverses && options.reeds_shepp};
  const TurnSearch between_rows(space, vehicle, leg_speed(vehicle, LegKind::kTurn));
  const TurnSearch to_stops(space, vehicle, leg_speed(vehicle, LegKind::kTransit));
  // Alike in front and behind, a vehicle drives the mirror image of each turn between rows back.
  const bool alike = vehicle.footprint.front_m == vehicle.footprint.rear_m;
  parallel_for(static_cast<int>(sites.size()), [&](int from) {
    const TurnEnd& a = port(out_port(from)).end;
    if (a.free_run < 0.0) return;
    for (const int to : turn_partners(from)) {
      const bool rows_both = from < ends && to < ends;
      if (alike && rows_both && to < from) continue;
      const LegKind kind = rows_both ? LegKind::kTurn : LegKind::kTransit;
      const TurnSearch& search = rows_both ? between_rows : to_stops;
      const auto turn = search.find(a, port(in_port(to)).end, kinds, pricer.flat_rate(kind));
      if (!turn) continue;
      const auto add = [&](int begin, int end, const Turn& way) {
        const Pose2& out = sites[static_cast<std::size_t>(begin)].depart;
        const std::optional<DriveCost> cost =
            pricer.price(turn_path(out, way), kind, way.cusps(), way.lost_s);
        if (!cost) steep_turns = true;
        if (cost) found[static_cast<std::size_t>(from)].push_back({begin, end, way, *cost});
      };
      add(from, to, *turn);
      if (alike && rows_both) add(to, from, mirrored(*turn));
    }
  });
  for (const std::vector<Found>& of_site : found) {
    for (const Found& f : of_site) {
      const LegKind kind = f.from < ends && f.to < ends ? LegKind::kTurn : LegKind::kTransit;
      way(f.from, f.to) = {f.cost, static_cast<int>(turns.size()), WayType::kTurn,
                           pricer.flat_rate(kind).of(f.turn.smoothing_m, 0, f.turn.lost_s)};
      turns.push_back(f.turn);
    }
  }
}

void Transitions::Impl::join_lanes(const Farm& farm, const std::vector<Polygon>& drivable,
                                   const RowBodies& bodies) {
  const double clearance = 0.5 * vehicle.footprint.width_m + options.margin_m + kLaneSlack;
  lanes = std::make_unique<LaneGraph>(
      space, lane_poses(farm, drivable, bodies.bodies, space, clearance, radius), radius,
      vehicle.can_reverse, pricer);
  connections.resize(ports_.size());
  parallel_for(ports(), [this](int p) {
    if (port(p).end.free_run < 0.0) return;
    auto& found = connections[static_cast<std::size_t>(p)];
    found = lanes->connect(port(p), false);
    // Too little room to turn forwards onto a lane.
    if (found.size() < 2 && vehicle.can_reverse && options.reeds_shepp) {
      const auto reversing = lanes->connect(port(p), true);
      found.insert(found.end(), reversing.begin(), reversing.end());
    }
  });
  add_passages(bodies);
}

// A few rows of each parcel, evenly spread among those that the lanes reach at both ends, serve
// as lanes across it.
void Transitions::Impl::add_passages(const RowBodies& bodies) {
  std::vector<Passage> passages;
  const auto connected = [this](int port) -> const std::vector<Connection>& {
    return connections[static_cast<std::size_t>(port)];
  };
  for (const std::vector<int>& block : bodies.parcels) {
    for (const int entry : {0, 1}) {
      std::vector<int> open;
      for (const int r : block) {
        if (!connected(in_port(2 * r + entry)).empty() &&
            !connected(out_port(2 * r + 1 - entry)).empty()) {
          open.push_back(r);
        }
      }
      const int count = static_cast<int>(open.size());
      const int wanted = std::min(count, kPassagesPerParcel);
      for (int k = 0; k < wanted; ++k) {
        const int r =
            open[static_cast<std::size_t>(wanted == 1 ? 0 : k * (count - 1) / (wanted - 1))];
        passages.push_back({row_path(rows[static_cast<std::size_t>(r)], entry, radius),
                            connected(in_port(2 * r + entry)),
                            connected(out_port(2 * r + 1 - entry))});
      }
    }
  }
  lanes->add_passages(std::move(passages));
}

void Transitions::Impl::find_lane_ways() {
  parallel_for(static_cast<int>(sites.size()), [this](int from) {
    const auto& begin = connections[static_cast<std::size_t>(out_port(from))];
    if (begin.empty()) return;
    LaneGraph::Search search(*lanes);
    search.run(begin);
    for (int to = 0; to < static_cast<int>(sites.size()); ++to) {
      const auto& end = connections[static_cast<std::size_t>(in_port(to))];
      if (to != from && !end.empty()) offer_lane_way(from, to, search.to(end));
    }
  });
}

void Transitions::Impl::offer_lane_way(int from, int to, const WayCost& found) {
  Way& w = way(from, to);
  if (found.cost == kInfinity) return;
  // On equal terms: a lane way must not win over a turn merely because lanes are driven faster, or
  // because their curves have no clothoids.
  const CostRate transit = pricer.flat_rate(LegKind::kTransit);
  const CostRate same = pricer.flat_rate(kind(w, from, to));
  const double length = found.drive.length_m;
  const double handicap = same.of(length, found.cusps) / transit.of(length, found.cusps);
  if (w.type != WayType::kNone && value(w.cost) - w.smoothing <= handicap * found.cost) {
    return;
  }
  w = {found.drive, -1, WayType::kLanes};
}

// Leave by a turn into another row, drive through it, and turn into the wanted one at its far end:
// how opposite ends are joined where no lane goes around.
void Transitions::Impl::find_ways_through_rows() {
  std::vector<std::optional<DriveCost>> through_row;  // entered by that end
  for (int e = 0; e < ends; ++e) {
    const Row& row = rows[static_cast<std::size_t>(e / 2)];
    through_row.push_back(pricer.price(row_path(row, e % 2, radius), LegKind::kTransit));
  }
  std::vector<std::vector<int>> turns_from(static_cast<std::size_t>(ends));
  for (int a = 0; a < ends; ++a) {
    for (int b = 0; b < ends; ++b) {
      if (way(a, b).type == WayType::kTurn) turns_from[static_cast<std::size_t>(a)].push_back(b);
    }
  }
  for (int a = 0; a < ends; ++a) {
    for (const int in : turns_from[static_cast<std::size_t>(a)]) {
      const Way to_row = way(a, in);
      const std::optional<DriveCost>& through = through_row[static_cast<std::size_t>(in)];
      if (!through) continue;
      for (const int b : turns_from[static_cast<std::size_t>(in ^ 1)]) {
        if (b / 2 == a / 2) continue;
        const DriveCost cost = to_row.cost + *through + way(in ^ 1, b).cost;
        Way& w = way(a, b);
        if (w.type == WayType::kTurn) continue;
        if (w.type != WayType::kNone && value(w.cost) <= value(cost)) continue;
        w = {cost, in, WayType::kThroughRow};
      }
    }
  }
}

std::optional<Error> Transitions::Impl::shut_in_row() const {
  const int count = static_cast<int>(sites.size());
  for (int e = 0; e < ends; ++e) {
    bool others = false;
    bool left = false;
    bool entered = false;
    for (int other = 0; other < count && !(left && entered); ++other) {
      if (other / 2 == e / 2 && other < ends) continue;
      others = true;
      left = left || way(e, other).type != WayType::kNone;
      entered = entered || way(other, e).type != WayType::kNone;
    }
    if (!others || (left && entered)) continue;
    const Pose2& out = sites[static_cast<std::size_t>(e)].depart;
    const Footprint& shape = vehicle.footprint;
    if (steep_turns) {
      return Error{ErrorCode::kTooSteep,
                   fmt::format("{} at ({:.1f}, {:.1f}): no way {} that keeps to slopes of {:.0f} "
                               "degrees along and {:.0f} across and to the terrain",
                               sites[static_cast<std::size_t>(e)].name, out.x, out.y,
                               left ? "in" : "out", vehicle.max_pitch_deg, vehicle.max_roll_deg),
                   "leave the row out (tasks.rows), or use a vehicle with larger max_pitch_deg and "
                   "max_roll_deg",
                   {}};
    }
    const double most = 50.0;
    const double ahead = space.room_ahead(out, most, {e / 2, -1});
    return Error{
        ErrorCode::kTurnDoesNotFit,
        fmt::format("{} at ({:.1f}, {:.1f}): no way {} for a turning radius of {:.2f} m and an "
                    "outline of {:.1f} x {:.1f} m with {:.1f} m of room beyond the row's end",
                    sites[static_cast<std::size_t>(e)].name, out.x, out.y, left ? "in" : "out",
                    radius, shape.front_m + shape.rear_m, shape.width_m, ahead),
        vehicle.can_reverse ? "widen the headland (headland_width_m, headland_outside_m), or use a "
                              "tighter vehicle"
                            : "widen the headland (headland_width_m, headland_outside_m), allow "
                              "reversing, or use a tighter vehicle",
        {}};
  }
  return std::nullopt;
}

LegKind Transitions::Impl::kind(const Way& w, int from, int to) const {
  return w.type == WayType::kTurn && from < ends && to < ends ? LegKind::kTurn : LegKind::kTransit;
}

Path Transitions::Impl::lane_path(int from, int to) const {
  const auto& begin = connections[static_cast<std::size_t>(out_port(from))];
  LaneGraph::Search search(*lanes);
  search.run(begin);
  return search.path_to(port(out_port(from)).end.out, begin,
                        connections[static_cast<std::size_t>(in_port(to))]);
}

Path Transitions::Impl::path(int from, int to) const {
  const Way& w = way(from, to);
  switch (w.type) {
    case WayType::kNone:
      break;
    case WayType::kTurn:
      return turn_path(sites[static_cast<std::size_t>(from)].depart,
                       turns[static_cast<std::size_t>(w.index)]);
    case WayType::kLanes:
      return lane_path(from, to);
    case WayType::kGiven:
      return given[static_cast<std::size_t>(w.index)];
    case WayType::kThroughRow: {
      Path through = path(from, w.index);
      through.append(row_path(rows[static_cast<std::size_t>(w.index / 2)], w.index % 2, radius));
      through.append(path(w.index ^ 1, to));
      return through;
    }
  }
  return {};
}

Result<Transitions> Transitions::build(const Farm& farm, const Ground& ground,
                                       const std::vector<RowRef>& rows,
                                       const std::vector<Site>& stops, const Vehicle& vehicle,
                                       const TransitionOptions& options) {
  const Result<RowBodies> bodies = row_bodies(farm, rows, vehicle.footprint, options.margin_m);
  if (!bodies) return tl::unexpected<Error>(bodies.error());
  auto impl = std::make_unique<Impl>(farm, ground, rows, stops, vehicle, options, *bodies);
  if (std::optional<Error> error = impl->shut_in_row()) return tl::unexpected<Error>(*error);
  return Transitions(std::move(impl));
}

Transitions::Transitions(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Transitions::~Transitions() = default;
Transitions::Transitions(Transitions&&) noexcept = default;
Transitions& Transitions::operator=(Transitions&&) noexcept = default;

int Transitions::sites() const { return static_cast<int>(impl_->sites.size()); }

const Site& Transitions::site(int index) const {
  return impl_->sites[static_cast<std::size_t>(index)];
}

double Transitions::free_run(int site, bool leaving) const {
  return impl_->port(leaving ? Impl::out_port(site) : Impl::in_port(site)).end.free_run;
}

DriveCost Transitions::cost(int from, int to) const {
  const Way& w = impl_->way(from, to);
  if (w.type == WayType::kNone) return {kInfinity, kInfinity, kInfinity};
  return w.cost;
}

bool Transitions::offer(int from, int to, Path path) {
  Way& w = impl_->way(from, to);
  if (from == to || path.empty()) return false;
  // A headland turn is not given up merely because open ground is driven faster.
  if (kind(from, to) == LegKind::kTurn) return false;
  // Sites are left and entered forwards.
  int cusps = static_cast<int>(path.segments().size()) - 1;
  if (path.segments().front().gear == Gear::kReverse) ++cusps;
  if (path.segments().back().gear == Gear::kReverse) ++cusps;
  const std::optional<DriveCost> cost = impl_->pricer.price(path, LegKind::kTransit, cusps);
  if (!cost) return false;
  if (w.type != WayType::kNone && impl_->value(w.cost) <= impl_->value(*cost)) return false;
  w = {*cost, static_cast<int>(impl_->given.size()), WayType::kGiven};
  impl_->given.push_back(std::move(path));
  return true;
}

LegKind Transitions::kind(int from, int to) const {
  return impl_->kind(impl_->way(from, to), from, to);
}

Path Transitions::path(int from, int to) const { return impl_->path(from, to); }

Eigen::MatrixXd Transitions::matrix() const {
  Eigen::MatrixXd costs(sites(), sites());
  for (int to = 0; to < sites(); ++to) {
    for (int from = 0; from < sites(); ++from) {
      costs(from, to) = cost(from, to).value(impl_->options.objective);
    }
  }
  return costs;
}

}  // namespace headland
