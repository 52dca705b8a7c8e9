// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "apps/command.hpp"
#include "sim/lab/closed_loop.hpp"

namespace headland::apps {

/// metrics.json (DESIGN section 5).
std::string metrics_json(const Run& run, double real_time_factor, const Stamp& stamp);
/// trace.csv: a line every `period` [s]. Shortest decimals that read back to the same bits.
std::string trace_csv(const Run& run, double period);
/// A few lines for a person.
std::string run_text(const Run& run, double real_time_factor);

}  // namespace headland::apps
