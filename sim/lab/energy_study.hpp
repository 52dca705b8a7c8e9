// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "core/model/vehicle.hpp"
#include "core/world/terrain.hpp"
#include "sim/lab/study_result.hpp"

namespace headland {

/// What planning for energy saves on hills: on each of many seeded terrains, the tour of least
/// energy through random goals beside the shortest tour, both priced by the same model (003,
/// III-A).
struct EnergyStudyConfig {
  std::string study = "energy";
  int seed = 1;
  int runs_count = 20;          ///< terrains
  double side_m = 500.0;        ///< of the square pasture
  int goals_count = 10;         ///< and a charger, where the tour begins and ends
  double relief_m = 30.0;       ///< highest less lowest point
  double wavelength_m = 150.0;  ///< of the largest hills
  double cell_m = 2.0;          ///< of the terrain
  int samples_count = 4000;     ///< poses of the roadmap
  /// The vehicle with these recuperation efficiencies; many field robots have none.
  std::vector<double> recuperations_ratio = {0.0, 0.3, 0.6};
  Vehicle vehicle;

  std::optional<Error> check() const;

  template <class V>
  void visit(V& v) {
    v("study", study, "Which study this file is for");
    v("seed", seed, config::Range{0, 1000000000}, "Of terrains, goals and roadmaps");
    v("runs_count", runs_count, config::Range{1, 10000}, "Terrains");
    v("side_m", side_m, config::Range{50.0, 5000.0}, "Of the square pasture [m]");
    v("goals_count", goals_count, config::Range{2, 15}, "Goals of a tour");
    v("relief_m", relief_m, config::Range{0.0, 1000.0}, "Highest less lowest point [m]");
    v("wavelength_m", wavelength_m, config::Range{10.0, 5000.0}, "Of the largest hills [m]");
    v("cell_m", cell_m, config::Range{0.1, 50.0}, "Of the terrain [m]");
    v("samples_count", samples_count, config::Range{10, 100000}, "Poses of the roadmap");
    v("recuperations_ratio", recuperations_ratio, config::kFraction,
      "Recuperation efficiencies of the vehicle, a group of cells each");
    v("vehicle", vehicle, "Who drives");
  }
};

/// For each recuperation efficiency E the cells `recuperation_E/saving` (energy_ratio: what the
/// tour of least energy uses less, over what the shortest uses; length_ratio: what it is longer),
/// `recuperation_E/tour/energy` and `recuperation_E/tour/length` (energy_j, length_m, climb_m).
/// `jobs` terrains at once; deterministic whatever their number.
Result<StudyResult> run_energy_study(const EnergyStudyConfig& config, int jobs = 1);

}  // namespace headland
