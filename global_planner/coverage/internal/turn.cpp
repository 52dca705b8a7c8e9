// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/internal/turn.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "core/geometry/dubins.hpp"
#include "core/geometry/fishtail.hpp"
#include "core/geometry/reeds_shepp.hpp"

namespace headland::coverage {
namespace {

enum class Kind { kDubins, kFishtail, kReedsShepp, kThreePointLeft, kThreePointRight };

constexpr int kMostTests = 400;   // of one search
constexpr double kSliver = 1e-9;  // [m] shorter pieces are rounding

struct Candidate {
  double cost = 0.0;  // a lower bound until the curve is known
  int line = 0;       // of leads that grow together; settles ties
  int steps = 0;      // of growth
  Kind kind = Kind::kDubins;
  bool known = false;
  Turn turn;
};

bool costs_more(const Candidate& a, const Candidate& b) {
  return std::tie(a.cost, a.line, a.steps, a.kind) > std::tie(b.cost, b.line, b.steps, b.kind);
}

Pose2 forward(const Pose2& pose, double distance) { return advance(pose, 0.0, distance); }

struct Leads {
  double out = 0.0;  // [m]
  double in = 0.0;   // [m]
};

// Where the leads begin to grow.
std::vector<Leads> first_leads(const TurnEnd& from, const TurnEnd& to, const Footprint& outline) {
  std::vector<Leads> level{{0.0, 0.0}};
  const Point2 sum = from.out.heading() + to.out.heading();
  if (sum.norm() > 1.0 && from.free_run > 0.0 && to.free_run > 0.0) {
    // How much farther out the second end lies.
    const double ahead = (to.out.position() - from.out.position()).dot(sum.normalized());
    if (std::abs(ahead) >= TurnSearch::kLeadStep) {
      for (const double part : {0.5, 1.0}) {
        level.push_back({std::max(0.0, part * ahead), std::max(0.0, -part * ahead)});
      }
    }
  }
  std::vector<Leads> all;
  for (const Leads& leads : level) {
    if (leads.out > from.free_run || leads.in > to.free_run) continue;
    all.push_back(leads);
    for (double more = TurnSearch::kLeadStep; more <= outline.rear_m;
         more += TurnSearch::kLeadStep) {
      if (leads.out + more <= from.free_run) all.push_back({leads.out + more, leads.in});
    }
    for (double more = TurnSearch::kLeadStep; more <= outline.front_m;
         more += TurnSearch::kLeadStep) {
      if (leads.in + more <= to.free_run) all.push_back({leads.out, leads.in + more});
    }
  }
  return all;
}

int cusps_at_least(Kind kind) {
  return kind == Kind::kDubins ? 0 : kind == Kind::kReedsShepp ? 1 : 2;
}

double angle_of(const Point2& v) { return std::atan2(v.y(), v.x()); }

// The three-point turn: an arc forwards, one in reverse with the steering thrown over, an arc
// forwards. Between antiparallel rows nearer than 2 R all of its kind are pi R long, the shortest
// Reeds-Shepp curve among them; which of them fits is for the headland to say.
std::optional<Curve> three_point_turn(const Pose2& from, const Pose2& to, double radius,
                                      double hand) {
  const Point2 first = from.position() + hand * radius * from.left();
  const Point2 last = to.position() + hand * radius * to.left();
  const Point2 apart = last - first;
  const double distance = apart.norm();
  if (distance >= 4.0 * radius || distance < kSliver) return std::nullopt;
  const Point2 across = Point2(-apart.y(), apart.x()) / distance *
                        std::sqrt(4.0 * radius * radius - 0.25 * distance * distance);
  const auto turned = [hand](const Point2& a, const Point2& b) {
    return wrap_positive(hand * (angle_of(b) - angle_of(a)), kSliver);
  };
  std::optional<Curve> best;
  for (const double side : {1.0, -1.0}) {
    const Point2 middle = 0.5 * (first + last) + side * across;
    const Point2 in = 0.5 * (first + middle);
    const Point2 out = 0.5 * (middle + last);
    Curve curve;
    curve.add({hand / radius, radius * turned(from.position() - first, in - first)});
    curve.add({-hand / radius, -radius * turned(in - middle, out - middle)});
    curve.add({hand / radius, radius * turned(out - last, to.position() - last)});
    if (!best || curve.length() < best->length()) best = curve;
  }
  return best;
}

// Computes the candidate's curve; false if there is none of this kind.
bool resolve(Candidate& candidate, const TurnEnd& a, const TurnEnd& b, double radius) {
  const Pose2 from = forward(a.out, candidate.turn.lead_out);
  const Pose2 to = reversed(forward(b.out, candidate.turn.lead_in));
  switch (candidate.kind) {
    case Kind::kDubins:
      candidate.turn.curve = without_slivers(shortest_dubins(from, to, radius));
      return true;
    case Kind::kReedsShepp:
      candidate.turn.curve = without_slivers(shortest_reeds_shepp(from, to, radius));
      return candidate.turn.cusps() > 0;  // or else the Dubins curve is the same
    case Kind::kFishtail:
    case Kind::kThreePointLeft:
    case Kind::kThreePointRight:
      break;
  }
  const std::optional<Curve> curve =
      candidate.kind == Kind::kFishtail
          ? fishtail(from, to, radius)
          : three_point_turn(from, to, radius,
                             candidate.kind == Kind::kThreePointLeft ? 1.0 : -1.0);
  if (curve) candidate.turn.curve = *curve;
  return curve.has_value();
}

}  // namespace

CostRate cost_rate(const Vehicle& vehicle, LegKind kind, const CostWeights& objective) {
  return {drive_cost(vehicle, kind, 1.0, 0).value(objective),
          drive_cost(vehicle, kind, 0.0, 1).value(objective)};
}

Curve without_slivers(const Curve& curve) {
  Curve clean;
  for (const CurvePiece& piece : curve) {
    if (std::abs(piece.length) > kSliver) clean.add(piece);
  }
  return clean;
}

Curve mirrored(const Curve& curve) {
  Curve back;
  for (int i = curve.count() - 1; i >= 0; --i) {
    const CurvePiece& piece = curve.begin()[i];
    back.add({-piece.curvature, piece.length});
  }
  return back;
}

int Turn::cusps() const {
  if (curve.count() == 0) return 0;
  return curve.cusps() + (curve.begin()->length < 0.0 ? 1 : 0) +
         ((curve.end() - 1)->length < 0.0 ? 1 : 0);
}

Turn mirrored(const Turn& turn) { return {turn.lead_in, turn.lead_out, mirrored(turn.curve)}; }

Path mirrored(const Path& path) {
  Path back;
  const std::vector<PathPiece>& pieces = path.pieces();
  for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece) {
    back.append(turned_round(*piece));
  }
  return back;
}

Path turn_path(const Pose2& out, const Turn& turn) {
  Path path;
  path.append_straight(out, turn.lead_out, 0);
  const Pose2 from = forward(out, turn.lead_out);
  path.append(turn.curve, from, 0);
  path.append_straight(turn.curve.end_pose(from), turn.lead_in, 0);
  return path;
}

std::optional<Turn> TurnSearch::find(const TurnEnd& from, const TurnEnd& to, TurnKinds kinds,
                                     CostRate rate) const {
  const std::vector<Leads> firsts = first_leads(from, to, space_.outline());
  std::vector<Candidate> heap;
  const Point2 apart = to.out.position() - from.out.position();
  const Point2 heading_out = from.out.heading();
  const Point2 heading_in = to.out.heading();
  const double turning = radius_ * std::abs(wrap_angle(to.out.yaw + kPi - from.out.yaw));
  // Growing both leads by a step never lowers the bound: it lengthens them by as much as it can
  // bring their ends together. So a line's next candidate may wait until this one has come up.
  const auto push = [&](int line, int steps, Kind kind) {
    const Leads& first = firsts[static_cast<std::size_t>(line)];
    const double grown = steps * kLeadStep;
    if (steps > 0 && first.out + grown > from.free_run && first.in + grown > to.free_run) return;
    const double out = std::min(first.out + grown, from.free_run);
    const double in = std::min(first.in + grown, to.free_run);
    const double least = std::max((apart + in * heading_in - out * heading_out).norm(), turning);
    heap.push_back({rate.of(out + least + in, cusps_at_least(kind)), line, steps, kind, false,
                    Turn{out, in, {}}});
    std::push_heap(heap.begin(), heap.end(), costs_more);
  };
  for (int line = 0; line < static_cast<int>(firsts.size()); ++line) {
    if (kinds.dubins) push(line, 0, Kind::kDubins);
    if (kinds.fishtail) push(line, 0, Kind::kFishtail);
    if (!kinds.reeds_shepp) continue;
    for (const Kind kind : {Kind::kThreePointLeft, Kind::kThreePointRight, Kind::kReedsShepp}) {
      push(line, 0, kind);
    }
  }
  int tests = 0;
  while (!heap.empty() && tests < kMostTests) {
    std::pop_heap(heap.begin(), heap.end(), costs_more);
    Candidate next = heap.back();
    heap.pop_back();
    if (!next.known) {
      push(next.line, next.steps + 1, next.kind);
      if (!resolve(next, from, to, radius_)) continue;
      next.known = true;
      next.cost = rate.of(next.turn.length(), next.turn.cusps());
      heap.push_back(next);
      std::push_heap(heap.begin(), heap.end(), costs_more);
      continue;
    }
    ++tests;
    if (space_.fits(forward(from.out, next.turn.lead_out), next.turn.curve, Travel::kForth,
                    {from.row, to.row})) {
      return next.turn;
    }
  }
  return std::nullopt;
}

}  // namespace headland::coverage
