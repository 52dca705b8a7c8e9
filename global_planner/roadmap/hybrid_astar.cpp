// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/hybrid_astar.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "global_planner/roadmap/internal/drive_rules.hpp"
#include "global_planner/roadmap/internal/grid_distance.hpp"
#include "global_planner/roadmap/internal/outline_fit.hpp"
#include "global_planner/roadmap/internal/shorten.hpp"

// Dolgov, Thrun, Montemerlo, Diebel 2010, section 2: a cell of the grid (x, y, heading) keeps the
// exact pose of the cheapest drive that has reached it (2.1); the heuristic is the larger of the
// shortest curve without obstacles and the shortest way around them without a turning radius (2.2);
// from time to time the curve without obstacles is tried as the rest of the path (2.3). Ours: the
// same search is also run backwards from the goal, since it is easier to find out of a tight place
// than into it, and a goal that cannot be entered is soon exhausted from its own side.
namespace headland {
namespace {

using roadmap::DriveRules;
using roadmap::GridDistance;
using roadmap::Join;
using roadmap::OutlineFit;
using roadmap::PathBuilder;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kSamePlace = 1e-9;  // [m, rad]
constexpr double kStepRatio = 1.05;  // of a step over a cell's diagonal
constexpr int kFinest = 2;           // halvings of a step
constexpr double kTryEvery = 10.0;   // steps of distance to the goal, for one step between tries
constexpr int kFirstLimit = 2000;    // expansions from the start, before any from the goal
constexpr int kLimitGrowth = 4;
constexpr int kLeastAfterwork = 500;  // expansions after the first solution

// A pose, and the piece that was driven to it.
struct Node {
  Pose2 pose;
  double cost = 0.0;
  int parent = -1;
  CurvePiece piece;
  int level = 0;  // of halving the step
  bool closed = false;
};

class Search {
 public:
  Search(const DriveRules& rules, const OutlineFit& fit, const HybridAstarOptions& options,
         const Pose2& from, const Pose2& to)
      : rules_(rules),
        fit_(fit),
        options_(options),
        goal_(to),
        around_(fit.area(), fit.disc_radius(), options.cell_m, to.position()),
        // Long enough to leave the cell, and the arcs also their heading.
        step_(std::max(kStepRatio * std::numbers::sqrt2 * options.cell_m,
                       rules.radius * 2.0 * kPi / options.headings)) {
    add(Node{from, 0.0, -1, {}, 0, false});
  }

  /// Goes on up to so many expansions in all. True if a path has been found; then it has gone on
  /// for as much work again to better it.
  bool run(int limit) {
    while (!open_.empty() && expansions_ < std::min(limit, enough_)) {
      const auto [bound, at] = pop();
      if (bound >= best_cost_) break;
      if (node(at).closed || node_of_cell_[cell(node(at))] != at) continue;  // outdone
      node(at).closed = true;
      ++expansions_;
      if (try_due(bound - node(at).cost)) try_rest(at);
      expand(at);
    }
    return best_cost_ < kInfinite;
  }

  Path path() const {
    std::vector<int> way;
    for (int at = best_node_; node(at).parent >= 0; at = node(at).parent) way.push_back(at);
    PathBuilder builder;
    for (auto at = way.rbegin(); at != way.rend(); ++at) {
      builder.add(node(node(*at).parent).pose, node(*at).piece);
    }
    builder.add(node(best_node_).pose, best_rest_);
    return builder.path();
  }

  int expansions() const { return expansions_; }
  bool exhausted() const { return open_.empty(); }

 private:
  using Entry = std::pair<double, int>;  // lower bound of the whole cost, node

  Node& node(int i) { return nodes_[static_cast<std::size_t>(i)]; }
  const Node& node(int i) const { return nodes_[static_cast<std::size_t>(i)]; }

  // Its own number for each cell of the grid of a level.
  std::uint64_t cell(const Node& at) const {
    const double fineness = 1 << at.level;
    const auto part = [&](double offset) {
      const auto count = static_cast<std::int64_t>(std::floor(offset / options_.cell_m * fineness));
      return static_cast<std::uint64_t>(count + (1 << 23)) & ((1 << 24) - 1);
    };
    const double turns = wrap_positive(at.pose.yaw) / (2.0 * kPi);
    const auto headings = static_cast<std::int64_t>(options_.headings) << at.level;
    const auto heading =
        static_cast<std::uint64_t>(std::llround(turns * static_cast<double>(headings)) % headings);
    return ((part(at.pose.x - goal_.x) << 24 | part(at.pose.y - goal_.y)) << 14 | heading) << 2 |
           static_cast<std::uint64_t>(at.level);
  }

  double to_go(const Pose2& pose) {
    return std::max(around_.at(pose.position()), rules_.open_distance(pose, goal_));
  }

  void add(const Node& reached) {
    const double bound = reached.cost + to_go(reached.pose);
    if (!(bound < best_cost_)) return;
    const int at = static_cast<int>(nodes_.size());
    nodes_.push_back(reached);
    node_of_cell_[cell(reached)] = at;
    open_.emplace_back(bound, at);
    std::push_heap(open_.begin(), open_.end(), std::greater<>());
  }

  Entry pop() {
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    const Entry top = open_.back();
    open_.pop_back();
    return top;
  }

  double cusp_cost(const Node& at, Gear next) const {
    return at.parent >= 0 && Join::gear_of(at.piece) != next ? rules_.cusp_cost : 0.0;
  }

  void expand(int at) {
    for (const double direction : {1.0, -1.0}) {
      if (direction < 0.0 && !rules_.reverses) break;
      for (const double turn : {0.0, 1.0, -1.0}) {
        // Where a step does not fit, half of it may.
        for (int level = 0; level <= kFinest; ++level) {
          const double length = direction * step_ / (1 << level);
          if (try_step(at, CurvePiece{turn / rules_.radius, length}, level)) break;
        }
      }
    }
  }

  // False if the step does not fit.
  bool try_step(int at, const CurvePiece& piece, int level) {
    const Node& from = node(at);
    const Node next{advance(from.pose, piece.curvature, piece.length),
                    from.cost + cusp_cost(from, Join::gear_of(piece)) + rules_.cost(piece),
                    at,
                    piece,
                    level,
                    false};
    const auto known = node_of_cell_.find(cell(next));
    if (known != node_of_cell_.end() &&
        (node(known->second).closed || node(known->second).cost <= next.cost)) {
      return true;  // or at least of no use
    }
    if (!fit_.fits(from.pose, piece)) return false;
    add(next);
    return true;
  }

  // More often the nearer the goal is.
  bool try_due(double distance) {
    if (expansions_ < next_try_) return false;
    next_try_ = expansions_ + 1 + static_cast<int>(distance / (kTryEvery * step_));
    return true;
  }

  void try_rest(int at) {
    const Node& from = node(at);
    for (const Join& join : joins(rules_, from.pose, goal_)) {
      const double cost = from.cost + cusp_cost(from, join.first_gear()) + join.cost;
      if (cost >= best_cost_ || !fit_.fits(from.pose, join.curve)) continue;
      if (best_cost_ == kInfinite) {
        enough_ = expansions_ + std::max(expansions_, kLeastAfterwork);
      }
      best_cost_ = cost;
      best_node_ = at;
      best_rest_ = join.curve;
    }
  }

  const DriveRules& rules_;
  const OutlineFit& fit_;
  const HybridAstarOptions& options_;
  Pose2 goal_;
  GridDistance around_;
  double step_;  // [m]
  std::vector<Node> nodes_;
  std::unordered_map<std::uint64_t, int> node_of_cell_;  // never iterated
  std::vector<Entry> open_;                              // a heap, least bound on top
  int expansions_ = 0;
  int enough_ = std::numeric_limits<int>::max();
  int next_try_ = 0;
  double best_cost_ = kInfinite;
  int best_node_ = -1;
  Curve best_rest_;
};

// The same track, driven from its end to its start by a vehicle whose front is its rear.
Path mirrored(const Path& path) {
  PathBuilder builder;
  for (auto piece = path.pieces().rbegin(); piece != path.pieces().rend(); ++piece) {
    builder.add(turned_round(*piece));
  }
  return builder.path();
}

Footprint mirrored(const Footprint& outline) {
  return {outline.rear_m, outline.front_m, outline.width_m};
}

std::string text(const Pose2& pose) {
  return fmt::format("({:.2f} m, {:.2f} m, {:.1f} deg)", pose.x, pose.y,
                     rad_to_deg(wrap_angle(pose.yaw)));
}

tl::unexpected<Error> no_way(const Pose2& from, const Pose2& to, bool exhausted, int expansions) {
  return fail(ErrorCode::kNoPath,
              fmt::format("no way from {} to {}: the search is {} after {} expansions", text(from),
                          text(to), exhausted ? "exhausted" : "out of its budget", expansions),
              exhausted ? "the way is too narrow for the vehicle, or closed"
                        : "allow more expansions, or search on coarser cells");
}

}  // namespace

HybridAstar::HybridAstar(const Region& area, const Vehicle& vehicle,
                         const HybridAstarOptions& options)
    : area_(area), vehicle_(vehicle), options_(options) {}

Result<Path> HybridAstar::plan(const Pose2& from, const Pose2& to) const {
  const OutlineFit fit(area_, vehicle_.footprint, options_.margin_m);
  for (const auto& [name, pose] : {std::pair("start", from), std::pair("goal", to)}) {
    if (fit.fits(pose)) continue;
    return fail(ErrorCode::kNoPath,
                fmt::format("the vehicle does not fit at the {} {}: its outline with a margin of "
                            "{:.2f} m is not all in the drivable area",
                            name, text(pose), options_.margin_m),
                "move the pose, or keep less margin");
  }
  if ((from.position() - to.position()).norm() < kSamePlace &&
      std::abs(wrap_angle(from.yaw - to.yaw)) < kSamePlace) {
    return Path{};
  }
  const DriveRules rules{vehicle_.turning_radius(), vehicle_.can_reverse, options_.reverse_weight,
                         options_.cusp_cost_m, options_.steering_weight};
  const OutlineFit fit_back(area_, mirrored(vehicle_.footprint), options_.margin_m);
  Search forth(rules, fit, options_, from, to);
  Search back(rules, fit_back, options_, reversed(to), reversed(from));
  const int most = (options_.max_expansions + 1) / 2;  // either way
  for (int limit = std::min(kFirstLimit, most);; limit = std::min(kLimitGrowth * limit, most)) {
    if (forth.run(limit)) return roadmap::shortened(forth.path(), rules, fit);
    if (!forth.exhausted() && back.run(limit)) {
      return roadmap::shortened(mirrored(back.path()), rules, fit);
    }
    if (limit == most || forth.exhausted() || back.exhausted()) break;
  }
  return no_way(from, to, forth.exhausted() || back.exhausted(),
                forth.expansions() + back.expansions());
}

}  // namespace headland
