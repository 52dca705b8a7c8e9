// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "local_planner/prediction/agent_filter.hpp"
#include "local_planner/prediction/predictor.hpp"

namespace headland {

/// Whether steps of `step_s` [s] can be predicted: at least one, and none longer than 10 s.
bool can_predict(double step_s, int steps);

/// Makes room for all agents, writes who they are, and their covariances by what the filter does
/// not know and by `spread`. If that cannot be predicted, there are no steps. The means are left
/// to the caller.
void begin_prediction(std::span<const FilteredAgent> agents, const VelocityWalk& spread,
                      double step_s, int steps, Prediction& prediction);

/// The velocity [m/s] at which a robot at `position` gets to the place of its path that is due at
/// the end of step `step`; zero behind the end of the path, and for places that are no numbers.
Point2 velocity_along(std::span<const Point2> robot_path, int step, const Point2& position,
                      double step_s);

/// Into how many equal parts a step is cut, so that none is longer than `longest` [s].
int parts_of(double step_s, double longest);

}  // namespace headland
