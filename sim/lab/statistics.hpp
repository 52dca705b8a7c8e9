// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/lab/study_result.hpp"

namespace headland {

/// Two-sided 95 % quantile of Student's t for `freedom` >= 1 degrees of freedom.
double student_t_95(int freedom);

/// Mean, median, standard deviation, 95th percentile (interpolated) and the 95 % interval of the
/// mean (Student's t) of a sample; of a single value only the mean. Requires a value.
Statistic summarize(std::vector<double> sample);

}  // namespace headland
