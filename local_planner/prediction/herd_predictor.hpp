// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "local_planner/prediction/companions.hpp"
#include "local_planner/prediction/nearest_agents.hpp"

namespace headland {

/// How animals of a herd go on from what they do now: their velocities relax to the mean of their
/// neighbours', they gather, slow down by themselves, flee from threats, and what made the herd
/// speed up or turn goes on for a second. Fitted on the sheep tracks of Jadhav et al. 2024 by the
/// errors at 0.4 to 4.8 s; core/model/herd is a model to live in, this one is to foretell with.
struct HerdResponse {
  double alignment_s = 0.7;
  double cohesion_s = 2.3;
  double slowing_s = 2.6;
  double persistence_s = 1.0;
  int neighbor_count = 13;
  double neighbor_m = 8.0;
  double flight_mps2 = 0.69;
  double dog_reach_m = 12.0;
  double person_reach_m = 2.0;
  double robot_reach_m = 3.0;
  double cattle_reach_ratio = 0.4;

  template <class V>
  void visit(V& v) {
    v("alignment_s", alignment_s, config::kPositive, "To the mean velocity of its neighbours [s]");
    v("cohesion_s", cohesion_s, config::kPositive,
      "Pulled to their centre by distance / cohesion_s^2 [s]");
    v("slowing_s", slowing_s, config::kPositive, "The neighbours' velocity dies down [s]");
    v("persistence_s", persistence_s, config::kPositive, "Their acceleration dies down [s]");
    v("neighbor_count", neighbor_count, config::Range{0, 1000}, "The nearest so many count");
    v("neighbor_m", neighbor_m, config::kPositive, "... if they are nearer than this [m]");
    v("flight_mps2", flight_mps2, config::kNonNegative,
      "Away from a threat: this times exp(-distance / reach) [m/s2]");
    v("dog_reach_m", dog_reach_m, config::kPositive, "Of a dog (tracks: 6 to 20 do as well) [m]");
    v("person_reach_m", person_reach_m, config::kPositive,
      "Of a person; at 3 m and more the tracks show no flight from the shepherd [m]");
    v("robot_reach_m", robot_reach_m, config::kPositive,
      "Of the robot and other vehicles: an assumption, as no tracks are known [m]");
    v("cattle_reach_ratio", cattle_reach_ratio, config::kNonNegative,
      "Reaches for cattle over those for sheep, as core/model/herd has them");
  }
};

struct HerdConfig {
  AgentFilterConfig filter;
  VelocityWalk spread{0.1, 0.4, 0.3, 1.0, 0.3};
  CompanionModel companions;
  HerdResponse herd;

  template <class V>
  void visit(V& v) {
    v("filter", filter, "Of the agents");
    v("spread", spread,
      "How far velocities wander after the last sight, beside the filter's doubt");
    v("companions", companions, "Of people");
    v("herd", herd, "Of sheep and cattle");
  }
};

/// Sheep and cattle as a herd that flees from dogs, people, vehicles and the robot on its path;
/// all others as CompanionPredictor has them. Takes about 50 ns per animal and 0.2 s and 3 ns per
/// neighbour and threat; does not allocate once its buffers have held as many.
class HerdPredictor : public Predictor {
 public:
  explicit HerdPredictor(const HerdConfig& config = {});

  void observe(std::span<const Agent> agents, const Point2& robot, const Point2& robot_velocity,
               double time_s) override;
  void predict(std::span<const Point2> robot_path, double step_s, int steps,
               Prediction& prediction) const override;
  bool reacts() const override { return true; }

 private:
  struct Body {
    Point2 position{0.0, 0.0};
    Point2 velocity{0.0, 0.0};
  };
  // Whom they flee from. The first is the robot.
  struct Threat {
    Body body;
    double reach = 1.0;
  };
  // Of an animal: itself among its neighbours.
  Body mean_of_neighbors(std::size_t animal) const;
  Point2 flight(const Body& body, double reach_ratio) const;
  void step(double t, double dt) const;

  HerdConfig config_;
  AgentFilter filter_;
  NearestAgents nearest_;
  Point2 robot_{0.0, 0.0};
  std::vector<Point2> velocities_;     // of all agents, with their companions
  std::vector<std::size_t> animals_;   // which of the agents are animals
  std::vector<Point2> positions_;      // of the animals
  std::vector<Point2> accelerations_;  // of the animals and their neighbours
  std::vector<Threat> threats_now_;
  // Scratch of a prediction.
  mutable std::vector<Body> herd_;
  mutable std::vector<Body> next_;
  mutable std::vector<Threat> threats_;
};

}  // namespace headland
