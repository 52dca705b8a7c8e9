// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"
#include "core/world/agent.hpp"
#include "core/world/camera.hpp"
#include "perception/tracking/detection.hpp"

namespace headland {

/// How far velocities wander, by class: the standard deviation per axis after one second of white
/// acceleration [m/s].
struct MotionConfig {
  double person_mps = 1.0;
  double livestock_mps = 1.0;
  double vehicle_mps = 1.0;
  double other_mps = 1.0;
  double first_speed_mps = 1.5;

  template <class V>
  void visit(V& v) {
    v("person_mps", person_mps, config::kPositive, "After one second [m/s]");
    v("livestock_mps", livestock_mps, config::kPositive, "[m/s]");
    v("vehicle_mps", vehicle_mps, config::kPositive, "[m/s]");
    v("other_mps", other_mps, config::kPositive, "Of what is not known [m/s]");
    v("first_speed_mps", first_speed_mps, config::kPositive,
      "Standard deviation per axis of the velocity of whom is seen first [m/s]");
  }
  /// The classes' variances after one second, weighted by how probable they are [m2/s2].
  double variance(const ClassProbability& probability) const;
};

/// Someone who is followed from scan to scan.
struct TrackedAgent {
  int id = 0;
  /// x, y [m, map], vx, vy [m/s].
  Eigen::Vector4d state = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
  double width_m = 0.5;   ///< of its body across the line of sight, low-passed
  double height_m = 1.0;  ///< of its top above the ground, low-passed
  ClassProbability probability = kUnknownClass;
  bool confirmed = false;  ///< seen in two of its first three scans
  double first_s = 0.0;    ///< seen first
  double last_s = 0.0;     ///< seen last
  int seen_count = 1;
  int chance_count = 1;  ///< scans that ought to have shown it
  int cluster = -1;      ///< Detection::cluster, if the last scan showed it
  /// 0: just seen; it is given up at 1.
  double absence = 0.0;

  Point2 position() const { return state.head<2>(); }
  Point2 velocity() const { return state.tail<2>(); }
  Eigen::Matrix2d position_covariance() const { return covariance.topLeftCorner<2, 2>(); }
  double radius() const { return 0.5 * width_m; }
};

/// A track that begins with its first detection.
TrackedAgent begin_track(const Detection& detection, const MotionConfig& config, int id,
                         double time_s);

/// Goes on by `dt` >= 0 [s] at a constant velocity that white acceleration disturbs.
void predict(TrackedAgent& track, double dt, const MotionConfig& config);

/// Takes in a detection's position (Kalman, Joseph form). Size and class are left alone.
void correct(TrackedAgent& track, const Detection& detection);

/// How well a detection fits: squared Mahalanobis distance, chi-squared with 2 degrees of freedom,
/// and the logarithm of the determinant of its covariance [m4].
struct Fit {
  double distance2 = 0.0;
  double log_determinant = 0.0;
};
Fit fit_of(const TrackedAgent& track, const Detection& detection);

/// Bayes over classes: adds the evidence's log-odds against an even prior, times `weight` (1: it is
/// independent of what came before; 0: nothing new). Each class keeps at least `floor`, so that
/// later evidence can still turn it. Evidence that is no probability changes nothing.
ClassProbability fuse(const ClassProbability& prior, const ClassProbability& evidence,
                      double weight = 1.0, double floor = 0.01);

/// The most probable class; kOther if none is above an even chance.
ObjectClass most_probable(const ClassProbability& probability);

/// As planners take it: the kind by class, and for livestock by size; who is not known counts as a
/// person.
Agent to_agent(const TrackedAgent& track);

}  // namespace headland
