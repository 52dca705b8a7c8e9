// SPDX-License-Identifier: Apache-2.0
#include "control/pure_pursuit/steering_plan.hpp"

#include <algorithm>
#include <cmath>

#include "core/model/steering_rate.hpp"

namespace headland {
namespace {

constexpr double kSlowest = 0.1;         // speed that a plan counts with at least [m/s]
constexpr double kSameCurvature = 1e-6;  // [1/m]
constexpr int kPasses = 6;               // of the solver, each linearised around the last

}  // namespace

struct SteeringPlan::Builder {
  SteeringPlan& plan;
  const Reference& reference;
  const SpeedProfile& speeds;
  const Vehicle& vehicle;
  const SteeringPlanConfig& config;

  std::vector<RampCell> cells;
  std::vector<double> borders;  // driven distance at the cells' borders [m]
  BoundedRamp solver;
  RampState state = RampState::Zero();  // at the end of the last window, in its direction of travel

  double steering(double curvature) const { return std::atan(vehicle.wheelbase_m * curvature); }

  // Speed on the segment at s [m/s], starting from a standstill at its begin.
  double speed(int segment, double s) const {
    const double begin_s = reference.path.segments()[static_cast<std::size_t>(segment)].begin_s;
    const double from_rest =
        std::sqrt(2.0 * vehicle.acceleration_mps2 * std::max(0.0, s - begin_s));
    return std::max(kSlowest, std::min(from_rest, speeds.limit(s, segment, 0.0)));
  }

  // The distance planned on both sides of a step of the path's curvature at s [m]: the steering may
  // turn too far first, and back.
  double reach(int segment, double s, double from, double to) const {
    const double seconds = std::abs(steering(to) - steering(from)) / vehicle.steering_rate_radps;
    return config.margin_m + 2.0 * speed(segment, s) * seconds;
  }

  // A clothoid along which the steering cannot keep up at the speed driven there.
  bool too_sharp(int segment, double s, const PathPiece& piece) const {
    const double turning = steering_per_metre(vehicle.wheelbase_m, piece.curvature,
                                              piece.end_curvature(), piece.length);
    return turning * speed(segment, s + 0.5 * piece.length) >
           config.rate_use_ratio * vehicle.steering_rate_radps * (1.0 + 1e-9);
  }

  void add_windows() {
    const Path& path = reference.path;
    double s = 0.0;
    int segment = 0;
    double before = path.pieces().front().curvature;
    for (const PathPiece& piece : path.pieces()) {
      const bool cusp =
          s > path.segments()[static_cast<std::size_t>(segment)].end_s - 1e-9 && s > 0.0;
      if (cusp) ++segment;
      // A cusp starts a window of its own, as what the last one left over goes on in the next.
      if (cusp || std::abs(piece.curvature - before) > kSameCurvature) {
        const double far = cusp ? config.margin_m : reach(segment, s, before, piece.curvature);
        add_window(segment, s - far, s + far);
      }
      if (too_sharp(segment, s, piece)) {
        const double far = reach(segment, s, piece.curvature, piece.end_curvature());
        add_window(segment, s - far, s + piece.length + far);
      }
      before = piece.end_curvature();
      s += piece.length;
    }
  }

  void add_window(int number, double from_s, double to_s) {
    const PathSegment& segment = reference.path.segments()[static_cast<std::size_t>(number)];
    const double begin_s = std::max(from_s, segment.begin_s);
    const double end_s = std::min(to_s, segment.end_s);
    auto& windows = plan.windows_;
    if (!windows.empty() && windows.back().segment == number && windows.back().end_s >= begin_s) {
      windows.back().end_s = std::max(windows.back().end_s, end_s);
      windows.back().begin_s = std::min(windows.back().begin_s, begin_s);
    } else {
      windows.push_back({begin_s, end_s, number, 0, 0});
    }
  }

  void cut_cells(const Window& window, double direction) {
    cells.clear();
    borders.assign(1, window.begin_s);
    double begin_s = 0.0;
    for (const PathPiece& piece : reference.path.pieces()) {
      const double from = std::max(begin_s, window.begin_s);
      const double driven = from - begin_s;  // of the piece
      begin_s += piece.length;
      const double length = std::min(begin_s, window.end_s) - from;
      if (length <= 1e-9) continue;
      const int count = static_cast<int>(std::ceil(length / config.step_m));
      for (int i = 0; i < count; ++i) {
        const double curvature = piece.curvature_at(driven + length * (i + 0.5) / count);
        cells.push_back({length / count, direction * curvature, 0.0, RampState::Zero()});
        borders.push_back(from + length * (i + 1) / count);
      }
    }
  }

  double cell_speed(int segment, std::size_t i) const {
    return speed(segment, 0.5 * (borders[i] + borders[i + 1]));
  }

  // The rate of curvature that the steering's rate allows: kappa = tan(delta) / wheelbase.
  void bound_rate(int segment, std::size_t i, double kappa) {
    const double wheelbase = vehicle.wheelbase_m;
    const double slope = (1.0 + wheelbase * wheelbase * kappa * kappa) / wheelbase;
    cells[i].rate_bound =
        config.rate_use_ratio * vehicle.steering_rate_radps / cell_speed(segment, i) * slope;
  }

  // Brings the solver's linear model to the exact one, around the ramp it found last.
  void relinearise(int segment, const std::vector<RampState>& ramp) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      RampCell& cell = cells[i];
      const double kappa = 0.5 * (ramp[i](2) + ramp[i + 1](2));
      bound_rate(segment, i, kappa);
      RampState exact = advance_state(ramp[i], kappa, cell);
      exact(2) = ramp[i + 1](2);
      // The ramp obeys the linear model with the last correction.
      cell.correction += exact - ramp[i + 1];
    }
  }

  // Drives the solver's curvature with the exact steering geometry and path kinematics, so that
  // the plan can be followed to the letter.
  void drive(Window& window, double direction, const std::vector<RampState>& ramp) {
    RampState x = ramp[0];
    const double limit = vehicle.max_steering_rad();
    double delta = std::clamp(steering(x(2)), -limit, limit);
    window.first = plan.nodes_.size();
    for (std::size_t i = 0;; ++i) {
      x(2) = std::tan(delta) / vehicle.wheelbase_m;
      plan.nodes_.push_back({borders[i], {direction * x(2), direction * x(0), x(1)}});
      if (i == cells.size()) break;
      const RampCell& cell = cells[i];
      const double v = cell_speed(window.segment, i);
      // Pure pursuit's gains, for a lookahead that the steering can serve.
      const double ahead = 1.0 + 0.5 * v / vehicle.steering_rate_radps;
      const double back =
          2.0 / (ahead * ahead) * (x(0) - ramp[i](0)) + 2.0 / ahead * (x(1) - ramp[i](1));
      const double wanted = std::clamp(steering(ramp[i + 1](2) - back), -limit, limit);
      const double most = vehicle.steering_rate_radps * cell.length / v;
      delta += std::clamp(wanted - delta, -most, most);
      const double mean = 0.5 * (x(2) + std::tan(delta) / vehicle.wheelbase_m);
      x = advance_state(x, mean, cell);
    }
    window.last = plan.nodes_.size() - 1;
    state = x;
  }

  // e' = (1 - kp e) tan psi, psi' = kappa (1 - kp e) / cos psi - kp, by the midpoint rule.
  static RampState advance_state(const RampState& x, double kappa, const RampCell& cell) {
    const RampState middle = x + 0.5 * cell.length * slope(x, kappa, cell.path_curvature);
    return x + cell.length * slope(middle, kappa, cell.path_curvature);
  }

  static RampState slope(const RampState& x, double kappa, double path_curvature) {
    // Bounded, so that a path which cannot be followed at all still gives a finite plan.
    const double stretch = std::clamp(1.0 - path_curvature * x(0), 0.2, 5.0);
    const double heading = std::clamp(x(1), -1.2, 1.2);
    return {stretch * std::tan(heading), kappa * stretch / std::cos(heading) - path_curvature, 0.0};
  }

  void solve(Window& window, double last_direction) {
    const PathSegment& segment =
        reference.path.segments()[static_cast<std::size_t>(window.segment)];
    const double direction = sign(segment.gear);
    cut_cells(window, direction);
    const bool at_rest = window.begin_s <= segment.begin_s + 1e-9;
    RampState start = RampState::Zero();
    // Over a cusp the lateral error goes on, mirrored in the direction of travel.
    if (at_rest && window.segment > 0) {
      start << direction * last_direction * state(0), state(1), 0.0;
    }
    start(2) = cells.front().path_curvature;
    RampWeights weights;
    weights.heading = config.heading_weight_m * config.heading_weight_m;
    const double most = std::tan(vehicle.max_steering_rad()) / vehicle.wheelbase_m;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      bound_rate(window.segment, i, cells[i].path_curvature);
    }
    const std::vector<RampState>* ramp = nullptr;
    for (int pass = 0; pass < kPasses; ++pass) {
      if (ramp != nullptr) relinearise(window.segment, *ramp);
      ramp = &solver.solve(cells, start, at_rest, most, weights, pass > 0);
    }
    drive(window, direction, *ramp);
  }
};

void SteeringPlan::build(const Reference& reference, const SpeedProfile& speeds,
                         const Vehicle& vehicle, const SteeringPlanConfig& config) {
  nodes_.clear();
  windows_.clear();
  if (reference.path.empty()) return;
  Builder builder{*this, reference, speeds, vehicle, config, {}, {}, {}};
  builder.add_windows();
  double direction = 1.0;
  int segment = 0;
  for (Window& window : windows_) {
    const auto& segments = reference.path.segments();
    if (window.segment != segment) {
      const auto before = static_cast<std::size_t>(window.segment - 1);
      direction = sign(segments[before].gear);
      // A segment whose last window ends before its cusp leaves nothing over.
      const bool reaches = nodes_.empty() || nodes_.back().s >= segments[before].end_s - 1e-9;
      if (!reaches) builder.state.setZero();
      segment = window.segment;
    }
    builder.solve(window, direction);
  }
}

PlannedSteering SteeringPlan::at(const Path& path, double s, int segment) const {
  const PathSegment& stretch = path.segments()[static_cast<std::size_t>(segment)];
  const double inside = std::clamp(s, stretch.begin_s, stretch.end_s);
  const auto past = std::lower_bound(
      windows_.begin(), windows_.end(), inside, [segment](const Window& window, double value) {
        return window.segment < segment || (window.segment == segment && window.end_s < value);
      });
  if (past == windows_.end() || past->segment != segment || past->begin_s > inside) {
    // The end of a segment is already the next piece for Path::at.
    return {path.at(std::min(inside, stretch.end_s - 1e-6)).curvature, 0.0, 0.0};
  }
  const auto first = nodes_.begin() + static_cast<std::ptrdiff_t>(past->first);
  const auto last = nodes_.begin() + static_cast<std::ptrdiff_t>(past->last);
  const auto after = std::upper_bound(
      first + 1, last, inside, [](double value, const Node& node) { return value < node.s; });
  const Node& a = *(after - 1);
  const Node& b = *after;
  const double ratio = b.s > a.s ? std::clamp((inside - a.s) / (b.s - a.s), 0.0, 1.0) : 0.0;
  const auto mix = [ratio](double from, double to) { return from + ratio * (to - from); };
  return {mix(a.wanted.curvature, b.wanted.curvature), mix(a.wanted.lateral, b.wanted.lateral),
          mix(a.wanted.heading, b.wanted.heading)};
}

}  // namespace headland
