// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/internal/shorten.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace headland::roadmap {
namespace {

constexpr int kStations = 48;    // along the path, besides the cusps
constexpr double kApart = 1e-3;  // [m] between stations, at least
constexpr int kRounds = 8;
constexpr double kGain = 1e-3;    // less, relatively, is not worth a further round
constexpr double kSaving = 1e-9;  // [m] less is rounding

// How a station is best reached in one gear.
struct Arrival {
  double cost = std::numeric_limits<double>::infinity();
  int from = -1;              // station
  std::size_t from_gear = 0;  // in which it was reached
  Curve curve;                // empty: along the path itself
};
using Arrivals = std::array<Arrival, 2>;  // by gear

std::size_t index(Gear gear) { return gear == Gear::kForward ? 0 : 1; }

// Calls visit(piece) for what lies of the path between two driven distances.
template <class Visit>
void for_pieces(const Path& path, double from_s, double to_s, Visit visit) {
  double begin = 0.0;
  for (const PathPiece& piece : path.pieces()) {
    const double low = std::max(from_s - begin, 0.0);
    const double high = std::min(to_s - begin, piece.length);
    begin += piece.length;
    if (high <= low) continue;
    const Pose2 start = advance(piece.start, piece.curvature, sign(piece.gear) * low);
    visit(PathPiece{start, piece.curvature, high - low, piece.gear, 0});
  }
}

// One round: the cheapest chain from station to station, each step along the path or by a curve.
class Chain {
 public:
  Chain(const Path& path, const DriveRules& rules, const OutlineFit& fit, double phase)
      : path_(path), rules_(rules), fit_(fit) {
    place_stations(phase);
    arrivals_.resize(stations_.size());
    for (Arrival& start : arrivals_.front()) start.cost = 0.0;
  }

  Path cheapest() {
    const int last = static_cast<int>(stations_.size()) - 1;
    for (int i = 0; i < last; ++i) {
      follow_path(i);
      // The longest first: where one fits, most others need not be tried.
      for (int j = last; j > i; --j) try_joins(i, j);
    }
    return traced();
  }

 private:
  // The ends, all cusps, and between them stations in even distances, shifted by the phase.
  void place_stations(double phase) {
    s_.push_back(0.0);
    for (const PathSegment& segment : path_.segments()) s_.push_back(segment.end_s);
    const std::vector<double> borders = s_;
    for (int k = 0; k < kStations; ++k) {
      const double s = path_.length() * (k + phase) / kStations;
      const auto next = std::upper_bound(borders.begin(), borders.end(), s);
      if (next != borders.end() && *next - s > kApart && s - *std::prev(next) > kApart) {
        s_.push_back(s);
      }
    }
    std::sort(s_.begin(), s_.end());
    for (const double s : s_) stations_.push_back(path_.at(s).pose);
  }

  Arrivals& arrivals(int station) { return arrivals_[static_cast<std::size_t>(station)]; }
  double s(int station) const { return s_[static_cast<std::size_t>(station)]; }
  const Pose2& pose(int station) const { return stations_[static_cast<std::size_t>(station)]; }

  void offer(int from, int to, Gear first, Gear last, double cost, const Curve& curve) {
    const Arrivals& before = arrivals(from);
    Arrival& after = arrivals(to)[index(last)];
    std::size_t gear = index(first);
    double start = before[gear].cost;
    if (from > 0 && before[1 - gear].cost + rules_.cusp_cost < start) {
      gear = 1 - gear;
      start = before[gear].cost + rules_.cusp_cost;
    }
    if (start + cost >= after.cost - kSaving) return;
    if (curve.count() > 0 && !fit_.fits(pose(from), curve)) return;
    after = {start + cost, from, gear, curve};
  }

  void follow_path(int from) {
    double cost = 0.0;
    Gear gear = Gear::kForward;
    for_pieces(path_, s(from), s(from + 1), [&](const PathPiece& piece) {
      gear = piece.gear;
      cost += rules_.cost(CurvePiece{piece.curvature, sign(gear) * piece.length});
    });
    offer(from, from + 1, gear, gear, cost, Curve{});
  }

  void try_joins(int from, int to) {
    for (const Join& join : joins(rules_, pose(from), pose(to))) {
      offer(from, to, join.first_gear(), join.last_gear(), join.cost, join.curve);
    }
  }

  Path traced() {
    struct Step {
      int from;
      int to;
      const Curve* curve;
    };
    std::vector<Step> steps;
    int at = static_cast<int>(stations_.size()) - 1;
    const Arrivals& end = arrivals(at);
    std::size_t gear = end[1].cost < end[0].cost ? 1 : 0;
    while (at > 0) {
      const Arrival& arrival = arrivals(at)[gear];
      steps.push_back({arrival.from, at, &arrival.curve});
      at = arrival.from;
      gear = arrival.from_gear;
    }
    PathBuilder builder;
    for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
      if (step->curve->count() > 0) {
        builder.add(pose(step->from), *step->curve);
      } else {
        for_pieces(path_, s(step->from), s(step->to),
                   [&builder](const PathPiece& piece) { builder.add(piece); });
      }
    }
    return builder.path();
  }

  const Path& path_;
  const DriveRules& rules_;
  const OutlineFit& fit_;
  std::vector<double> s_;  // driven distance of the stations [m]
  std::vector<Pose2> stations_;
  std::vector<Arrivals> arrivals_;
};

}  // namespace

Path shortened(const Path& path, const DriveRules& rules, const OutlineFit& fit) {
  Path best = path;
  double cost = rules.cost(best);
  for (int round = 0; round < kRounds; ++round) {
    // Shifted stations find what the last round's could not.
    const double phase = round % 2 == 0 ? 0.0 : 0.5;
    Path next = Chain(best, rules, fit, phase).cheapest();
    const double next_cost = rules.cost(next);
    const bool worth_more = next_cost < cost * (1.0 - kGain);
    if (next_cost < cost) {
      best = std::move(next);
      cost = next_cost;
    }
    if (!worth_more && round > 0) break;
  }
  return best;
}

}  // namespace headland::roadmap
