// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "sim/lab/polito_study.hpp"

namespace headland {

/// RA [1/m] that (004) prints for an accuracy of the position fix [m].
struct PublishedAccuracy {
  double accuracy_m = 0.0;
  double ra_1pm = 0.0;            ///< Table 2
  double ra_threshold_1pm = 0.0;  ///< Table 3: with the 2.5 deg threshold
};
inline constexpr std::array<PublishedAccuracy, 5> kPublishedAccuracies = {{{0.0, 0.34, 0.7232},
                                                                           {0.01, 0.0272, 0.6421},
                                                                           {0.02, 0.0317, 0.6219},
                                                                           {0.05, 0.0316, 0.3022},
                                                                           {0.1, 0.0273, 0.0601}}};

/// `LD_0.75`, `noise_0.02`: a name and a number as the cells' keys spell them.
std::string cell_key(const std::string& name, double value);

/// Figs. 15, 16 and 18 of (004) from the cells of the grid.
void add_grid_plots(const PolitoStudyConfig& config, StudyResult& result);

/// Tables 2 and 3 of (004) beside what was measured here, from the track cells.
void add_accuracy_table(const PolitoStudyConfig& config, StudyResult& result);

/// The baseline's figures beside what (004) prints of it.
void add_baseline_table(StudyResult& result);

/// The part of a drive around the first hairpin, for Figs. 17, 19 and 22.
PlotSeries hairpin_series(const std::string& name, const ParametricOrchardConfig& orchard,
                          const std::vector<Point2>& positions);

}  // namespace headland
