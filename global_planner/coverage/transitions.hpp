// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/base/result.hpp"
#include "core/geometry/path.hpp"
#include "core/geometry/region.hpp"
#include "core/model/drive_cost.hpp"
#include "core/world/farm.hpp"
#include "core/world/ground.hpp"
#include "global_planner/roadmap/goal_graph.hpp"

namespace headland {

struct TransitionOptions {
  CostWeights objective = Objective::kEnergy;
  double margin_m = 0.1;    ///< kept between the outline and the edge of the drivable area
  bool reeds_shepp = true;  ///< turns may reverse (if the vehicle can)
  bool fishtail = true;
  double max_lead_m = 12.0;  ///< a turn may run straight on this far beyond a row's end
};

/// Drivable ways between all pairs of sites of a farm for one vehicle, each verified with the
/// vehicle's outline: headland turns (Pi, Omega, fishtail, Reeds-Shepp) between near row ends, and
/// for all others the best way along headlands, roads and gates.
///
/// Ways are chosen for the objective over the ground: the headland turn that is cheapest on flat
/// ground, and among ways over lanes the cheapest over the terrain.
///
/// Rows (as wide as their spacing) may be entered only along themselves: the outline must stay in
/// the drivable area less the rows other than the two that the way joins.
class Transitions {
 public:
  /// Error kTurnDoesNotFit names the first row end from which nothing can be reached, with the
  /// turning radius and the room there is.
  static Result<Transitions> build(const Farm& farm, const Ground& ground,
                                   const std::vector<RowRef>& rows, const std::vector<Site>& stops,
                                   const Vehicle& vehicle, const TransitionOptions& options = {});
  ~Transitions();
  Transitions(Transitions&&) noexcept;
  Transitions& operator=(Transitions&&) noexcept;

  /// Sites: ends of row r are 2 r and 2 r + 1, then the stops.
  int sites() const;
  const Site& site(int index) const;
  /// How far the vehicle can drive straight on from a site, or come straight up to it [m]; negative
  /// if it does not fit there.
  double free_run(int site, bool leaving) const;
  /// Cost of the way from `from`'s departure to `to`'s arrival; infinite value where there is none.
  DriveCost cost(int from, int to) const;
  /// kTurn for one manoeuvre in a headland, kTransit for a longer way.
  LegKind kind(int from, int to) const;
  /// Offers another way, a path from `from`'s departure to `to`'s arrival; taken (true) where there
  /// is none yet, or a dearer one, if the slopes allow it.
  bool offer(int from, int to, Path path);
  /// The way itself; empty where there is none. Leg numbers are 0.
  Path path(int from, int to) const;
  /// cost(i, j).value(objective) of all pairs.
  Eigen::MatrixXd matrix() const;

 private:
  struct Impl;
  explicit Transitions(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The path along a row's line in the given direction, corners of the survey rounded with `radius`.
Path row_path(const Row& row, int entry, double radius);

}  // namespace headland
