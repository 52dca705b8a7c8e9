// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/pose2.hpp"
#include "perception/tracking/detection.hpp"
#include "perception/tracking/metrics.hpp"
#include "perception/tracking/view.hpp"

namespace headland::testing {

/// A flat world of upright cylinders that wander in a square around a lidar at its middle, seen by
/// rings of beams with range noise and occlusion, and clustered by distance: what stands nearer
/// together than `join_m` is one cluster.
struct HerdSceneConfig {
  double area_per_agent_m2 = 50.0;
  double half_side_m = 15.0;
  double body_radius_m = 0.3;
  double body_height_m = 1.7;
  double least_distance_m = 1.0;  ///< of centres; they turn away before
  double top_speed_mps = 1.5;
  double range_noise_m = 0.02;
  double beam_step_deg = 0.2;
  double ring_step_deg = 2.0;
  int ring_count = 16;
  double sensor_height_m = 1.2;
  double join_m = 0.5;
  double dropout_ratio = 0.05;
};

class HerdScene {
 public:
  HerdScene(const HerdSceneConfig& config, unsigned seed)
      : config_(config), random_(seed, "herd_scene") {
    const double side = 2.0 * config.half_side_m;
    const int count = static_cast<int>(side * side / config.area_per_agent_m2);
    while (static_cast<int>(bodies_.size()) < count) {
      Body body;
      body.position = somewhere();
      if (!is_free(body.position, -1)) continue;
      body.goal = somewhere();
      body.speed = random_.uniform(0.1, config.top_speed_mps);
      bodies_.push_back(body);
    }
  }

  double time_s() const { return time_s_; }

  void step(double dt) {
    time_s_ += dt;
    for (Body& body : bodies_) {
      if ((body.goal - body.position).norm() < 1.0) body.goal = somewhere();
      Point2 wanted = (body.goal - body.position).normalized() * body.speed;
      for (const Body& other : bodies_) {
        const Point2 apart = body.position - other.position;
        const double gap = apart.norm() - config_.least_distance_m;
        if (&other == &body || gap > 1.0) continue;
        // A push apart, and a step aside.
        const Point2 push = apart.normalized() * std::exp(-4.0 * gap);
        wanted += push + 0.5 * Point2(-push.y(), push.x());
      }
      const Point2 from_sensor = body.position;
      if (from_sensor.norm() < 3.0) wanted += from_sensor.normalized();
      if (wanted.norm() > config_.top_speed_mps) wanted *= config_.top_speed_mps / wanted.norm();
      // Velocities follow within a time constant of 0.5 s.
      body.velocity += (wanted - body.velocity) * std::min(1.0, dt / 0.5);
      body.position += body.velocity * dt;
    }
  }

  /// The lidar's points on the bodies [m, map].
  const std::vector<Point2>& scan() {
    points_.clear();
    beams_on_.assign(bodies_.size(), 0);
    beams_free_.assign(bodies_.size(), 0);
    const double step = deg_to_rad(config_.beam_step_deg);
    const int beams = static_cast<int>(2.0 * kPi / step);
    for (int b = 0; b < beams; ++b) cast(b * step);
    return points_;
  }

  /// All within `range` [m]; those count of whose width the sensor sees at least `share`.
  std::vector<TrackPoint> truth(double range, double share) const {
    std::vector<TrackPoint> all;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Body& body = bodies_[i];
      const bool counts = body.position.norm() <= range && beams_free_[i] > 0 &&
                          beams_on_[i] >= share * beams_free_[i];
      all.push_back({static_cast<int>(i), body.position, body.velocity, counts});
    }
    return all;
  }

  /// Clusters of the last scan as bodies. They refer to memory of the scene.
  const std::vector<Detection>& detections(const BodyConfig& config = {}) {
    cluster();
    detections_.clear();
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
      auto detection = detect_body(clusters_[c], Point2(0.0, 0.0), config);
      if (!detection) continue;
      detection->height_m = config_.body_height_m;
      detection->cluster = static_cast<int>(c);
      detections_.push_back(*detection);
    }
    return detections_;
  }

  SensorView view() const {
    SensorView view;
    view.far_m = 1.5 * config_.half_side_m;
    return view;
  }

 private:
  struct Body {
    Point2 position{0.0, 0.0};
    Point2 velocity{0.0, 0.0};
    Point2 goal{0.0, 0.0};
    double speed = 1.0;
  };

  Point2 somewhere() {
    const double s = config_.half_side_m;
    return {random_.uniform(-s, s), random_.uniform(-s, s)};
  }
  bool is_free(const Point2& p, int except) const {
    if (p.norm() < 3.0) return false;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (static_cast<int>(i) != except &&
          (bodies_[i].position - p).norm() < config_.least_distance_m) {
        return false;
      }
    }
    return true;
  }

  // All rings of one azimuth: of each, the nearest body that it meets at its height.
  void cast(double azimuth) {
    const Point2 ahead(std::cos(azimuth), std::sin(azimuth));
    const Point2 left(-ahead.y(), ahead.x());
    hits_.clear();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const double along = ahead.dot(bodies_[i].position);
      const double aside = left.dot(bodies_[i].position);
      const double half2 = config_.body_radius_m * config_.body_radius_m - aside * aside;
      if (along <= 0.0 || half2 <= 0.0) continue;
      hits_.push_back({along - std::sqrt(half2), i});
      ++beams_free_[i];
    }
    std::sort(hits_.begin(), hits_.end());
    if (hits_.empty()) return;
    ++beams_on_[hits_.front().second];
    for (int ring = 0; ring < config_.ring_count; ++ring) {
      const double slope =
          std::tan(deg_to_rad((ring - 0.5 * (config_.ring_count - 1)) * config_.ring_step_deg));
      for (const auto& [distance, body] : hits_) {
        const double height = config_.sensor_height_m + slope * distance;
        if (height < 0.15 || height > config_.body_height_m) continue;
        if (random_.uniform() >= config_.dropout_ratio) {
          points_.push_back((distance + config_.range_noise_m * random_.normal()) * ahead);
        }
        break;
      }
    }
  }

  void cluster() {
    const int n = static_cast<int>(points_.size());
    parent_.resize(points_.size());
    std::iota(parent_.begin(), parent_.end(), 0);
    order_ = parent_;
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    std::sort(order_.begin(), order_.end(),
              [&](int a, int b) { return points_[at(a)].x() < points_[at(b)].x(); });
    for (int i = 0; i < n; ++i) {
      const Point2& p = points_[at(order_[at(i)])];
      for (int j = i + 1; j < n; ++j) {
        const Point2& q = points_[at(order_[at(j)])];
        if (q.x() - p.x() > config_.join_m) break;
        if ((q - p).squaredNorm() <= config_.join_m * config_.join_m) {
          parent_[at(root(order_[at(i)]))] = root(order_[at(j)]);
        }
      }
    }
    clusters_.clear();
    std::vector<int> place(points_.size(), -1);
    for (int i = 0; i < n; ++i) {
      int& own = place[at(root(i))];
      if (own < 0) {
        own = static_cast<int>(clusters_.size());
        clusters_.emplace_back();
      }
      clusters_[at(own)].push_back(points_[at(i)]);
    }
  }
  int root(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i) {
      int& above = parent_[static_cast<std::size_t>(i)];
      above = parent_[static_cast<std::size_t>(above)];
      i = above;
    }
    return i;
  }

  HerdSceneConfig config_;
  RandomStream random_;
  double time_s_ = 0.0;
  std::vector<Body> bodies_;
  std::vector<Point2> points_;
  std::vector<std::pair<double, std::size_t>> hits_;
  std::vector<int> beams_on_;    // beams that meet a body first
  std::vector<int> beams_free_;  // ... that would, were it alone
  std::vector<int> parent_;
  std::vector<int> order_;
  std::vector<std::vector<Point2>> clusters_;
  std::vector<Detection> detections_;
};

}  // namespace headland::testing
