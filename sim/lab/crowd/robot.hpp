// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/model/kinematics.hpp"
#include "core/model/orca.hpp"
#include "core/world/agent.hpp"
#include "local_planner/local_planner.hpp"

namespace headland {

/// The robot of an episode, with whoever drives it.
class EpisodeRobot {
 public:
  virtual ~EpisodeRobot() = default;
  virtual Point2 position() const = 0;  ///< [m]
  virtual Point2 velocity() const = 0;  ///< [m/s]
  /// Decides by what it sees at `time_s`.
  virtual void decide(double time_s, std::span<const Agent> agents) = 0;
  /// Drives on as decided, from `time_s` for `dt` [s].
  virtual void move(double time_s, double dt) = 0;
};

/// A disc that goes any way at once, by ORCA as people do (0.11 m added to radii, horizon 5 s): the
/// measure of the scenarios, not of our vehicles.
class HolonomicOrcaRobot : public EpisodeRobot {
 public:
  HolonomicOrcaRobot(const Point2& start, const Point2& goal) : position_(start), goal_(goal) {}

  Point2 position() const override { return position_; }
  Point2 velocity() const override { return velocity_; }
  void decide(double time_s, std::span<const Agent> agents) override;
  void move(double time_s, double dt) override;

 private:
  Point2 position_;
  Point2 goal_;
  Point2 velocity_{0.0, 0.0};
  std::vector<VelocityLine> lines_;
  std::vector<VelocityLine> scratch_;
};

/// A vehicle that does what a local planner plans, within its limits. It starts at a stand and
/// faces its goal.
class PlannedRobot : public EpisodeRobot {
 public:
  PlannedRobot(const Vehicle& vehicle, std::unique_ptr<LocalPlanner> planner,
               const PlanBudget& budget, const Point2& start, const Point2& goal);

  Point2 position() const override { return {state_.pose.x, state_.pose.y}; }
  Point2 velocity() const override;
  void decide(double time_s, std::span<const Agent> agents) override;
  void move(double time_s, double dt) override;

 private:
  const Vehicle& vehicle_;
  std::unique_ptr<LocalPlanner> planner_;
  PlanBudget budget_;
  LocalGoal goal_;
  VehicleState state_;
  LocalPlan plan_;
};

}  // namespace headland
