// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/reeds_shepp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

// Formula numbers: Reeds and Shepp 1990, section 8. In units of the radius; L, R and S with signed
// lengths. Mirroring (y, phi -> -y, -phi), flipping time (x, phi -> -x, -phi) and driving backwards
// through the word make 48 words of these nine.
namespace headland {
namespace {

constexpr double kEps = 1e-12;

struct Word {
  double turns[5] = {0, 0, 0, 0, 0};  // +1 left, 0 straight, -1 right
  double lengths[5] = {0, 0, 0, 0, 0};
  int count = 0;
  double total = std::numeric_limits<double>::infinity();
};

struct Params {
  double t = 0.0;
  double u = 0.0;
  double v = 0.0;
};

double wrap(double a) {
  const double w = std::remainder(a, 2.0 * kPi);
  return w;
}

class Search {
 public:
  Search(double x, double y, double phi) : x_(x), y_(y), phi_(phi) {}

  Word best() {
    for (const double flip : {1.0, -1.0}) {
      for (const double mirror : {1.0, -1.0}) {
        const double x = flip * x_;
        const double y = mirror * y_;
        const double phi = flip * mirror * phi_;
        forward(x, y, phi, flip, mirror);
        // Driven through backwards: the goal as seen from itself.
        const double c = std::cos(phi);
        const double s = std::sin(phi);
        backward(x * c + y * s, x * s - y * c, phi, flip, mirror);
      }
    }
    return best_;
  }

 private:
  void offer(double flip, double mirror, std::initializer_list<double> turns,
             std::initializer_list<double> lengths) {
    double total = 0.0;
    for (const double l : lengths) total += std::abs(l);
    if (total >= best_.total - 1e-13) return;
    best_.total = total;
    best_.count = 0;
    auto length = lengths.begin();
    for (const double turn : turns) {
      best_.turns[best_.count] = mirror * turn;
      best_.lengths[best_.count++] = flip * *length++;
    }
  }

  static bool csc_same(double x, double y, double phi, Params& p) {  // 8.1: L+S+L+
    const double a = x - std::sin(phi);
    const double b = y - 1.0 + std::cos(phi);
    p.u = std::hypot(a, b);
    p.t = p.u < kEps ? 0.0 : std::atan2(b, a);
    p.v = wrap(phi - p.t);
    return p.t >= -kEps && p.v >= -kEps;
  }
  static bool csc_other(double x, double y, double phi, Params& p) {  // 8.2: L+S+R+
    const double a = x + std::sin(phi);
    const double b = y - 1.0 - std::cos(phi);
    const double squared = a * a + b * b;
    if (squared < 4.0 - kEps) return false;
    p.u = std::sqrt(std::max(0.0, squared - 4.0));
    p.t = wrap(std::atan2(b, a) + std::atan2(2.0, p.u));
    p.v = wrap(p.t - phi);
    return p.t >= -kEps && p.v >= -kEps;
  }
  static bool ccc(double x, double y, double phi, Params& p) {  // 8.3: L+R-L
    const double a = x - std::sin(phi);
    const double b = y - 1.0 + std::cos(phi);
    const double rho = std::hypot(a, b);
    if (rho > 4.0 + kEps) return false;
    p.u = -2.0 * std::asin(std::min(1.0, 0.25 * rho));
    p.t = wrap(std::atan2(b, a) + 0.5 * p.u + kPi);
    p.v = wrap(phi - p.t + p.u);
    return p.t >= -kEps && p.u <= kEps;
  }
  static void outer(double u, double v, double a, double b, double phi, double& tau, double& omega) {
    const double delta = wrap(u - v);
    const double A = std::sin(u) - std::sin(delta);
    const double B = std::cos(u) - std::cos(delta) - 1.0;
    const double t1 = std::atan2(b * A - a * B, a * A + b * B);
    const double t2 = 2.0 * (std::cos(delta) - std::cos(v) - std::cos(u)) + 3.0;
    tau = t2 < 0.0 ? wrap(t1 + kPi) : wrap(t1);
    omega = wrap(tau - u + v - phi);
  }
  static bool cccc_opposite(double x, double y, double phi, Params& p) {  // 8.7: L+R+L-R-
    const double a = x + std::sin(phi);
    const double b = y - 1.0 - std::cos(phi);
    const double rho = 0.25 * (2.0 + std::hypot(a, b));
    if (rho > 1.0 + kEps) return false;
    p.u = std::acos(std::min(1.0, rho));
    outer(p.u, -p.u, a, b, phi, p.t, p.v);
    return p.t >= -kEps && p.v <= kEps;
  }
  static bool cccc_same(double x, double y, double phi, Params& p) {  // 8.8: L+R-L-R+
    const double a = x + std::sin(phi);
    const double b = y - 1.0 - std::cos(phi);
    const double rho = (20.0 - a * a - b * b) / 16.0;
    if (rho < -kEps || rho > 1.0 + kEps) return false;
    p.u = -std::acos(std::clamp(rho, 0.0, 1.0));
    outer(p.u, p.u, a, b, phi, p.t, p.v);
    return p.t >= -kEps && p.v >= -kEps;
  }
  static bool ccsc_same(double x, double y, double phi, Params& p) {  // 8.9: L+R-S-L-
    const double a = x - std::sin(phi);
    const double b = y - 1.0 + std::cos(phi);
    const double rho = std::hypot(a, b);
    if (rho < 2.0 - kEps) return false;
    const double r = std::sqrt(std::max(0.0, rho * rho - 4.0));
    p.u = 2.0 - r;
    p.t = wrap(std::atan2(b, a) + std::atan2(r, -2.0));
    p.v = wrap(phi - 0.5 * kPi - p.t);
    return p.t >= -kEps && p.u <= kEps && p.v <= kEps;
  }
  static bool ccsc_other(double x, double y, double phi, Params& p) {  // 8.10: L+R-S-R-
    const double a = x + std::sin(phi);
    const double b = y - 1.0 - std::cos(phi);
    const double rho = std::hypot(a, b);
    if (rho < 2.0 - kEps) return false;
    p.t = std::atan2(a, -b);
    p.u = 2.0 - rho;
    p.v = wrap(p.t + 0.5 * kPi - phi);
    return p.t >= -kEps && p.u <= kEps && p.v <= kEps;
  }
  static bool ccscc(double x, double y, double phi, Params& p) {  // 8.11: L+R-S-L-R+
    const double a = x + std::sin(phi);
    const double b = y - 1.0 - std::cos(phi);
    const double rho = std::hypot(a, b);
    if (rho < 2.0 - kEps) return false;
    p.u = 4.0 - std::sqrt(std::max(0.0, rho * rho - 4.0));
    if (p.u > kEps) return false;
    p.t = wrap(std::atan2((4.0 - p.u) * a - 2.0 * b, -2.0 * a + (p.u - 4.0) * b));
    p.v = wrap(p.t - phi);
    return p.t >= -kEps && p.v >= -kEps;
  }

  void forward(double x, double y, double phi, double flip, double mirror) {
    constexpr double kQuarter = 0.5 * kPi;
    Params p;
    if (csc_same(x, y, phi, p)) offer(flip, mirror, {1, 0, 1}, {p.t, p.u, p.v});
    if (csc_other(x, y, phi, p)) offer(flip, mirror, {1, 0, -1}, {p.t, p.u, p.v});
    if (ccc(x, y, phi, p)) offer(flip, mirror, {1, -1, 1}, {p.t, p.u, p.v});
    if (cccc_opposite(x, y, phi, p)) offer(flip, mirror, {1, -1, 1, -1}, {p.t, p.u, -p.u, p.v});
    if (cccc_same(x, y, phi, p)) offer(flip, mirror, {1, -1, 1, -1}, {p.t, p.u, p.u, p.v});
    if (ccsc_same(x, y, phi, p)) offer(flip, mirror, {1, -1, 0, 1}, {p.t, -kQuarter, p.u, p.v});
    if (ccsc_other(x, y, phi, p)) offer(flip, mirror, {1, -1, 0, -1}, {p.t, -kQuarter, p.u, p.v});
    if (ccscc(x, y, phi, p)) {
      offer(flip, mirror, {1, -1, 0, 1, -1}, {p.t, -kQuarter, p.u, -kQuarter, p.v});
    }
  }
  void backward(double x, double y, double phi, double flip, double mirror) {
    constexpr double kQuarter = 0.5 * kPi;
    Params p;
    if (ccc(x, y, phi, p)) offer(flip, mirror, {1, -1, 1}, {p.v, p.u, p.t});
    if (ccsc_same(x, y, phi, p)) offer(flip, mirror, {1, 0, -1, 1}, {p.v, p.u, -kQuarter, p.t});
    if (ccsc_other(x, y, phi, p)) offer(flip, mirror, {-1, 0, -1, 1}, {p.v, p.u, -kQuarter, p.t});
  }

  double x_;
  double y_;
  double phi_;
  Word best_;
};

Word solve(const Pose2& from, const Pose2& to, double radius) {
  const Pose2 goal = inverse(from) * to;
  return Search(goal.x / radius, goal.y / radius, wrap_angle(goal.yaw)).best();
}

}  // namespace

Curve shortest_reeds_shepp(const Pose2& from, const Pose2& to, double radius) {
  const Word word = solve(from, to, radius);
  Curve curve;
  for (int i = 0; i < word.count; ++i) {
    curve.add({word.turns[i] / radius, word.lengths[i] * radius});
  }
  return curve;
}

double reeds_shepp_length(const Pose2& from, const Pose2& to, double radius) {
  return solve(from, to, radius).total * radius;
}

}  // namespace headland
