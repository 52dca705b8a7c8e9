// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/reeds_shepp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/geometry/internal/steering.hpp"

// Reeds and Shepp 1990, section 8, formulas 8.1 to 8.11 in the notation of steering.hpp: t, u and v
// are the first turn, the middle (turn or straight) and the last turn, signed, in radii.
//
// Mirroring (y, phi -> -y, -phi), flipping time (x, phi -> -x, -phi) and driving backwards through
// the word make 48 words of these. Flipping time turns a link (a, b) into (-a, b), so what depends
// on its length alone serves both gears. The turns of a word add up to the goal's heading, which
// bounds its length from below; with this and the sign of the first turn's sine most words are
// dismissed before an arc tangent is taken. The words of three pieces come first: they win most.
namespace headland {
namespace {

using internal::Link;
using internal::UnitGoal;

constexpr double kEps = 1e-12;  // [rad] by which a turn may have the wrong sign; see add_piece
constexpr double kQuarter = 0.5 * kPi;

enum class Word {
  kLsl,
  kLsr,
  kLrl,
  kLrlBack,
  kLrlrOpposite,
  kLrlrSame,
  kLrsl,
  kLrsr,
  kLrslBack,
  kLrsrBack,
  kLrslr
};

// The pieces of each word, and where their lengths come from: t, u, v, n = -u, q = a quarter turn
// in reverse. Words "back" are driven from the goal's end.
struct Shape {
  std::string_view turns;
  std::string_view lengths;
};
constexpr Shape kShapes[] = {{"LSL", "tuv"},   {"LSR", "tuv"},    {"LRL", "tuv"},
                             {"LRL", "vut"},   {"LRLR", "tunv"},  {"LRLR", "tuuv"},
                             {"LRSL", "tquv"}, {"LRSR", "tquv"},  {"LSRL", "vuqt"},
                             {"RSRL", "vuqt"}, {"LRSLR", "tquqv"}};

// One of the four images of the problem.
struct Image {
  double flip = 1.0;    // -1: time flipped
  double mirror = 1.0;  // -1: mirrored
  double phi = 0.0;
  double sin_phi = 0.0;
  double cos_phi = 1.0;
};

struct Solution {
  double length = std::numeric_limits<double>::infinity();
  Word word = Word::kLsl;
  double flip = 1.0;
  double mirror = 1.0;
  double t = 0.0;
  double u = 0.0;
  double v = 0.0;
};

// An angle by a vector in its direction, for its sign and bounds to be known before it is.
struct Direction {
  double x = 1.0;
  double y = 0.0;

  double slack() const { return kEps * (std::abs(x) + std::abs(y)); }
  /// May the angle lie in [0, pi]?
  bool left() const { return y >= -slack(); }
  /// May the angle less phi lie in [0, pi]; in [-pi, 0]?
  bool left_of(const Image& i) const { return y * i.cos_phi - x * i.sin_phi >= -slack(); }
  /// The same for the angle and a quarter turn, less phi.
  bool quarter_left_of(const Image& i) const { return x * i.cos_phi + y * i.sin_phi >= -slack(); }
  bool quarter_right_of(const Image& i) const { return x * i.cos_phi + y * i.sin_phi <= slack(); }
  double angle() const {
    const double a = std::atan2(y, x);
    return a < kEps - kPi ? a + internal::kTwoPi : a;
  }
};

/// Wraps an angle in [-4 pi, 4 pi] to (-pi, pi], with half a turn and a trifle more counted as
/// left.
double wrap(double angle) {
  while (angle > kPi + kEps) angle -= internal::kTwoPi;
  while (angle < kEps - kPi) angle += internal::kTwoPi;
  return angle;
}

class Search {
 public:
  explicit Search(const UnitGoal& goal)
      : tolerance_(goal.tolerance),
        abs_phi_(std::abs(goal.phi)),
        quarter_rest_(std::abs(abs_phi_ - kQuarter)) {
    const double s = goal.sin_phi;
    const double c = goal.cos_phi;
    // The goal's view of the start, for words driven backwards.
    UnitGoal back = goal;
    back.x = goal.x * c + goal.y * s;
    back.y = goal.x * s - goal.y * c;
    sides_[0] = {arm(internal::left_to_left(goal)), arm(internal::left_to_right(goal)),
                 arm(internal::left_to_left(back)), arm(internal::left_to_right(back))};
    sides_[1] = {
        arm(internal::mirrored_right_to_right(goal)), arm(internal::mirrored_right_to_left(goal)),
        arm(internal::mirrored_right_to_right(back)), arm(internal::mirrored_right_to_left(back))};
    for (int k = 0; k < 4; ++k) {
      const double flip = k % 2 == 0 ? 1.0 : -1.0;
      const double mirror = k < 2 ? 1.0 : -1.0;
      images_[k] = {flip, mirror, flip * mirror * goal.phi, flip * mirror * s, c};
    }
  }

  Solution shortest() {
    for (int k = 0; k < 4; k += 2) limits(sides_[k / 2], images_[k]);
    for (int k = 0; k < 4; ++k) {
      const Side& side = sides_[k / 2];
      const Image& image = images_[k];
      lsl(side.same, image);
      lsr(side.other, image);
    }
    for (int k = 0; k < 4; ++k) {
      const Side& side = sides_[k / 2];
      const Image& image = images_[k];
      lrl(side.same, image, Word::kLrl);
      lrl(side.back_same, image, Word::kLrlBack);
      lrsr(side.other, image, Word::kLrsr);
      lrsr(side.back_other, image, Word::kLrsrBack);
      lrsl(side.same, image, Word::kLrsl);
      lrsl(side.back_same, image, Word::kLrslBack);
      lrslr(side.other, image);
      lrlr_same(side.other, image);
      lrlr_opposite(side.other, image);
    }
    return best_;
  }

 private:
  // A link between circles and what depends on its length.
  struct Arm {
    double a = 0.0;
    double b = 0.0;
    double rho = 0.0;
    double tangent = -1.0;  // of the crossed tangent of the two circles; -1: they overlap
  };
  struct Side {
    Arm same;
    Arm other;
    Arm back_same;
    Arm back_other;
  };

  static Arm arm(const Link& w) {
    const double excess = w.squared - 4.0;
    return {w.u, w.v, std::sqrt(w.squared),
            excess < -4.0 * kEps ? -1.0 : std::sqrt(std::max(0.0, excess))};
  }

  bool hopeless(double bound) const { return bound >= best_.length; }

  void offer(const Image& i, Word word, double t, double u, double v, double length) {
    if (length < best_.length) best_ = {length, word, i.flip, i.mirror, t, u, v};
  }

  // One arc, and two arcs in either gear, where the circles coincide or touch within the tolerance:
  // the last digits of a goal must not make a manoeuvre of cusps out of them.
  void limits(const Side& side, const Image& i) {
    if (side.same.rho <= tolerance_) offer(i, Word::kLsl, 0.0, 0.0, i.phi, abs_phi_);
    if (std::abs(side.other.rho - 2.0) > tolerance_) return;
    const double t = std::atan2(side.other.a, -side.other.b);
    const double v = wrap(t - i.phi);
    offer(i, Word::kLsr, t, 0.0, v, std::abs(t) + std::abs(v));
  }

  // 8.1, L+S+L+: w = u e^(i t), t + v = phi.
  void lsl(const Arm& w, const Image& i) {
    if (hopeless(w.rho + abs_phi_)) return;
    const Direction first = w.rho < kEps ? Direction{} : Direction{i.flip * w.a, w.b};
    if (!first.left()) return;
    const double t = first.angle();
    const double v = wrap(i.phi - t);
    if (t >= -kEps && v >= -kEps) offer(i, Word::kLsl, t, w.rho, v, t + w.rho + v);
  }

  // 8.2, L+S+R+: w = e^(i t) (u - 2 i), t - v = phi.
  void lsr(const Arm& w, const Image& i) {
    const double u = w.tangent;
    if (u < 0.0 || hopeless(u + abs_phi_)) return;
    const double a = i.flip * w.a;
    const Direction first{a * u - 2.0 * w.b, 2.0 * a + w.b * u};
    if (!first.left() || !first.left_of(i)) return;
    const double t = first.angle();
    const double v = wrap(t - i.phi);
    if (t >= -kEps && v >= -kEps) offer(i, Word::kLsr, t, u, v, t + u + v);
  }

  // 8.3 and 8.4, L+R-L+ and L+R-L-: w = -4 sin(-u / 2) e^(i (t - u / 2)), t - u + v = phi.
  void lrl(const Arm& w, const Image& i, Word word) {
    if (w.rho > 4.0 + kEps || hopeless(std::max(0.5 * w.rho, abs_phi_))) return;
    const double s = std::min(1.0, 0.25 * w.rho);
    const double c = std::sqrt((1.0 - s) * (1.0 + s));
    const double a = i.flip * w.a;
    const Direction first{-a * c - w.b * s, a * s - w.b * c};
    if (!first.left()) return;
    const double u = -2.0 * std::atan2(s, c);
    if (hopeless(-u + std::abs(wrap(i.phi + u)))) return;
    const double t = first.angle();
    const double v = wrap(i.phi - t + u);
    if (t >= -kEps) offer(i, word, t, u, v, t - u + std::abs(v));
  }

  // 8.7, L+R+L-R-: |w| = 4 cos(u) - 2, t - 2 u - v = phi.
  void lrlr_opposite(const Arm& w, const Image& i) {
    if (w.rho > 2.0 + kEps) return;
    const double c = std::min(1.0, 0.25 * (2.0 + w.rho));
    const double s = std::sqrt((1.0 - c) * (1.0 + c));
    if (hopeless(2.0 * s)) return;
    const double a = i.flip * w.a;
    const Direction first{-a * s - w.b * c, a * c - w.b * s};
    if (!first.left()) return;
    const double u = std::atan2(s, c);
    const double t = first.angle();
    const double v = -wrap(i.phi + 2.0 * u - t);
    if (t >= -kEps && v <= kEps) {
      offer(i, Word::kLrlrOpposite, t, u, v, t + 2.0 * u - v);
    }
  }

  // 8.8, L+R-L-R+: |w|^2 = 20 - 16 cos(u), t - v = phi.
  void lrlr_same(const Arm& w, const Image& i) {
    const double c = (20.0 - w.rho * w.rho) / 16.0;
    if (c < -kEps || c > 1.0 + kEps) return;
    const double s = -std::sqrt(std::max(0.0, (1.0 - c) * (1.0 + c)));
    if (hopeless(abs_phi_ - 2.0 * s)) return;
    const double a = i.flip * w.a;
    const Direction first{a * s + w.b * (c - 2.0), w.b * s - a * (c - 2.0)};
    if (!first.left() || !first.left_of(i)) return;
    const double u = std::atan2(s, c);
    const double t = first.angle();
    const double v = wrap(t - i.phi);
    if (t >= -kEps && v >= -kEps) offer(i, Word::kLrlrSame, t, u, v, t - 2.0 * u + v);
  }

  // 8.9, L+R-S-L-: w = e^(i t) (-2 - i (2 - u)), t + pi / 2 + v = phi.
  void lrsl(const Arm& w, const Image& i, Word word) {
    const double u = 2.0 - w.tangent;
    if (u > kEps || hopeless(kQuarter - u + quarter_rest_)) return;
    const double a = i.flip * w.a;
    const Direction first{-2.0 * a - w.b * w.tangent, a * w.tangent - 2.0 * w.b};
    if (!first.left() || !first.quarter_left_of(i)) return;
    const double t = first.angle();
    const double v = -wrap(t + kQuarter - i.phi);
    if (t >= -kEps && v <= kEps) offer(i, word, t, u, v, t + kQuarter - u - v);
  }

  // 8.10, L+R-S-R-: w = i e^(i t) (2 - u), t + pi / 2 - v = phi.
  void lrsr(const Arm& w, const Image& i, Word word) {
    const double u = 2.0 - w.rho;
    if (u > kEps || hopeless(kQuarter - u + quarter_rest_)) return;
    const Direction first{-w.b, i.flip * w.a};
    if (!first.left() || !first.quarter_right_of(i)) return;
    const double t = first.angle();
    const double v = -wrap(i.phi - kQuarter - t);
    if (t >= -kEps && v <= kEps) offer(i, word, t, u, v, t + kQuarter - u - v);
  }

  // 8.11, L+R-S-L-R+: w = e^(i t) (-2 - i (4 - u)), t - v = phi.
  void lrslr(const Arm& w, const Image& i) {
    const double u = 4.0 - w.tangent;
    if (u > kEps || hopeless(kPi - u + abs_phi_)) return;
    const double a = i.flip * w.a;
    const Direction first{-2.0 * a - w.b * w.tangent, a * w.tangent - 2.0 * w.b};
    if (!first.left() || !first.left_of(i)) return;
    const double t = first.angle();
    const double v = wrap(t - i.phi);
    if (t >= -kEps && v >= -kEps) offer(i, Word::kLrslr, t, u, v, t + kPi - u + v);
  }

  double tolerance_;     // by which an answer may miss the goal
  double abs_phi_;       // bounds |t| + |v| of words whose other turns cancel
  double quarter_rest_;  // bounds it in words with one quarter turn
  Side sides_[2];        // the problem and its mirror image
  Image images_[4];
  Solution best_;
};

Curve build(const UnitGoal& goal, const Solution& found, double radius) {
  const Shape& shape = kShapes[static_cast<std::size_t>(found.word)];
  Curve curve;
  for (std::size_t k = 0; k < shape.turns.size(); ++k) {
    const double side = shape.turns[k] == 'L' ? 1.0 : shape.turns[k] == 'R' ? -1.0 : 0.0;
    const char from = shape.lengths[k];
    const double length = from == 't'   ? found.t
                          : from == 'u' ? found.u
                          : from == 'v' ? found.v
                          : from == 'n' ? -found.u
                                        : -kQuarter;
    internal::add_piece(curve, side * found.mirror, found.flip * length, found.length, goal,
                        radius);
  }
  return curve;
}

}  // namespace

Curve shortest_reeds_shepp(const Pose2& from, const Pose2& to, double radius) {
  const UnitGoal goal = internal::unit_goal(from, to, radius);
  return build(goal, Search(goal).shortest(), radius);
}

double reeds_shepp_length(const Pose2& from, const Pose2& to, double radius) {
  return Search(internal::unit_goal(from, to, radius)).shortest().length * radius;
}

}  // namespace headland
