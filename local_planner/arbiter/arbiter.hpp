// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <utility>

#include "core/config/visit.hpp"
#include "local_planner/local_planner.hpp"
#include "local_planner/outline.hpp"
#include "local_planner/rollout.hpp"

namespace headland {

/// Who drives.
enum class Driving {
  kPath,  ///< the global path is followed; the fail-safe beneath slows down for agents
  kLocal  ///< the local planner, around agents
};

struct ArbiterConfig {
  double horizon_s = 5.0;
  double take_m = 1.0;
  double give_m = 1.5;
  double hold_s = 1.0;
  double rejoin_m = 0.3;
  double rejoin_deg = 15.0;
  double wait_s = 20.0;
  double scarce_ratio = 0.1;
  double dense_per_m2 = 0.1;
  double density_radius_m = 10.0;

  template <class V>
  void visit(V& v) {
    v("horizon_s", horizon_s, config::Range{0.5, 30.0}, "The path is looked at so far ahead [s]");
    v("take_m", take_m, config::Range{0.0, 10.0},
      "The local planner takes over if on the path an agent would come nearer than this [m]");
    v("give_m", give_m, config::Range{0.0, 20.0},
      "... and gives back when none would come nearer than this ... [m]");
    v("hold_s", hold_s, config::Range{0.0, 60.0}, "... for so long [s],");
    v("rejoin_m", rejoin_m, config::kPositive, "the vehicle is so near to its path [m]");
    v("rejoin_deg", rejoin_deg, config::Range{0.1, 180.0}, "and heads along it within this [deg]");
    v("wait_s", wait_s, config::Range{0.0, 3600.0},
      "With no energy to spare and nobody else about, it waits so long before it drives around "
      "somebody; with energy to spare, or in a crowd, not at all [s]");
    v("scarce_ratio", scarce_ratio, config::Range{0.0, 1.0},
      "Energy to spare, over the battery's capacity, at which it no longer waits; 0: never waits");
    v("dense_per_m2", dense_per_m2, config::kPositive,
      "Agents per area at which it no longer waits: they would not clear [1/m2]");
    v("density_radius_m", density_radius_m, config::kPositive,
      "The crowd's density is that within this distance [m]");
  }
};

/// What the arbiter goes by beside the scene and the path.
struct ArbiterView {
  double spare_ratio = 1.0;  ///< energy left above what the tour and the reserve need, over the
                             ///< battery's capacity
  bool may_leave = true;     ///< the vehicle may leave the path here; not within rows
};

/// Says who drives: the global path is left when somebody is about to be on it, and taken up again
/// when it has been free for a while and the vehicle is back on it (hysteresis in distance and in
/// time). Seed 003 (V) notes that waiting saves energy and that a responsive planner saves time,
/// more so in dense crowds, and leaves the choice open; here the wait before the path is left grows
/// as energy gets scarce, and shrinks with the crowd's density.
/// One object per robot, called in order of time; after a pause of over a second, or a step back in
/// time, nobody has been in the way yet, nor has the path been free. Deterministic; does not
/// allocate after the first call; about 20 us and 1 us an agent.
class Arbiter {
 public:
  Arbiter(const Vehicle& vehicle, const ArbiterConfig& config = {});

  /// For the scene at its time. `goal` as for the local planner; without a path, the local planner
  /// drives. A scene that holds anything but numbers, or is old, changes nothing: the fail-safe
  /// stops for it.
  Driving decide(const LocalScene& scene, const LocalGoal& goal, const ArbiterView& view = {});

  Driving driving() const { return driving_; }
  /// How long somebody has to be in the way before the path is left [s].
  double wait(double spare_ratio) const;
  int takeovers() const { return takeovers_; }

 private:
  void look_along(const LocalScene& scene, const LocalGoal& goal);
  bool back_on_path(const LocalScene& scene, const LocalGoal& goal) const;

  Vehicle vehicle_;
  ArbiterConfig config_;
  Driving driving_ = Driving::kPath;
  double gap_ = 1e3;                    // the nearest that anyone would come on the path [m]
  double density_ = 0.0;                // agents per area around the robot [1/m2]
  double looked_s_ = -1e9;              // when
  std::optional<double> in_way_since_;  // [s]; none: nobody is
  std::optional<double> free_since_;    // [s]; none: it is not
  int takeovers_ = 0;
  LocalPlan ahead_;  // along the path, if nobody were there
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::Driving> {
  static constexpr std::pair<headland::Driving, std::string_view> values[] = {
      {headland::Driving::kPath, "path"}, {headland::Driving::kLocal, "local"}};
};
