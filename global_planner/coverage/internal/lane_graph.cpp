// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/internal/lane_graph.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/geometry/dubins.hpp"
#include "core/geometry/reeds_shepp.hpp"
#include "global_planner/coverage/internal/parallel.hpp"

namespace headland::coverage {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDetour = 1.05;          // an edge this little shorter than two others is left out
constexpr double kLongest = 1.5;          // curve to distance; beyond, the edge is no lane
constexpr std::size_t kConnections = 10;  // of a port at most
constexpr double kConnectionStep = 1.0;   // [m] of its leads
// Beside a wall, a long nose can only be swung gently.
constexpr double kGentle = 4.0;  // times the turning radius
constexpr int kBlock = 1024;     // edges verified at once

}  // namespace

LaneGraph::LaneGraph(const FreeSpace& space, std::vector<Pose2> poses, double radius, bool reverses,
                     const WayPricer& pricer)
    : space_(space),
      poses_(std::move(poses)),
      radius_(radius),
      reverses_(reverses),
      reach_(std::max(12.0, 5.0 * radius)),
      pricer_(pricer),
      rate_(pricer.flat_rate(LegKind::kTransit)) {
  index_poses();
  join(candidates());
  join_reverses();
  price_steps();
  sort_steps();
}

WayCost LaneGraph::priced(const Path& path, int cusps) const {
  const std::optional<DriveCost> drive = pricer_.price(path, LegKind::kTransit, cusps);
  if (!drive) return {kInfinity, {}, 0};
  const int within = static_cast<int>(path.segments().size()) - 1;
  return {drive->value(pricer_.objective()), *drive, std::max(within, cusps)};
}

Pose2 LaneGraph::pose(int node) const {
  const Pose2& given = poses_[static_cast<std::size_t>(node / 2)];
  return node % 2 == 0 ? given : reversed(given);
}

void LaneGraph::index_poses() {
  if (poses_.empty()) return;
  Point2 low = poses_.front().position();
  Point2 high = low;
  for (const Pose2& pose : poses_) {
    low = low.cwiseMin(pose.position());
    high = high.cwiseMax(pose.position());
  }
  corner_ = low;
  columns_ = static_cast<int>((high.x() - low.x()) / reach_) + 1;
  rows_ = static_cast<int>((high.y() - low.y()) / reach_) + 1;
  cells_.resize(static_cast<std::size_t>(columns_ * rows_));
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Point2 at = (poses_[i].position() - corner_) / reach_;
    cells_[static_cast<std::size_t>(static_cast<int>(at.y()) * columns_ + static_cast<int>(at.x()))]
        .push_back(static_cast<int>(i));
  }
}

template <class Visit>
void LaneGraph::visit_near(const Point2& p, double distance, Visit visit) const {
  const auto cell = [this](double offset) { return static_cast<int>(std::floor(offset / reach_)); };
  const Point2 at = p - corner_;
  const int last_row = std::min(rows_ - 1, cell(at.y() + distance));
  const int last_column = std::min(columns_ - 1, cell(at.x() + distance));
  for (int row = std::max(0, cell(at.y() - distance)); row <= last_row; ++row) {
    for (int column = std::max(0, cell(at.x() - distance)); column <= last_column; ++column) {
      for (const int i : cells_[static_cast<std::size_t>(row * columns_ + column)]) {
        if ((poses_[static_cast<std::size_t>(i)].position() - p).norm() <= distance) visit(i);
      }
    }
  }
}

// All edges worth a look, one of each mirrored pair, shortest first.
std::vector<LaneGraph::Candidate> LaneGraph::candidates() const {
  std::vector<std::vector<Candidate>> of_node(static_cast<std::size_t>(nodes()));
  parallel_for(nodes(), [&](int from) {
    const Pose2 start = pose(from);
    visit_near(start.position(), reach_, [&](int i) {
      if (i == from / 2) return;
      for (const int to : {2 * i, 2 * i + 1}) {
        if (std::pair(to ^ 1, from ^ 1) < std::pair(from, to)) continue;
        const Pose2 end = pose(to);
        const double distance = (end.position() - start.position()).norm();
        const double longest = kLongest * distance + radius_;
        if (radius_ * std::abs(wrap_angle(end.yaw - start.yaw)) > longest) continue;
        const double length = dubins_length(start, end, radius_);
        if (length <= longest) {
          of_node[static_cast<std::size_t>(from)].push_back({length, from, to});
        }
      }
    });
  });
  std::vector<Candidate> all;
  for (const auto& some : of_node) all.insert(all.end(), some.begin(), some.end());
  std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.length, a.from, a.to) < std::tie(b.length, b.from, b.to);
  });
  return all;
}

bool LaneGraph::bypassed(const Candidate& edge) const {
  const double most = kDetour * edge.length + 0.05;
  for (const auto& [middle, first] : accepted_[static_cast<std::size_t>(edge.from)]) {
    if (first >= most) continue;
    for (const auto& [to, second] : accepted_[static_cast<std::size_t>(middle)]) {
      if (to == edge.to && first + second <= most) return true;
    }
  }
  return false;
}

// Edges are verified block by block in parallel; which to keep is settled one by one.
void LaneGraph::join(const std::vector<Candidate>& candidates) {
  accepted_.resize(static_cast<std::size_t>(nodes()));
  std::vector<int> open;
  std::vector<double> radii;
  const int count = static_cast<int>(candidates.size());
  for (int begin = 0; begin < count; begin += kBlock) {
    open.clear();
    for (int i = begin; i < std::min(begin + kBlock, count); ++i) {
      if (!bypassed(candidates[static_cast<std::size_t>(i)])) open.push_back(i);
    }
    radii.assign(open.size(), 0.0);
    parallel_for(static_cast<int>(open.size()), [&](int k) {
      const auto at = static_cast<std::size_t>(k);
      radii[at] = fitting_radius(candidates[static_cast<std::size_t>(open[at])]);
    });
    for (std::size_t k = 0; k < open.size(); ++k) {
      const Candidate& edge = candidates[static_cast<std::size_t>(open[k])];
      if (radii[k] == 0.0 || bypassed(edge)) continue;
      Step step;
      step.from = edge.from;
      step.to = edge.to;
      step.radius = radii[k];
      const double length = radii[k] == radius_
                                ? edge.length
                                : dubins_length(pose(edge.from), pose(edge.to), radii[k]);
      accepted_[static_cast<std::size_t>(edge.from)].emplace_back(edge.to, length);
      steps_.push_back(step);
      if (std::pair(edge.to ^ 1, edge.from ^ 1) == std::pair(edge.from, edge.to)) continue;
      step.from = edge.to ^ 1;
      step.to = edge.from ^ 1;
      step.mirrored = true;
      accepted_[static_cast<std::size_t>(step.from)].emplace_back(step.to, length);
      steps_.push_back(step);
    }
  }
  accepted_.clear();
}

// Half a turn on the spot: three arcs of 60 degrees, the middle one in reverse, whose centres form
// an equilateral triangle; or else the loop of three forward arcs.
Curve LaneGraph::turn_round(bool other_hand) const {
  const double curvature = (other_hand ? -1.0 : 1.0) / radius_;
  const double arc = radius_ * kPi / 3.0;
  Curve curve;
  curve.add({reverses_ ? curvature : -curvature, arc});
  curve.add({reverses_ ? -curvature : curvature, reverses_ ? -arc : 5.0 * arc});
  curve.add({reverses_ ? curvature : -curvature, arc});
  return curve;
}

void LaneGraph::join_reverses() {
  std::vector<int> hand(static_cast<std::size_t>(nodes()), -1);
  parallel_for(nodes(), [&](int node) {
    for (const int other : {0, 1}) {
      if (space_.fits(pose(node), turn_round(other == 1), Travel::kBoth, {})) {
        hand[static_cast<std::size_t>(node)] = other;
        return;
      }
    }
  });
  for (int node = 0; node < nodes(); ++node) {
    const int other = hand[static_cast<std::size_t>(node)];
    if (other < 0) continue;
    Step step;
    step.from = node;
    step.to = node ^ 1;
    step.kind = StepKind::kTurnRound;
    step.mirrored = other == 1;
    steps_.push_back(step);
  }
}

// Each step in its own direction; those too steep to drive are dropped.
void LaneGraph::price_steps() {
  parallel_for(static_cast<int>(steps_.size()), [this](int s) {
    Step& step = steps_[static_cast<std::size_t>(s)];
    step.way = priced(step_path(step));
  });
  std::erase_if(steps_, [](const Step& step) { return step.way.cost == kInfinity; });
}

// The radius of a curve along which the outline fits both ways; 0: none.
double LaneGraph::fitting_radius(const Candidate& edge) const {
  const Pose2 from = pose(edge.from);
  const Pose2 to = pose(edge.to);
  for (const double radius : {radius_, kGentle * radius_}) {
    const Curve curve = without_slivers(shortest_dubins(from, to, radius));
    if (curve.length() > kLongest * (to.position() - from.position()).norm() + radius_) break;
    if (space_.fits(from, curve, Travel::kBoth, {})) return radius;
  }
  return 0.0;
}

void LaneGraph::sort_steps() {
  std::stable_sort(steps_.begin(), steps_.end(),
                   [](const Step& a, const Step& b) { return a.from < b.from; });
  const std::size_t all = static_cast<std::size_t>(nodes()) + passages_.size();
  step_begin_.assign(all + 1, 0);
  for (const Step& step : steps_) ++step_begin_[static_cast<std::size_t>(step.from) + 1];
  for (std::size_t n = 0; n < all; ++n) step_begin_[n + 1] += step_begin_[n];
  potential_.resize(all);
  for (int n = 0; n < nodes(); ++n) potential_[static_cast<std::size_t>(n)] = potential(pose(n));
  for (std::size_t p = 0; p < passages_.size(); ++p) {
    potential_[static_cast<std::size_t>(nodes()) + p] = potential(passages_[p].path.start_pose());
  }
  const auto of = [this](int node) { return potential_[static_cast<std::size_t>(node)]; };
  arcs_.clear();
  for (const Step& step : steps_) {
    arcs_.push_back({step.way.cost + of(step.from) - of(step.to), step.way, step.to});
  }
}

Curve LaneGraph::Option::curve(const LaneGraph& graph, const Pose2& out, bool reversing) const {
  const Pose2 from = advance(out, 0.0, lead);
  const Pose2 to = graph.pose(node);
  return without_slivers(reversing ? shortest_reeds_shepp(from, to, radius)
                                   : shortest_dubins(from, to, radius));
}

// All tracks out of a port, by a lower bound of their cost.
std::vector<LaneGraph::Option> LaneGraph::options(const TurnEnd& end) const {
  std::vector<Option> all;
  for (double lead = 0.0; lead <= end.free_run; lead += kConnectionStep) {
    const Pose2 from = advance(end.out, 0.0, lead);
    visit_near(from.position(), reach_, [&](int i) {
      for (const int node : {2 * i, 2 * i + 1}) {
        const Pose2 to = pose(node);
        const double distance = (to.position() - from.position()).norm();
        const double least = std::max(distance, radius_ * std::abs(wrap_angle(to.yaw - from.yaw)));
        all.push_back({rate_.of(lead + least, 0), lead, radius_, node, false});
      }
    });
  }
  return all;
}

std::vector<Connection> LaneGraph::connect(const Port& port, bool reversing) const {
  const auto costs_more = [](const Option& a, const Option& b) {
    return std::tie(a.cost, a.node, a.lead, a.radius) > std::tie(b.cost, b.node, b.lead, b.radius);
  };
  std::vector<Connection> found;
  std::vector<double> costs;  // of those found
  const auto beyond_another = [&](const Option& option) {
    for (std::size_t k = 0; k < found.size(); ++k) {
      const double on = dubins_length(pose(found[k].node), pose(option.node), radius_);
      if (costs[k] + rate_.of(on, 0) <= kDetour * option.cost) return true;
    }
    return false;
  };
  std::vector<int> settled;  // nodes found, or beyond one that is
  std::vector<Option> heap = options(port.end);
  std::make_heap(heap.begin(), heap.end(), costs_more);
  while (!heap.empty() && found.size() < kConnections) {
    std::pop_heap(heap.begin(), heap.end(), costs_more);
    Option option = heap.back();
    heap.pop_back();
    if (std::find(settled.begin(), settled.end(), option.node) != settled.end()) continue;
    const Curve curve = option.curve(*this, port.end.out, reversing);
    if (!option.known) {
      const Turn turn{option.lead, 0.0, curve};
      option.cost = rate_.of(turn.length(), turn.cusps());
      option.known = true;
    } else if (beyond_another(option)) {
      settled.push_back(option.node);
      continue;
    } else if (space_.fits(advance(port.end.out, 0.0, option.lead), curve, port.travel,
                           {port.end.row, -1})) {
      settled.push_back(option.node);
      Connection connection{option.node, {}, {option.lead, 0.0, curve}};
      connection.way = priced(port.travel == Travel::kBack
                                  ? turn_path(pose(option.node ^ 1), mirrored(connection.turn))
                                  : turn_path(port.end.out, connection.turn),
                              connection.turn.cusps());
      if (connection.way.cost == kInfinity) continue;
      found.push_back(connection);
      costs.push_back(option.cost);
      continue;
    } else if (option.radius == radius_ && !reversing) {
      option.radius = kGentle * radius_;
      option.known = false;
    } else {
      continue;
    }
    heap.push_back(option);
    std::push_heap(heap.begin(), heap.end(), costs_more);
  }
  return found;
}

void LaneGraph::add_passages(std::vector<Passage> passages) {
  passages_ = std::move(passages);
  for (std::size_t p = 0; p < passages_.size(); ++p) {
    const Passage& passage = passages_[p];
    const int inside = nodes() + static_cast<int>(p);
    const WayCost through = priced(passage.path);
    if (through.cost == kInfinity) continue;
    Step step;
    step.passage = static_cast<int>(p);
    for (std::size_t c = 0; c < passage.in.size(); ++c) {
      step.kind = StepKind::kIntoRow;
      step.from = passage.in[c].node ^ 1;
      step.to = inside;
      step.connection = static_cast<int>(c);
      step.way = passage.in[c].way;
      steps_.push_back(step);
    }
    for (std::size_t c = 0; c < passage.out.size(); ++c) {
      step.kind = StepKind::kOutOfRow;
      step.from = inside;
      step.to = passage.out[c].node;
      step.connection = static_cast<int>(c);
      step.way = through + passage.out[c].way;
      steps_.push_back(step);
    }
  }
  sort_steps();
}

Path LaneGraph::step_path(const Step& step) const {
  Path path;
  if (step.kind == StepKind::kLane) {
    // In the sense in which it was verified: the shortest curve need not be unique.
    const Pose2 from = pose(step.mirrored ? step.to ^ 1 : step.from);
    const Pose2 to = pose(step.mirrored ? step.from ^ 1 : step.to);
    path.append(without_slivers(shortest_dubins(from, to, step.radius)), from, 0);
    return step.mirrored ? mirrored(path) : path;
  }
  if (step.kind == StepKind::kTurnRound) {
    path.append(turn_round(step.mirrored), pose(step.from), 0);
    return path;
  }
  const Passage& passage = passages_[static_cast<std::size_t>(step.passage)];
  const auto at = static_cast<std::size_t>(step.connection);
  if (step.kind == StepKind::kIntoRow) {
    // The port's track, driven from the lane into the row.
    return turn_path(pose(step.from), mirrored(passage.in[at].turn));
  }
  path.append(passage.path);
  path.append(turn_path(passage.path.end_pose(), passage.out[at].turn));
  return path;
}

LaneGraph::Search::Search(const LaneGraph& graph)
    : graph_(graph), reached_(graph.step_begin_.size() - 1) {}

// Dijkstra's algorithm over costs made non-negative by potentials, begun at all connections of the
// port.
void LaneGraph::Search::run(const std::vector<Connection>& from) {
  std::fill(reached_.begin(), reached_.end(), Reached{{kInfinity, {}, 0}, kInfinity, -1});
  queue_.clear();
  const auto reach = [this](int node, double reduced, const WayCost& way, int number) {
    Reached& there = reached_[static_cast<std::size_t>(node)];
    if (reduced >= there.reduced) return;
    there = {way, reduced, number};
    queue_.emplace_back(reduced, node);
    std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
  };
  for (std::size_t c = 0; c < from.size(); ++c) {
    const double potential = graph_.potential_[static_cast<std::size_t>(from[c].node)];
    reach(from[c].node, from[c].way.cost - potential, from[c].way, -2 - static_cast<int>(c));
  }
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
    const auto [reduced, node] = queue_.back();
    queue_.pop_back();
    const auto n = static_cast<std::size_t>(node);
    const Reached so_far = reached_[n];
    if (reduced > so_far.reduced) continue;
    for (int s = graph_.step_begin_[n]; s < graph_.step_begin_[n + 1]; ++s) {
      const Arc& arc = graph_.arcs_[static_cast<std::size_t>(s)];
      reach(arc.to, reduced + arc.reduced, so_far.way + arc.way, s);
    }
  }
}

int LaneGraph::Search::best_entry(const std::vector<Connection>& port) const {
  int best = -1;
  double least = kInfinity;
  for (std::size_t c = 0; c < port.size(); ++c) {
    const double cost =
        reached_[static_cast<std::size_t>(port[c].node ^ 1)].way.cost + port[c].way.cost;
    if (cost < least) {
      least = cost;
      best = static_cast<int>(c);
    }
  }
  return best;
}

WayCost LaneGraph::Search::to(const std::vector<Connection>& port) const {
  const int best = best_entry(port);
  if (best < 0) return {kInfinity, {}, 0};
  const Connection& entry = port[static_cast<std::size_t>(best)];
  return reached_[static_cast<std::size_t>(entry.node ^ 1)].way + entry.way;
}

Path LaneGraph::Search::path_to(const Pose2& out, const std::vector<Connection>& from,
                                const std::vector<Connection>& port) const {
  Path path;
  const int best = best_entry(port);
  if (best < 0) return path;
  const Connection& entry = port[static_cast<std::size_t>(best)];
  std::vector<int> chain;
  int node = entry.node ^ 1;
  for (;;) {
    const int s = reached_[static_cast<std::size_t>(node)].last_step;
    chain.push_back(s);
    if (s < -1) break;
    node = graph_.steps_[static_cast<std::size_t>(s)].from;
  }
  path.append(turn_path(out, from[static_cast<std::size_t>(-2 - chain.back())].turn));
  for (auto s = chain.rbegin() + 1; s != chain.rend(); ++s) {
    path.append(graph_.step_path(graph_.steps_[static_cast<std::size_t>(*s)]));
  }
  // The last track, begun at the node: its own mirror image.
  const Turn last = mirrored(entry.turn);
  const Pose2 at = graph_.pose(entry.node ^ 1);
  path.append(turn_path(at, last));
  return path;
}

}  // namespace headland::coverage
