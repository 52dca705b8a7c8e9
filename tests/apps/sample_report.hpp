// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/report.hpp"

namespace headland {

/// A synthetic run over `rows` rows of 120 m with `samples` samples: every part of the page in use.
Report sample_report(int rows, int samples);

/// A synthetic plan of three vehicles over hills, with charge stops and reasons.
Report sample_fleet_report();

}  // namespace headland
