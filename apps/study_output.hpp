// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "apps/command.hpp"
#include "sim/lab/study_result.hpp"

namespace headland::apps {

struct FinishedStudy {
  StudyResult result;
  Stamp stamp;
};

/// results.json (DESIGN section 5).
std::string results_json(const FinishedStudy& study);
/// One line per cell and metric.
std::string cells_csv(const StudyResult& result);
/// The study's tables, or where it has none a line per cell, for a person.
std::string study_text(const StudyResult& result);

}  // namespace headland::apps
