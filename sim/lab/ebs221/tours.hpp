// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/lab/ebs221/field.hpp"

namespace headland {

enum class TurnCosts {
  kSeed,  ///< (002) part B: Pi = pi R + (d - 1) W, Omega = 2 pi R
  kTrue,  ///< length of the shortest forward turn
};

/// Cost of a turn between rows `jump` apart [m].
double turn_cost(const Ebs221Field& field, double radius, TurnCosts costs, int jump);

/// (002) part B: turns on one headland only, the depot at its Manhattan distance, rows free.
RowTourProblem tour_problem(const Ebs221Field& field, double radius, TurnCosts costs);

}  // namespace headland
