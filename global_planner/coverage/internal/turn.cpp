// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/internal/turn.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/dubins.hpp"
#include "core/geometry/fishtail.hpp"
#include "core/geometry/reeds_shepp.hpp"

namespace headland::coverage {
namespace {

enum class Kind { kDubins, kFishtail, kReedsShepp };

struct Candidate {
  double cost = 0.0;  // a lower bound until the curve is known
  int number = 0;     // settles ties
  Kind kind = Kind::kDubins;
  bool known = false;
  Turn turn;
};

bool costs_more(const Candidate& a, const Candidate& b) {
  return a.cost != b.cost ? a.cost > b.cost : a.number > b.number;
}

Pose2 forward(const Pose2& pose, double distance) { return advance(pose, 0.0, distance); }

// Leads of two ends so that they come level, or part of the way there.
struct LeadFamily {
  double out = 0.0;
  double in = 0.0;
};

std::vector<LeadFamily> lead_families(const TurnEnd& a, const TurnEnd& b) {
  std::vector<LeadFamily> families{{0.0, 0.0}};
  const Point2 sum = a.out.heading() + b.out.heading();
  if (sum.norm() < 1.0 || a.free_run <= 0.0 || b.free_run <= 0.0) return families;
  // How much farther out the second end lies.
  const double ahead = (b.out.position() - a.out.position()).dot(sum.normalized());
  if (std::abs(ahead) < TurnSearch::kLeadStep) return families;
  for (const double part : {0.5, 1.0}) {
    families.push_back({std::max(0.0, part * ahead), std::max(0.0, -part * ahead)});
  }
  return families;
}

int cusps_at_least(Kind kind) {
  return kind == Kind::kDubins ? 0 : kind == Kind::kFishtail ? 2 : 1;
}

// Computes the candidate's curve; false if there is none of this kind.
bool resolve(Candidate& candidate, const TurnEnd& a, const TurnEnd& b, double radius) {
  const Pose2 from = forward(a.out, candidate.turn.lead_out);
  const Pose2 to = reversed(forward(b.out, candidate.turn.lead_in));
  switch (candidate.kind) {
    case Kind::kDubins:
      candidate.turn.curve = shortest_dubins(from, to, radius);
      return true;
    case Kind::kReedsShepp:
      candidate.turn.curve = shortest_reeds_shepp(from, to, radius);
      return candidate.turn.cusps() > 0;  // or else the Dubins curve is the same
    case Kind::kFishtail:
      break;
  }
  const std::optional<Curve> curve = fishtail(from, to, radius);
  if (curve) candidate.turn.curve = *curve;
  return curve.has_value();
}

}  // namespace

CostRate cost_rate(const Vehicle& vehicle, LegKind kind, Objective objective) {
  return {drive_cost(vehicle, kind, 1.0, 0).value(objective),
          drive_cost(vehicle, kind, 0.0, 1).value(objective)};
}

Curve mirrored(const Curve& curve) {
  Curve back;
  for (int i = curve.count() - 1; i >= 0; --i) {
    const CurvePiece& piece = curve.begin()[i];
    back.add({-piece.curvature, piece.length});
  }
  return back;
}

Turn mirrored(const Turn& turn) { return {turn.lead_in, turn.lead_out, mirrored(turn.curve)}; }

Path mirrored(const Path& path) {
  Path back;
  const std::vector<PathPiece>& pieces = path.pieces();
  for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece) {
    PathPiece turned = *piece;
    turned.start =
        reversed(advance(piece->start, piece->curvature, sign(piece->gear) * piece->length));
    turned.curvature = -piece->curvature;
    back.append(turned);
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

template <class Accept>
void TurnSearch::search(const TurnEnd& a, const TurnEnd& b, TurnKinds kinds, CostRate rate,
                        Accept accept) const {
  std::vector<Candidate> heap;
  const auto add = [&](Kind kind, double out, double in) {
    const Pose2 from = forward(a.out, out);
    const Pose2 to = reversed(forward(b.out, in));
    const double least = std::max((to.position() - from.position()).norm(),
                                  radius_ * std::abs(wrap_angle(to.yaw - from.yaw)));
    heap.push_back({rate.of(out + least + in, cusps_at_least(kind)), static_cast<int>(heap.size()),
                    kind, false, Turn{out, in, {}}});
  };
  for (const LeadFamily& family : lead_families(a, b)) {
    if (family.out > a.free_run || family.in > b.free_run) continue;
    for (double t = 0.0;; t += kLeadStep) {
      const double out = std::min(family.out + t, a.free_run);
      const double in = std::min(family.in + t, b.free_run);
      if (kinds.dubins) add(Kind::kDubins, out, in);
      if (kinds.fishtail) add(Kind::kFishtail, out, in);
      if (kinds.reeds_shepp) add(Kind::kReedsShepp, out, in);
      if (out >= a.free_run && in >= b.free_run) break;
    }
  }
  std::make_heap(heap.begin(), heap.end(), costs_more);
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), costs_more);
    Candidate& next = heap.back();
    if (!next.known && resolve(next, a, b, radius_)) {
      next.cost = rate.of(next.turn.length(), next.turn.cusps());
      next.known = true;
      std::push_heap(heap.begin(), heap.end(), costs_more);
      continue;
    }
    if (next.known && accept(next.turn)) return;
    heap.pop_back();
  }
}

TurnPair TurnSearch::both_ways(const TurnEnd& a, const TurnEnd& b, TurnKinds kinds,
                               CostRate rate) const {
  TurnPair found;
  const OwnRows own{a.row, b.row};
  search(a, b, kinds, rate, [&](const Turn& turn) {
    const Pose2 from = forward(a.out, turn.lead_out);
    const auto fits = [&](Travel travel) { return space_.fits(from, turn.curve, travel, own); };
    const bool needs_forth = !found.forth;
    const bool needs_back = !found.back;
    const bool both = needs_forth && needs_back && fits(Travel::kBoth);
    if (needs_forth && (both || fits(Travel::kForth))) found.forth = turn;
    if (needs_back && (both || fits(Travel::kBack))) found.back = mirrored(turn);
    return found.forth && found.back;
  });
  return found;
}

std::optional<Turn> TurnSearch::one_track(const TurnEnd& a, const TurnEnd& b, TurnKinds kinds,
                                          CostRate rate, Travel travel) const {
  std::optional<Turn> found;
  const OwnRows own{a.row, b.row};
  search(a, b, kinds, rate, [&](const Turn& turn) {
    if (space_.fits(forward(a.out, turn.lead_out), turn.curve, travel, own)) found = turn;
    return found.has_value();
  });
  return found;
}

}  // namespace headland::coverage
