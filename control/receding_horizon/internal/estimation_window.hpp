// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "control/estimation/estimation_log.hpp"

namespace headland::control::internal {

// One noise block: from grid point `first` to `last`.
struct NoiseBlock {
  int first = 0;
  int last = 0;
  Eigen::Vector3d trust = Eigen::Vector3d::Ones();  // weight of the slip's change in it
  EstimateMatrix own;                               // Hessian of the state at its begin
  EstimateMatrix coupling;                          // with the state at its end
  EstimateVector slope;                             // of the cost, by the state at its begin
  EstimateVector step;
};

// The trajectory over the window from the log's base to now, and the Gauss-Newton steps that make
// it fit: block-tridiagonal in the states at the borders of noise blocks. Model and log must
// outlive it. Does not allocate after construction.
class EstimationWindow {
 public:
  // `stride`: cycles an interval; `most`: intervals in a full window; `block_lengths`: intervals of
  // its blocks, oldest first.
  EstimationWindow(const EstimationModel& model, const EstimationLog& log, int stride, int most,
                   const std::vector<int>& block_lengths);

  // Forgets the trajectory: it begins anew with `state`, at the log's base.
  void begin_at(const EstimateVector& state);
  // The log's base has moved on by so many intervals.
  void drop_oldest(std::ptrdiff_t intervals);
  // To the log's now: by what the commands promise, and in blocks anew.
  void extend();
  // Student's t: the larger a change of the slip came out, the less it is held against it.
  void weigh_changes(double freedom);
  // The slip's changes in the last `seconds` [s] weigh `weight` at most.
  void doubt_the_newest(double seconds, double weight);
  // One Gauss-Newton step; `prior` knows the state at the begin. False without a finite answer; the
  // trajectory is then as it was.
  bool improve(const KalmanFilter& prior);

  int length() const {  // [intervals]
    return static_cast<int>((log_.now() - log_.base()) / stride_);
  }
  const EstimateVector& newest() const { return grid_[static_cast<std::size_t>(length())]; }
  const EstimateVector& variance() const { return variance_; }  // of the newest state
  const Eigen::Vector3d& oldest_trust() const { return blocks_[0].trust; }

  // The parts of a step, for tests: cost, slopes and Hessian at the trajectory.
  void guess_answers();
  void linearise(const KalmanFilter& prior);
  double cost() const { return cost_; }
  int block_count() const { return block_count_; }
  NoiseBlock& block(int b) { return blocks_[static_cast<std::size_t>(b)]; }
  EstimateVector& grid(int j) { return grid_[static_cast<std::size_t>(j)]; }

 private:
  // Along a block: the state, and the pose's derivatives to pose and drive at the block's begin and
  // to the drive at its end.
  struct Chain;
  // The drive at a fraction of interval j, and its derivative (diagonal) to that at the block's
  // begin; that to the drive at its end is the share of the block that is behind.
  struct Within {
    Drive<double> drive;
    Drive<double> by_begin;
    double by_end = 0.0;
  };
  Within within(const NoiseBlock& block, int j, double fraction) const;
  void lay_blocks();
  void guess_grid();
  void add_block(NoiseBlock& begin, NoiseBlock& end);
  void add_measurements(NoiseBlock& from, NoiseBlock& to, int j, Chain& chain);
  void add_transition(NoiseBlock& begin, NoiseBlock& end, const Chain& chain);
  void add_bounds(NoiseBlock& at);
  bool solve_steps();
  void take_steps();

  const EstimationModel& model_;
  const EstimationLog& log_;
  int stride_;
  std::vector<int> block_lengths_;
  std::vector<EstimateVector> grid_;     // trajectory at the intervals' borders
  std::vector<ActuatorAnswer> answers_;  // to the commands, from the block's begin to here
  std::vector<NoiseBlock> blocks_;       // the last one is the window's end
  int block_count_ = 0;                  // without that
  int grid_length_ = 0;
  std::span<const Measurement>::iterator next_measurement_;
  EstimateVector variance_ = EstimateVector::Zero();
  double cost_ = 0.0;
};

}  // namespace headland::control::internal
