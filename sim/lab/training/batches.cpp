// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/base/random.hpp"
#include "sim/lab/training/internal/response_model.hpp"

namespace headland::training {
namespace {

constexpr double kStanding = 0.05;  // as in the predictor [m/s]

// Turned by an angle about the robot's place now and, before that, mirrored on the x axis.
struct Turn {
  Point2 origin{0.0, 0.0};
  double cosine = 1.0;
  double sine = 0.0;
  double side = 1.0;

  Point2 vector(const Point2& v) const {
    return {cosine * v.x() - sine * side * v.y(), sine * v.x() + cosine * side * v.y()};
  }
  Point2 point(const Point2& p) const { return vector(p - origin); }
};

// The floats of a batch, before they become tensors.
struct Columns {
  std::int64_t windows = 0, agents = 0, moments = 0, past = 0;
  std::vector<float> position, seen, velocity, heading, radius, noise, present, robot, robot_radius,
      counts;

  Columns(std::int64_t b, std::int64_t a, std::int64_t t, std::int64_t p)
      : windows(b), agents(a), moments(t), past(p) {
    const auto size = [](std::int64_t n) { return static_cast<std::size_t>(n); };
    position.assign(size(b * a * t * 2), 0.0F);
    seen.assign(size(b * a * (p + 1) * 2), 0.0F);
    velocity = seen;
    heading.assign(size(b * a * 2), 0.0F);
    radius.assign(size(b * a), 0.0F);
    noise = counts = radius;
    present.assign(size(b * a * (p + 1)), 0.0F);
    robot.assign(size(b * t * 2), 0.0F);
    robot_radius.assign(size(b), 0.0F);
  }
};

void put(std::vector<float>& to, std::int64_t at, const Point2& v) {
  to[static_cast<std::size_t>(2 * at)] = static_cast<float>(v.x());
  to[static_cast<std::size_t>(2 * at + 1)] = static_cast<float>(v.y());
}

struct AgentView {
  double noise = 0.0;
  std::int64_t first = 0;  // moment of the first sight
  bool no_velocity = false;
};

void put_agent(const CrowdWindow& window, std::int64_t agent, std::int64_t row, const Turn& turn,
               const AgentView& view, const Disturbance& disturbance, double step_s,
               RandomStream& random, Columns& c) {
  const auto at = [&](std::int64_t k) { return static_cast<std::size_t>(agent * c.moments + k); };
  const auto noise = [&](double deviation) {
    const double x = deviation * random.normal();
    return Point2(x, deviation * random.normal());
  };
  std::vector<Point2> sights;
  Point2 velocity(0.0, 0.0);
  for (std::int64_t k = 0; k <= c.past; ++k) {
    const std::int64_t place = row * (c.past + 1) + k;
    Point2 sight = turn.point(window.position[at(k)]);
    velocity = turn.vector(window.velocity[at(k)]);
    if (view.noise > 0.0) {
      sight += noise(view.noise);
      velocity += noise(view.noise * disturbance.noise_per_s);
    }
    if (view.no_velocity) {
      velocity.setZero();
      if (k > view.first) velocity = (sight - sights.back()) / step_s;
    }
    sights.push_back(sight);
    if (k < view.first) continue;
    put(c.seen, place, sight);
    put(c.velocity, place, velocity);
    c.present[static_cast<std::size_t>(place)] = 1.0F;
  }
  for (std::int64_t k = 0; k < c.moments; ++k) {
    put(c.position, row * c.moments + k, turn.point(window.position[at(k)]));
  }
  const double speed = velocity.norm();
  put(c.heading, row, speed > kStanding ? Point2(velocity / speed) : Point2(1.0, 0.0));
  const auto r = static_cast<std::size_t>(row);
  c.radius[r] = static_cast<float>(window.radius_m[static_cast<std::size_t>(agent)]);
  c.noise[r] = static_cast<float>(view.noise);
  c.counts[r] = 1.0F;
}

}  // namespace

Batch make_batch(std::span<const CrowdWindow* const> windows, const WindowShape& shape,
                 const Disturbance& disturbance, RandomStream& random) {
  Columns c(static_cast<std::int64_t>(windows.size()), shape.most_agents, shape.moments(),
            shape.past_steps);
  for (std::int64_t b = 0; b < c.windows; ++b) {
    const CrowdWindow& window = *windows[static_cast<std::size_t>(b)];
    const double angle = disturbance.turned_rad * random.uniform(-1.0, 1.0);
    Turn turn{window.robot[static_cast<std::size_t>(c.past)], std::cos(angle), std::sin(angle)};
    if (disturbance.mirrored && random.uniform() < 0.5) turn.side = -1.0;
    const bool no_velocity = random.uniform() < disturbance.no_velocity_probability;
    for (std::int64_t k = 0; k < c.moments; ++k) {
      put(c.robot, b * c.moments + k, turn.point(window.robot[static_cast<std::size_t>(k)]));
    }
    c.robot_radius[static_cast<std::size_t>(b)] = static_cast<float>(window.robot_radius_m);
    for (std::int64_t a = 0; a < window.agents(); ++a) {
      AgentView view;
      view.no_velocity = no_velocity;
      if (random.uniform() < disturbance.noisy_probability) {
        view.noise = random.uniform(0.0, disturbance.most_noise_m);
      }
      if (random.uniform() < disturbance.short_probability) {
        view.first = random.index(shape.past_steps + 1);
      }
      put_agent(window, a, b * c.agents + a, turn, view, disturbance, shape.step_s, random, c);
    }
  }
  const auto tensor = [](std::vector<float>& values, at::IntArrayRef sizes) {
    return torch::from_blob(values.data(), sizes).clone();
  };
  const std::int64_t b = c.windows, a = c.agents, t = c.moments, p = c.past + 1;
  return {tensor(c.position, {b, a, t, 2}), tensor(c.seen, {b, a, p, 2}),
          tensor(c.velocity, {b, a, p, 2}), tensor(c.heading, {b, a, 2}),
          tensor(c.radius, {b, a}),         tensor(c.noise, {b, a}),
          tensor(c.present, {b, a, p}),     tensor(c.robot, {b, t, 2}),
          tensor(c.robot_radius, {b}),      tensor(c.counts, {b, a})};
}

}  // namespace headland::training
