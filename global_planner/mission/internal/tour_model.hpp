// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "global_planner/coverage/transitions.hpp"
#include "global_planner/mission/mission_config.hpp"
#include "global_planner/tour/tour_problem.hpp"

namespace headland::mission {

/// A row, or a stretch of one where no battery lasts for the whole, or a visit.
struct ModelTask {
  int row = -1;        ///< in Mission::rows
  int visit = -1;      ///< in Mission::visits
  double begin = 0.0;  ///< of the stretch, as a fraction of the row from its first end
  double end = 1.0;
};

/// A mission as a tour problem: what the engine's sites, tasks and profiles stand for, and the ways
/// and paths behind its numbers.
///
/// Sites are the ends of rows (2 r and 2 r + 1), the vehicles' starts, their finishes, the
/// chargers, the visits, and then two for each place where a row is cut: one for each direction of
/// driving. From a cut a vehicle drives on along the row, implement up, to its end, and it comes to
/// a cut from the row's end.
class TourModel {
 public:
  /// Errors: kNoPath, kTurnDoesNotFit, kTooSteep, kOffTerrain, kEnergyInfeasible: each names the
  /// row, place or vehicle.
  static Result<TourModel> build(const Mission& mission);

  const Mission& mission() const { return *mission_; }
  const TourProblem& problem() const { return problem_; }
  const std::vector<ModelTask>& tasks() const { return tasks_; }

  int start(int vehicle) const { return 2 * rows() + vehicle; }
  int finish(int vehicle) const { return start(vehicle) + vehicles(); }
  int charger(int c) const { return finish(vehicles()) + c; }
  int visit(int v) const { return charger(chargers()) + v; }

  /// "row north/r3 from 40 m to 85 m", "visit gate-7"; for legs: without the first word.
  std::string task_name(int task) const;
  std::string leg_id(int task) const;
  std::string site_name(int site) const;
  /// A text of the solver, which speaks of "task 4", with the row's or place's name there; without
  /// "task 4: " at its beginning if the name stands beside it already.
  std::string named(std::string text, bool keep_subject) const;

  DriveCost way_cost(int vehicle, int from, int to) const;
  LegKind way_kind(int vehicle, int from, int to) const;
  /// Empty where the sites lie in the same pose.
  Path way_path(int vehicle, int from, int to) const;
  DriveCost work_cost(int vehicle, int task, int mode) const;
  Path work_path(int vehicle, int task, int mode) const;
  /// Energy [J] to be had at a site to reach the nearest charger; 0 if the farm has none, infinite
  /// if none can be reached.
  double escape_j(int vehicle, int site) const;

 private:
  // A place where a row is cut, as one direction of driving meets it.
  struct Cut {
    int row = 0;
    double at = 0.0;  // fraction of the row from its first end
    int entry = 0;    // end by which the row is entered
  };
  struct Profile {
    int vehicle = 0;  // one of those it stands for
    Transitions ways;
    std::vector<std::vector<DriveCost>> work;  // of task, mode
  };

  explicit TourModel(const Mission& mission) : mission_(&mission) {}
  int rows() const { return static_cast<int>(mission_->rows.size()); }
  int vehicles() const { return static_cast<int>(mission_->vehicles.size()); }
  int chargers() const { return static_cast<int>(mission_->farm.chargers.size()); }
  int visits() const { return static_cast<int>(mission_->visits.size()); }
  int base_sites() const { return visit(visits()); }
  const Vehicle& vehicle_of(const Profile& profile) const;
  const Profile& profile_of(int vehicle) const;
  double margined(double energy) const;

  Result<void> build_profiles();
  Result<void> split_rows();
  std::optional<Error> row_error(const Profile& profile) const;
  bool lasts(const Profile& profile, int vehicle, int row, double begin, double end,
             double& short_j) const;
  Result<std::vector<double>> cuts_of(int row) const;
  void price_work();
  const TaskTerms& terms_of(const ModelTask& task) const;
  void build_problem();
  TourLeg tour_leg(const DriveCost& cost) const;
  TourProfile tour_profile(const Profile& profile) const;
  TourVehicle tour_vehicle(int vehicle) const;

  const Cut* cut_of(int site) const;
  static bool ahead(const Cut* a, const Cut* b);
  std::optional<TourMode> outside(const Profile& profile, int from, int to) const;
  int cut_site(int row, double at, int entry) const;
  Path row_stretch(const Vehicle& vehicle, int row, int entry, double from, double to) const;
  DriveCost price(const Vehicle& vehicle, const Path& path, LegKind kind) const;
  DriveCost way(const Profile& profile, int from, int to) const;

  const Mission* mission_;
  std::vector<Profile> profiles_;
  std::vector<int> profile_of_vehicle_;
  std::vector<ModelTask> tasks_;
  std::vector<Cut> cuts_;  // of the sites after the base sites
  TourProblem problem_;
};

}  // namespace headland::mission
