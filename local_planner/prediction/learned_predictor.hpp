// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "local_planner/prediction/predictor.hpp"
#include "local_planner/prediction/response_features.hpp"
#include "local_planner/prediction/sight_history.hpp"

namespace headland {

/// The learned predictor of seed 003 (III-C.1): an LSTM encoder-decoder that has seen how all
/// agents and the robot moved, and moves all agents on together while the robot follows its path.
/// Per step it gives a change of velocity and a growth of covariance, so that a network that says
/// nothing is one of constant velocity, and covariances never shrink. It predicts rotated scenes
/// alike, but for agents that stand.
///
/// The window is encoded at each sight, from sights resampled to the network's step. One matrix
/// product per LSTM step for all agents. Deterministic. Does not allocate once it has seen as many
/// agents as there are, but for the products of networks beyond 100 kB a cell.
class LearnedPredictor : public Predictor {
 public:
  /// `robot_radius` [m]: that agents take the robot to have (seed 003: 1.5), >= 0.
  explicit LearnedPredictor(ResponseNetwork network, double robot_radius = 1.5);

  void observe(std::span<const Agent> agents, const Point2& robot, const Point2& robot_velocity,
               double time_s) override;
  void predict(std::span<const Point2> robot_path, double step_s, int steps,
               Prediction& prediction) const override;
  bool reacts() const override { return true; }

 private:
  struct Track {
    int id = 0;
    double radius_m = 0.0;
    double noise_m = 0.0;
    SightHistory history;
  };

  void forget(double time_s);
  void remember(const Agent& agent, double time_s);
  void look(const Point2& robot);
  void look_back(double time_s);
  void encode();
  void move_on(std::size_t step) const;
  void resample(double step_s, int steps, Prediction& prediction) const;

  ResponseNetwork network_;
  double robot_radius_m_;
  std::vector<Track> tracks_;
  SightHistory robot_;
  double time_s_ = 0.0;
  Point2 origin_{0.0, 0.0};

  // Of the last sight: who was seen (places in tracks_), where, and what the encoder made of it.
  std::vector<std::size_t> seen_;
  std::vector<CrowdMember> members_;
  CrowdMoment now_;
  LstmBatch encoded_;

  // Scratch; holds nothing from call to call.
  struct Rollout {
    CrowdMoment moment;
    ResponseInputs inputs;
    LstmBatch batch;
    Eigen::MatrixXf outputs;
    std::vector<Eigen::Vector2f> mean;  // [step of the network][agent], relative to origin_
    std::vector<Eigen::Matrix2f> covariance;
  };
  mutable Rollout rollout_;
};

}  // namespace headland
