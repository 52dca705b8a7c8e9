// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/internal/turn.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "core/geometry/dubins.hpp"
#include "core/geometry/fishtail.hpp"
#include "core/geometry/reeds_shepp.hpp"
#include "core/geometry/smooth_dubins.hpp"
#include "core/geometry/three_point.hpp"
#include "core/model/steering_rate.hpp"

namespace headland::coverage {
namespace {

enum class Kind { kDubins, kFishtail, kReedsShepp, kThreePointLeft, kThreePointRight };

constexpr int kMostTests = 400;   // of one search
constexpr double kSliver = 1e-9;  // [m] shorter pieces are rounding

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

// A ramp from the limit to straight wheels, centred at a step of the curvature, leaves the way by
// this much where the steering is that sharp; less is not worth a clothoid [m].
constexpr double kLeastStepError = 0.001;
constexpr double kPaces[] = {1.0, 0.6, 0.35};  // of the leg's speed

// A turn's place in the order of costs. For each line of leads and kind the next step waits until
// this one has come up; a bound becomes one for each pace, then the cost.
struct Candidate {
  enum class Stage { kBound, kPace, kCost };
  double cost = 0.0;  // a lower bound before kCost
  int line = 0;       // of leads that grow together; settles ties
  int steps = 0;      // of growth
  Kind kind = Kind::kDubins;
  int pace = 0;
  Stage stage = Stage::kBound;
};

// Of a heap with the cheapest on top.
struct CostsMore {
  bool operator()(const Candidate& a, const Candidate& b) const {
    if (a.cost != b.cost) return a.cost > b.cost;
    return std::tie(a.line, a.steps, a.kind, a.pace) > std::tie(b.line, b.steps, b.kind, b.pace);
  }
};

// One search between two ends.
class Search {
 public:
  Search(const FreeSpace& space, const TurnEnd& from, const TurnEnd& to,
         const TurnSteering& steering, CostRate rate, const std::vector<TurnPace>& paces)
      : space_(space),
        from_(from),
        to_(to),
        steering_(steering),
        rate_(rate),
        paces_(paces),
        firsts_(first_leads(from, to, space.outline())),
        apart_(to.out.position() - from.out.position()),
        heading_out_(from.out.heading()),
        heading_in_(to.out.heading()),
        turning_(steering.plain.turn.radius() *
                 std::abs(wrap_angle(to.out.yaw + kPi - from.out.yaw))) {}

  std::optional<Turn> run(TurnKinds kinds) {
    // Reeds-Shepp curves have steps of the curvature inside a gear.
    const bool plain = !paces_.front().turn.has_ramps();
    for (int line = 0; line < static_cast<int>(firsts_.size()); ++line) {
      if (kinds.dubins) push_bound(line, 0, Kind::kDubins);
      if (kinds.fishtail) push_bound(line, 0, Kind::kFishtail);
      if (!kinds.reeds_shepp) continue;
      push_bound(line, 0, Kind::kThreePointLeft);
      push_bound(line, 0, Kind::kThreePointRight);
      if (plain) push_bound(line, 0, Kind::kReedsShepp);
    }
    int tests = 0;
    while (!heap_.empty() && tests < kMostTests) {
      std::pop_heap(heap_.begin(), heap_.end(), CostsMore());
      const Candidate next = heap_.back();
      heap_.pop_back();
      if (next.stage == Candidate::Stage::kBound) {
        push_bound(next.line, next.steps + 1, next.kind);
        push_paces(next);
      } else if (next.stage == Candidate::Stage::kPace) {
        push_cost(next);
      } else {
        ++tests;
        std::optional<Turn> turn = resolve(next, pace(next));
        if (turn && fits(*turn)) {
          compare_with_plain(next, *turn);
          return turn;
        }
      }
    }
    return std::nullopt;
  }

 private:
  const TurnPace& pace(const Candidate& c) const {
    return paces_[static_cast<std::size_t>(c.pace)];
  }

  // Where the curve begins and ends.
  Pose2 first_pose(const Leads& lead) const {
    const Point2 p = from_.out.position() + lead.out * heading_out_;
    return {p.x(), p.y(), from_.out.yaw};
  }
  Pose2 last_pose(const Leads& lead) const {
    const Point2 p = to_.out.position() + lead.in * heading_in_;
    return reversed({p.x(), p.y(), to_.out.yaw});
  }

  void push(const Candidate& candidate) {
    heap_.push_back(candidate);
    std::push_heap(heap_.begin(), heap_.end(), CostsMore());
  }

  bool ended(int line, int steps) const {
    const Leads& first = firsts_[static_cast<std::size_t>(line)];
    const double grown = steps * TurnSearch::kLeadStep;
    return steps > 0 && first.out + grown > from_.free_run && first.in + grown > to_.free_run;
  }

  Leads leads(int line, int steps) const {
    const Leads& first = firsts_[static_cast<std::size_t>(line)];
    const double grown = steps * TurnSearch::kLeadStep;
    return {std::min(first.out + grown, from_.free_run), std::min(first.in + grown, to_.free_run)};
  }

  // From the end of one lead to that of the other.
  Point2 between(const Leads& lead) const {
    return apart_ + lead.in * heading_in_ - lead.out * heading_out_;
  }

  // Growing both leads by a step never lowers the bound: it lengthens them by as much as it can
  // bring their ends together. So a line's next candidate may wait until this one has come up.
  void push_bound(int line, int steps, Kind kind) {
    if (ended(line, steps)) return;
    const Leads lead = leads(line, steps);
    const double least = std::max(between(lead).norm(), turning_);
    push({rate_.of(lead.out + least + lead.in, cusps_at_least(kind)), line, steps, kind, 0,
          Candidate::Stage::kBound});
  }

  // Between the arcs' centres of a first and a last turn to the same side.
  double centres_apart(const Leads& lead, const SmoothTurn& turn, double hand) const {
    const Point2 sum = heading_out_ - heading_in_;  // of the headings at both ends of the curve
    const Point2 change = -heading_in_ - heading_out_;
    const Point2 apart = between(lead) - turn.radius() * turn.ahead() * sum +
                         hand * turn.radius() * turn.aside() * Point2(-change.y(), change.x());
    return apart.norm();
  }

  // Bounds for each pace. No curve is shorter than Dubins'; a manoeuvre with cusps has two whole
  // clothoids, each longer by half than the arc that it stands for.
  void push_paces(Candidate candidate) {
    if (!paces_.front().turn.has_ramps()) {
      push_cost(candidate);
      return;
    }
    const Leads lead = leads(candidate.line, candidate.steps);
    const double radius = steering_.plain.turn.radius();
    const double dubins = candidate.kind == Kind::kDubins
                              ? dubins_length(first_pose(lead), last_pose(lead), radius)
                              : 0.0;
    candidate.stage = Candidate::Stage::kPace;
    for (candidate.pace = 0; candidate.pace < static_cast<int>(paces_.size()); ++candidate.pace) {
      const TurnPace& at = pace(candidate);
      double least = dubins;
      double lost = at.cusped_lost_s;
      if (candidate.kind == Kind::kDubins) {
        // A straight has no clothoid to slow down on, and two that make a wide turn are shorter.
        const bool whole = turning_ >= radius * std::max(0.5 * kPi, at.turn.least_with_arc());
        lost = whole ? at.turned_lost_s : turning_ > kSliver ? at.least_lost_s : 0.0;
      } else if (candidate.kind == Kind::kFishtail) {
        least = turning_ + radius * at.turn.ramp() +
                std::min(centres_apart(lead, at.turn, 1.0), centres_apart(lead, at.turn, -1.0));
      } else {
        const double hand = candidate.kind == Kind::kThreePointLeft ? 1.0 : -1.0;
        if (centres_apart(lead, at.turn, hand) >= 4.0 * radius) continue;
        least = std::max(between(lead).norm(), turning_ + radius * at.turn.ramp());
      }
      candidate.cost = rate_.of(lead.out + least + lead.in, cusps_at_least(candidate.kind), lost);
      push(candidate);
    }
  }

  void push_cost(Candidate candidate) {
    const std::optional<Turn> turn = resolve(candidate, pace(candidate));
    if (!turn) return;
    candidate.cost = rate_.of(turn->length(), turn->cusps(), turn->lost_s);
    candidate.stage = Candidate::Stage::kCost;
    push(candidate);
  }

  bool fits(const Turn& turn) const {
    return space_.fits(forward(from_.out, turn.lead_out), turn.curve, Travel::kForth,
                       {from_.row, to_.row});
  }

  // The candidate's turn, if there is one of its kind.
  std::optional<Turn> resolve(const Candidate& candidate, const TurnPace& pace) const {
    const Leads lead = leads(candidate.line, candidate.steps);
    const Pose2 from = first_pose(lead);
    const Pose2 to = last_pose(lead);
    std::optional<Curve> curve;
    switch (candidate.kind) {
      case Kind::kDubins:
        curve = without_slivers(smooth_dubins(from, to, pace.turn));
        break;
      case Kind::kReedsShepp:
        curve = without_slivers(shortest_reeds_shepp(from, to, pace.turn.radius()));
        break;
      case Kind::kFishtail:
        curve = fishtail(from, to, pace.turn);
        break;
      case Kind::kThreePointLeft:
      case Kind::kThreePointRight:
        curve = three_point_turn(from, to, pace.turn,
                                 candidate.kind == Kind::kThreePointLeft ? 1.0 : -1.0);
    }
    if (!curve) return std::nullopt;
    Turn turn{lead.out, lead.in, *curve, 0.0, 0.0};
    // Without a cusp the Dubins curve is the same.
    if (candidate.kind == Kind::kReedsShepp && turn.cusps() == 0) return std::nullopt;
    if (pace.slows_down && steering_.vehicle) {
      turn.lost_s = slow_down_time(*steering_.vehicle, *curve, steering_.speed);
    }
    return turn;
  }

  void compare_with_plain(const Candidate& candidate, Turn& turn) const {
    if (!pace(candidate).turn.has_ramps()) return;
    const std::optional<Turn> plain = resolve(candidate, steering_.plain);
    if (plain) turn.smoothing_m = std::max(0.0, turn.length() - plain->length());
  }

  const FreeSpace& space_;
  const TurnEnd& from_;
  const TurnEnd& to_;
  const TurnSteering& steering_;
  CostRate rate_;
  const std::vector<TurnPace>& paces_;
  std::vector<Leads> firsts_;
  Point2 apart_;
  Point2 heading_out_;
  Point2 heading_in_;
  double turning_;
  std::vector<Candidate> heap_;
};

}  // namespace

CostRate cost_rate(const Vehicle& vehicle, LegKind kind, const CostWeights& objective) {
  return {drive_cost(vehicle, kind, 1.0, 0).value(objective),
          drive_cost(vehicle, kind, 0.0, 1).value(objective),
          standing_cost(vehicle, 1.0).value(objective)};
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
    back.add({-piece.end_curvature(), piece.length, piece.sharpness});
  }
  return back;
}

int Turn::cusps() const {
  if (curve.count() == 0) return 0;
  return curve.cusps() + (curve.begin()->length < 0.0 ? 1 : 0) +
         ((curve.end() - 1)->length < 0.0 ? 1 : 0);
}

Turn mirrored(const Turn& turn) {
  return {turn.lead_in, turn.lead_out, mirrored(turn.curve), turn.lost_s, turn.smoothing_m};
}

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

TurnSearch::TurnSearch(const FreeSpace& space, const Vehicle& vehicle, double speed)
    : TurnSearch(space, vehicle.turning_radius()) {
  steering_.vehicle = vehicle;
  steering_.speed = speed;
  const double curvature = 1.0 / vehicle.turning_radius();
  const double ramp = curvature / sharpness_limit(vehicle, speed);
  if (curvature * ramp * ramp / 24.0 < kLeastStepError) return;
  for (const double part : kPaces) {
    const SmoothTurn turn({curvature, sharpness_limit(vehicle, part * speed)});
    const double less = (1.0 - part) * speed;
    const double braking = less * less / (speed * vehicle.acceleration_mps2);
    const double slow = 2.0 * turn.ramp() * turn.radius() * (1.0 / part - 1.0) / speed;
    steering_.smooth.push_back(
        {turn, braking, braking + slow / (1.0 + turn.ramp()), braking + slow, part < 1.0});
    // Only steered vehicles slow down on clothoids.
    if (vehicle.steering != Steering::kAckermann) break;
  }
}

std::optional<Turn> TurnSearch::find(const TurnEnd& from, const TurnEnd& to, TurnKinds kinds,
                                     CostRate rate) const {
  if (!steering_.smooth.empty()) {
    Search smooth(space_, from, to, steering_, rate, steering_.smooth);
    if (const std::optional<Turn> turn = smooth.run(kinds)) return turn;
  }
  const std::vector<TurnPace> plain{steering_.plain};
  return Search(space_, from, to, steering_, rate, plain).run(kinds);
}

}  // namespace headland::coverage
