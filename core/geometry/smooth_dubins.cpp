// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/smooth_dubins.hpp"

#include "core/geometry/dubins.hpp"
#include "core/geometry/internal/steering.hpp"

// Turns with an arc end on circles: those about the arc's centre through the turn's ends. For words
// of such turns alone there are formulas. With smaller turns the straight's heading t is the root
// of
//   f(t) = what the goal lies to the left of the straight, both turns driven,
// which falls by the straight's length and what both turns give.
namespace headland {
namespace {

using internal::kTwoPi;
using internal::Link;
using internal::positive;
using internal::UnitGoal;

constexpr int kMostSteps = 20;        // of Newton's method
constexpr double kConverged = 1e-13;  // radii
constexpr double kLeastWide = 1e-6;   // [rad]
constexpr double kLittleBack = 0.7;   // [rad] a turn by a little less than nothing

// LSL, LSR, LRL, SL or LS, and their mirror images.
enum class Word { kSameSide, kOtherSide, kThreeTurns, kWideTurn };

struct Solution {
  double length = std::numeric_limits<double>::infinity();  // in radii
  Word word = Word::kSameSide;
  bool mirrored = false;
  double first = 0.0;   // [rad]; kWideTurn: the straight before it
  double middle = 0.0;  // the straight, or the turn between
  double last = 0.0;    // [rad]; kWideTurn: the straight after it
  double wide = 1.0;    // kWideTurn: radius of its arc
};

// What is left of a full circle after a turn by a little less than nothing.
double without_full_circle(double angle) { return angle > kTwoPi - kLittleBack ? 0.0 : angle; }

// The words that begin with a turn to the left.
class LeftWords {
 public:
  LeftWords(const SmoothTurn& turn, const UnitGoal& goal, bool mirrored, Solution& best)
      : turn_(turn),
        goal_(mirrored ? internal::mirrored(goal) : goal),
        mirrored_(mirrored),
        best_(best) {}

  // LSL: w = (p + 2 X) e^(i t), t + q = phi or a full circle more.
  void same_side() {
    double total = positive(goal_.phi);
    if (kTwoPi - total <= internal::kReachTolerance) total = 0.0;
    if (total >= best_.length) return;
    const Link w = to_left();
    const double straight = not_negative(std::sqrt(w.squared) - 2.0 * turn_.ahead());
    const double t = positive(std::atan2(w.v, w.u));
    const double with_arc = turn_.least_with_arc();
    if (t >= with_arc && t <= total - with_arc) {
      if (straight >= 0.0) {
        offer(Word::kSameSide, t, straight, total - t);
      } else {
        wide_turn(total);
      }
      return;
    }
    const double outside = 0.5 * (kTwoPi - total);
    const double start = t <= total ? t : t - total < outside ? total : 0.0;
    if (refine(1.0, total, start)) return;
    if (straight < 0.0 && wide_turn(total)) return;
    if (total + kTwoPi >= best_.length) return;
    const double last = total + kTwoPi - t;
    if (t >= with_arc && last >= with_arc) {
      if (straight >= 0.0) offer(Word::kSameSide, t, straight, last);
    } else if (!refine(1.0, total + kTwoPi, t) && straight >= 0.0) {
      offer(Word::kSameSide, raised(t), straight, raised(positive(last)));
    }
  }

  // LSR: w = ((p + 2 X) - 2 i Y) e^(i t), q = t - phi.
  void other_side() {
    if (std::abs(goal_.phi) >= best_.length) return;
    const Link w = to_right();
    const double aside = 2.0 * turn_.aside();
    const double ahead = 2.0 * turn_.ahead();
    const double slack = 4.0 * goal_.tolerance;  // circles that overlap by the tolerance do touch
    if (w.squared < ahead * ahead + aside * aside - slack) {
      other_side_from_nothing();
      return;
    }
    const double along = std::max(ahead, std::sqrt(std::max(w.squared - aside * aside, 0.0)));
    const double straight = along - ahead;
    const double t = positive(std::atan2(w.v * along + aside * w.u, w.u * along - aside * w.v));
    const double q = positive(t - goal_.phi);
    const double with_arc = turn_.least_with_arc();
    if (t >= with_arc && q >= with_arc) {
      offer(Word::kOtherSide, t, straight, q);
      return;
    }
    const double first = without_full_circle(t);
    const double last = without_full_circle(q);
    const double total = first - last;
    // One of the two is small; then the other tells the total.
    const double full = kTwoPi * std::round((total - goal_.phi) / kTwoPi);
    if (refine(-1.0, goal_.phi + full, first) || other_side_from_nothing()) return;
    offer(Word::kOtherSide, raised(t), straight, raised(q));
  }

  // LRL: the middle circle at 2 R from both others, R = |X + i Y|.
  void three_turns() {
    const Link w = to_left();
    const double x = turn_.ahead();
    const double y = turn_.aside();
    const double reach = 4.0 * std::sqrt(x * x + y * y);
    const double distance = std::sqrt(w.squared);
    if (distance > reach + goal_.tolerance) return;
    const double aside = 0.5 * kPi - std::atan2(x, y);
    const double bearing = std::atan2(w.v, w.u);
    const double half = std::acos(std::min(distance / reach, 1.0));
    for (const double side : {1.0, -1.0}) {
      const double out = bearing + side * half + aside;   // heading between the first turns
      const double back = bearing - side * half - aside;  // and between the last
      three_turns(positive(out), positive(out - back), positive(goal_.phi - back));
    }
  }

 private:
  double not_negative(double straight) const {
    return straight < 0.0 && straight >= -goal_.tolerance ? 0.0 : straight;
  }

  Link to_left() const { return internal::left_to_left(goal_, turn_.ahead(), turn_.aside()); }
  Link to_right() const { return internal::left_to_right(goal_, turn_.ahead(), turn_.aside()); }

  // Where two turns to the same side leave no room for a straight between: one turn by all of it
  // with a wider arc, and a straight before it or after it.
  bool wide_turn(double total) {
    if (!(total > kLeastWide)) return false;
    const double sine = std::sin(0.5 * total);
    const double cosine = std::cos(0.5 * total);
    const double before = goal_.y / sine;  // the chord, if the straight comes before
    const double after = (goal_.x * goal_.sin_phi - goal_.y * goal_.cos_phi) / sine;
    const bool first = goal_.x - before * cosine >= 0.0;
    const double chord = first ? before : after;
    const double straight =
        not_negative(first ? goal_.x - before * cosine
                           : goal_.x * goal_.cos_phi + goal_.y * goal_.sin_phi - after * cosine);
    if (straight < 0.0) return false;
    const double wide = widened(total, chord);
    if (!(wide >= 1.0)) return false;
    const double length = straight + wide * total + turn_.ramp() / wide;
    if (length >= best_.length) return true;
    best_ = {length, Word::kWideTurn,        mirrored_, first ? straight : 0.0,
             total,  first ? 0.0 : straight, wide};
    return true;
  }

  double wide_chord(double total, double wide) const {
    return wide * SmoothTurn({1.0 / wide, 1.0 / turn_.ramp()}).shape(total).chord;
  }

  // The radius of a turn with a chord, by the secant method: the one grows almost evenly with the
  // other. 0: none.
  double widened(double total, double chord) const {
    double a = std::max(1.0, std::sqrt(turn_.ramp() / total));
    double error_a = wide_chord(total, a) - chord;
    if (error_a > 0.5 * goal_.tolerance) return 0.0;
    if (error_a >= -kConverged) return a;
    double b = a - error_a / std::sin(0.5 * total);
    for (int i = 0; i < kMostSteps; ++i) {
      const double error = wide_chord(total, b) - chord;
      if (std::abs(error) <= 4.0 * kConverged * chord) return b;
      const double next = b - error * (b - a) / (error - error_a);
      if (!(next >= 1.0)) return 0.0;
      a = b;
      error_a = error;
      b = next;
    }
    return 0.0;
  }

  // From a first or a last turn of nothing.
  bool other_side_from_nothing() {
    const double other = goal_.phi - std::copysign(kTwoPi, goal_.phi);
    const bool found = refine(-1.0, goal_.phi, std::max(goal_.phi, 0.0));
    return refine(-1.0, other, std::max(other, 0.0)) || found;
  }

  // The least turn that has an arc and ends alike.
  double raised(double angle) const {
    while (angle < turn_.least_with_arc()) angle += kTwoPi;
    return angle;
  }

  void offer(Word word, double first, double middle, double last) {
    double length = turn_.length(first) + turn_.length(last);
    length += word == Word::kThreeTurns ? turn_.length(middle) : middle;
    if (length < best_.length) best_ = {length, word, mirrored_, first, middle, last, 1.0};
  }

  // Words with a straight, the turns of which differ (side = -1) or add up (1) to `total`.
  bool refine(double side, double total, double start) {
    const double low = side > 0.0 ? 0.0 : std::max(0.0, total);
    const double high = side > 0.0 ? total : kTwoPi + std::min(0.0, total);
    if (side < 0.0 && std::abs(total) >= best_.length) return false;
    double t = std::clamp(start, low, high);
    double error = std::numeric_limits<double>::infinity();
    double straight = 0.0;
    for (int i = 0; i < kMostSteps; ++i) {
      const double q = side * (total - t);
      const SmoothTurn::Shape first = turn_.shape(t);
      const SmoothTurn::Shape last = turn_.shape(std::max(q, 0.0));
      const double c = first.cosine * first.cosine - first.sine * first.sine;
      const double s = 2.0 * first.sine * first.cosine;
      error = goal_.y * c - goal_.x * s + first.across() - side * last.across();
      straight = goal_.x * c + goal_.y * s - first.along() - last.along();
      const double slope = straight + first.give() + last.give();
      if (std::abs(error) <= kConverged) break;
      if (!(slope > 0.0)) return false;
      const double next = std::clamp(t + error / slope, low, high);
      if (next == t) break;
      t = next;
    }
    // At a border of the turns, and of the straight, by no more than the answer may miss the goal.
    if (!(std::abs(error) <= 0.5 * goal_.tolerance && straight >= -0.5 * goal_.tolerance)) {
      return false;
    }
    offer(side > 0.0 ? Word::kSameSide : Word::kOtherSide, t, std::max(straight, 0.0),
          std::max(side * (total - t), 0.0));
    return true;
  }

  void three_turns(double first, double middle, double last) {
    const double with_arc = turn_.least_with_arc();
    if (first >= with_arc && middle >= with_arc && last >= with_arc) {
      offer(Word::kThreeTurns, first, middle, last);
      return;
    }
    if (without_full_circle(first) + without_full_circle(middle) + without_full_circle(last) >=
        best_.length) {
      return;
    }
    if (refine_three(without_full_circle(first), without_full_circle(middle),
                     without_full_circle(last))) {
      return;
    }
    offer(Word::kThreeTurns, raised(first), raised(middle), raised(last));
  }

  // Newton's method on the end's place over the first two turns; the last makes up the heading.
  bool refine_three(double first, double middle, double last) {
    const double sum =
        goal_.phi + kTwoPi * std::round((first - middle + last - goal_.phi) / kTwoPi);
    constexpr double kLeast = 1e-3;  // [rad] a start from which small turns can grow
    first = std::max(first, kLeast);
    middle = std::max(middle, kLeast);
    last = sum - first + middle;
    if (last < kLeast) {
      middle += kLeast - last;
      last = kLeast;
    }
    for (int i = 0; i < kMostSteps; ++i) {
      const Point2 error = end_of_three(first, middle, last) - Point2(goal_.x, goal_.y);
      if (error.cwiseAbs().maxCoeff() <= 4.0 * kConverged) {
        offer(Word::kThreeTurns, first, middle, last);
        return true;
      }
      const double determinant = by_first_.x() * by_middle_.y() - by_first_.y() * by_middle_.x();
      if (!(std::abs(determinant) > 1e-12)) return false;
      double more = -(error.x() * by_middle_.y() - error.y() * by_middle_.x()) / determinant;
      double more_middle = -(by_first_.x() * error.y() - by_first_.y() * error.x()) / determinant;
      // No turn shrinks by more than most of it: chords grow with the root of small angles.
      const double more_last = more_middle - more;
      double part = 1.0;
      for (const auto& [angle, change] :
           {std::pair(first, more), std::pair(middle, more_middle), std::pair(last, more_last)}) {
        if (angle + part * change < 0.2 * angle) part = -0.8 * angle / change;
        if (angle + part * change > kTwoPi) part = std::max(0.0, (kTwoPi - angle) / change);
      }
      if (part < 1e-3) return false;
      first += part * more;
      middle += part * more_middle;
      last = sum - first + middle;
    }
    return false;
  }

  // Where three turns end, and its derivatives.
  Point2 end_of_three(double first, double middle, double last) {
    const SmoothTurn::Shape a = turn_.shape(first);
    const SmoothTurn::Shape b = turn_.shape(middle);
    const SmoothTurn::Shape c = turn_.shape(last);
    const auto towards = [](double yaw) { return Point2(std::cos(yaw), std::sin(yaw)); };
    const auto left = [](const Point2& p) { return Point2(-p.y(), p.x()); };
    const Point2 u(a.cosine, a.sine);
    const Point2 v = towards(first - 0.5 * middle);
    const Point2 w = towards(first - middle + 0.5 * last);
    // By `first`, `last` falls by as much, and by `middle` it grows.
    by_first_ = a.slope * u + 0.5 * a.chord * left(u) + b.chord * left(v) - c.slope * w +
                0.5 * c.chord * left(w);
    by_middle_ = b.slope * v - 0.5 * b.chord * left(v) + c.slope * w - 0.5 * c.chord * left(w);
    return a.chord * u + b.chord * v + c.chord * w;
  }

  const SmoothTurn& turn_;
  UnitGoal goal_;
  bool mirrored_;
  Solution& best_;
  Point2 by_first_{0.0, 0.0};
  Point2 by_middle_{0.0, 0.0};
};

Solution solve(const SmoothTurn& turn, const UnitGoal& goal) {
  Solution best;
  LeftWords left(turn, goal, false, best);
  LeftWords right(turn, goal, true, best);
  left.other_side();
  right.other_side();
  left.same_side();
  right.same_side();
  left.three_turns();
  right.three_turns();
  return best;
}

}  // namespace

Curve smooth_dubins(const Pose2& from, const Pose2& to, const SmoothTurn& turn) {
  if (!turn.has_ramps()) return shortest_dubins(from, to, turn.radius());
  const UnitGoal goal = internal::unit_goal(from, to, turn.radius());
  const Solution found = solve(turn, goal);
  const double hand = found.mirrored ? -1.0 : 1.0;
  const double rounding = 0.5 * goal.tolerance / (found.length + 2.0);
  Curve curve;
  if (found.word == Word::kWideTurn) {
    const SmoothTurn wide({1.0 / (found.wide * turn.radius()), turn.sharpness()});
    if (found.first > rounding) curve.add({0.0, found.first * turn.radius()});
    wide.append(curve, found.middle, hand, rounding);
    if (found.last > rounding) curve.add({0.0, found.last * turn.radius()});
    return curve;
  }
  turn.append(curve, found.first, hand, rounding);
  if (found.word == Word::kThreeTurns) {
    turn.append(curve, found.middle, -hand, rounding);
  } else if (found.middle > rounding) {
    curve.add({0.0, found.middle * turn.radius()});
  }
  turn.append(curve, found.last, found.word == Word::kOtherSide ? -hand : hand, rounding);
  return curve;
}

double smooth_dubins_length(const Pose2& from, const Pose2& to, const SmoothTurn& turn) {
  if (!turn.has_ramps()) return dubins_length(from, to, turn.radius());
  return turn.radius() * solve(turn, internal::unit_goal(from, to, turn.radius())).length;
}

}  // namespace headland
