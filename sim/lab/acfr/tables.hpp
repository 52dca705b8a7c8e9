// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/lab/study_result.hpp"

namespace headland {

/// Tables I, II and III of seed 003 from the study's cells, the paper's figures in brackets.
void add_acfr_tables(StudyResult& result);

}  // namespace headland
