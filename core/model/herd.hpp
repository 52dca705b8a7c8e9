// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/base/random.hpp"
#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"

namespace headland {

/// How animals of a herd respond to each other and to whom they flee from: Stroembom et al. 2014
/// ("Solving the shepherding problem") with the alignment of Jadhav et al. 2024. Both articles
/// count in steps, in which an animal moves 1 m: a step is taken to be a second, as sheep under a
/// dog walk at 1.0 to 1.4 m/s (tracks of Jadhav et al.). The defaults are of sheep.
struct HerdModel {
  double flight_m = 12.0;
  double spacing_m = 1.0;
  int neighbor_count = 10;
  double flight_weight = 1.0;
  double repulsion_weight = 2.0;
  double attraction_weight = 1.5;
  double alignment_weight = 1.3;
  double noise_weight = 0.3;
  double noise_s = 1.0;
  double response_s = 0.7;
  double graze_mps = 0.16;
  double walk_mps = 1.25;
  double run_mps = 4.0;

  template <class V>
  void visit(V& v) {
    v("flight_m", flight_m, config::kNonNegative,
      "Flees from whom is nearer: 12 m from a dog (Jadhav 2024); from a robot 3 m or more [m]");
    v("spacing_m", spacing_m, config::kNonNegative,
      "Moves away from others that are nearer; 2 m in both articles, 1 m gives the distances of "
      "the tracks [m]");
    v("neighbor_count", neighbor_count, config::Range{0, 1000},
      "The nearest so many attract it and align it (Jadhav 2024: some of 10)");
    v("flight_weight", flight_weight, config::kNonNegative, "1 (both articles)");
    v("repulsion_weight", repulsion_weight, config::kNonNegative, "2 (both articles)");
    v("attraction_weight", attraction_weight, config::kNonNegative,
      "1.5 (Jadhav 2024; 1.05 in Stroembom 2014)");
    v("alignment_weight", alignment_weight, config::kNonNegative, "1.3 (Jadhav 2024)");
    v("noise_weight", noise_weight, config::kNonNegative, "0.3 (both articles)");
    v("noise_s", noise_s, config::kPositive, "The noise is forgotten after this time: a step [s]");
    v("response_s", response_s, config::kPositive,
      "Time constant of its velocity; 0.7 s keeps a quarter after a second, as the articles' "
      "weight "
      "of 0.5 for the heading against 1.5 for all else [s]");
    v("graze_mps", graze_mps, config::kNonNegative,
      "Undisturbed; 0.16 m/s that turn with the noise disperse animals as much as a step of 1 m "
      "with "
      "a probability of 5 % (Stroembom 2014) [m/s]");
    v("walk_mps", walk_mps, config::kNonNegative,
      "Away from whom it flees; median under a slow dog (tracks of Jadhav 2024) [m/s]");
    v("run_mps", run_mps, config::kNonNegative,
      "At most, if whom it flees from comes as fast; 99 % of the same tracks [m/s]");
  }
};

/// Cattle: flight distances of 1.5 to 7.6 m in feedlots, less of dairy cows, 30 m and more on the
/// range (Grandin); the weights of sheep, larger bodies, slower to turn.
HerdModel cattle_herd();

/// One of a herd, or whom it flees from.
struct HerdBody {
  Point2 position{0.0, 0.0};  ///< [m, map]
  Point2 velocity{0.0, 0.0};  ///< [m/s]
};

/// Whom an animal flees from when it comes nearer than `flight_m`.
struct HerdThreat {
  HerdBody body{};
  double flight_m = 12.0;
};

/// The velocity [m/s] that an animal wants. Undisturbed it grazes: it drifts with the noise and
/// keeps its spacing. With a threat inside its flight distance it goes along the weighted sum of
/// unit vectors: away from threats, away from those inside its spacing, towards its neighbours,
/// along their headings, noise; at a walk, or as fast as the threat comes on, up to a run.
/// `neighbors`: the nearest of its herd, without itself; `noise`: a unit vector (turned_noise).
/// Zero or finite for finite input. Deterministic, does not allocate; about 5 ns per neighbour.
Point2 herd_velocity(const HerdModel& model, const HerdBody& self,
                     std::span<const HerdBody> neighbors, std::span<const HerdThreat> threats,
                     const Point2& noise);

/// The velocity after `dt` [s] of an animal that wants `wanted`: inertia.
Point2 respond(const HerdModel& model, const Point2& velocity, const Point2& wanted, double dt);

/// Turns an animal's noise, a unit vector, by a random walk over `dt` [s].
Point2 turned_noise(const HerdModel& model, const Point2& noise, double dt, RandomStream& random);

}  // namespace headland
