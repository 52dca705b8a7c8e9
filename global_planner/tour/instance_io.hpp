// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "global_planner/tour/tour_problem.hpp"

namespace headland {

/// What a routing instance asks for; says how its cost is read.
enum class RouteObjective {
  kDistance,           ///< the ways' length
  kFleetThenDistance,  ///< fewest vehicles first: each costs more than any tour is long
  kScore,              ///< most score within a length: cost is the score lost
};

/// A routing instance of the literature as a TourProblem, with its own names for places.
///
/// | format | becomes |
/// |---|---|
/// | TSPLIB TSP, ATSP | node 1 is where the vehicle starts and finishes, the others are tasks |
/// | EVRP (CEC-12) | as many vehicles as can be of use; full at once at stations and the depot |
/// | E-VRPTW | partial charging at a constant rate; `fixed_cost` puts the fleet's size first |
/// | OP, TSPLIB OP | durations are lengths, latest_s the budget; cost: the score lost, and a share
///   of `tie_break` for each unit driven, which sums to less than any difference in score |
struct RouteInstance {
  std::string name;    ///< of the file, without its ending
  std::string format;  ///< ATSP, TSP, EVRP, E-VRPTW or OP
  RouteObjective objective = RouteObjective::kDistance;
  TourProblem problem;
  std::vector<std::string> task_names;  ///< ids as the file writes them
  std::vector<std::string> station_names;
  std::string start_name;
  std::string finish_name;
  bool numeric_names = true;  ///< all ids are whole numbers
  bool whole_costs = false;   ///< every distance (kScore: every score) is a whole number
  double tie_break = 0.0;     ///< cost of a unit driven where scores count
};

/// Reads a routing instance; its format is recognised by the content. Errors name file, line and
/// what is allowed there.
Result<RouteInstance> load_instance(const std::filesystem::path& path);

/// The same from text; `file` is what errors name.
Result<RouteInstance> parse_instance(const std::string& file, const std::string& text);

}  // namespace headland
