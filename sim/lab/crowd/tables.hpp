// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <string_view>
#include <vector>

#include "sim/lab/crowd/episode.hpp"
#include "sim/lab/study_result.hpp"

namespace headland {

constexpr std::string_view kHolonomicOrca = "orca_holonomic";

/// Episodes by how many people there are, as others report them.
struct CrowdSize {
  std::string_view suffix;  ///< of metrics
  double least = 0.0;
  double most = std::numeric_limits<double>::max();
};
constexpr std::array<CrowdSize, 3> kCrowdSizes = {
    {{"_2_4", 2.0, 4.0}, {"_5_8", 5.0, 8.0}, {"_9_11", 9.0, 11.0}}};

/// Tables of a crowd study, from its cells: all planners beside the published results,
/// and success by crowd size.
void add_crowd_tables(StudyResult& result);

/// The first planner beside each other one on the same scenarios (McNemar). `outcomes`: of each
/// cell, run by run.
void add_paired_table(StudyResult& result, const std::vector<std::vector<CrowdOutcome>>& outcomes);

/// Success by the number of people, of each cell.
void add_people_plot(StudyResult& result, const std::vector<std::vector<CrowdOutcome>>& outcomes);

}  // namespace headland
