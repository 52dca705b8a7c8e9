// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/report.hpp"

namespace headland {

/// A synthetic run over `rows` rows of 120 m with `samples` samples: every part of the page in use.
Report sample_report(int rows, int samples);

}  // namespace headland
