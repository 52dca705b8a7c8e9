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

/// The value below which the share `fraction` of the sample lies, linear between its values.
/// Requires a value and a fraction in [0, 1].
double quantile(std::vector<double> sample, double fraction);

/// Mean of the lowest 5 % of a sample, of at least one value (conditional value at risk): how bad
/// the bad cases are where little is bad. Requires a value.
double cvar5(std::vector<double> sample);

/// A share with Wilson's 95 % interval (1927), which holds near 0 and 1 too. Requires
/// 0 <= hits <= count and count > 0.
Statistic proportion(int hits, int count);

/// Exact McNemar test of two methods on the same cases: how probable it is that cases on which only
/// one succeeds are shared out as unevenly as `only_first` to `only_second`, or more so, if both
/// are equally good. In (0, 1]; both >= 0.
double mcnemar(int only_first, int only_second);

}  // namespace headland
