// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "apps/command.hpp"
#include "global_planner/tour/instance_io.hpp"

namespace headland::apps {

/// A routing instance's answer in the instance's own terms.
struct RouteAnswer {
  double cost = 0.0;         ///< length; of orienteering the score lost
  double lower_bound = 0.0;  ///< of that; where vehicles come first, of a fleet of this size
  bool optimal = false;
  int vehicles = 0;
  int vehicles_bound = 0;    ///< kFleetThenDistance: no fewer vehicles do
  double score = 0.0;        ///< kScore
  double score_bound = 0.0;  ///< kScore: no tour scores more
  double seconds = 0.0;
  std::vector<std::vector<std::string>> routes;  ///< ids from start to finish, charges included
  std::vector<std::string> left_out;

  double gap_ratio() const { return cost > 0.0 ? (cost - lower_bound) / cost : 0.0; }
};

RouteAnswer route_answer(const RouteInstance& instance, const TourSolution& solution,
                         double seconds);

std::string route_json(const RouteInstance& instance, const RouteAnswer& answer,
                       const Stamp& stamp);
std::string route_text(const RouteInstance& instance, const RouteAnswer& answer);
/// One line for the cost, then one for each route, ids between commas: what the verifiers of the
/// literature read.
std::string route_sol(const RouteAnswer& answer);

}  // namespace headland::apps
