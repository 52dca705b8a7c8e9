// SPDX-License-Identifier: Apache-2.0
#include "apps/route_output.hpp"

#include <cmath>
#include <cstdlib>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace headland::apps {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> ids(const RouteInstance& instance, const TourRoute& route) {
  std::vector<std::string> ids = {instance.start_name};
  for (const TourStop& stop : route.stops) {
    ids.push_back(stop.task >= 0 ? instance.task_names[static_cast<std::size_t>(stop.task)]
                                 : instance.station_names[static_cast<std::size_t>(stop.station)]);
  }
  ids.push_back(instance.finish_name);
  return ids;
}

// The step between scores: 0 if they are no whole numbers.
long score_step(const RouteInstance& instance) {
  long step = 0;
  if (!instance.whole_costs) return 0;
  for (const TourTask& task : instance.problem.tasks)
    step = std::gcd(step, std::lround(task.reward));
  return step;
}

void set_scores(RouteAnswer& answer, const RouteInstance& instance, const TourSolution& solution) {
  double total = 0.0;
  for (const TourTask& task : instance.problem.tasks) total += task.reward;
  answer.cost = 0.0;
  for (const DroppedTask& drop : solution.dropped) {
    const auto task = static_cast<std::size_t>(drop.task);
    answer.cost += instance.problem.tasks[task].reward;
    answer.left_out.push_back(instance.task_names[task]);
  }
  answer.score = total - answer.cost;
  // The bound of score and driving together, less the most that driving can add to it.
  double driven = 0.0;
  for (const TourVehicle& v : instance.problem.vehicles) driven += instance.tie_break * v.latest_s;
  answer.score_bound = std::min(total, total - (solution.lower_bound - driven));
  if (const auto step = static_cast<double>(score_step(instance)); step > 0.0) {
    answer.score_bound = step * std::floor(answer.score_bound / step + 1e-9);
  }
  if (solution.optimal) answer.score_bound = answer.score;
  answer.score_bound = std::max(answer.score_bound, answer.score);
  answer.lower_bound = total - answer.score_bound;
  answer.optimal = answer.score_bound == answer.score;
}

void set_fleet(RouteAnswer& answer, const RouteInstance& instance, const TourSolution& solution) {
  const double fixed = instance.problem.vehicles.front().fixed_cost;
  answer.cost -= fixed * answer.vehicles;
  // All ways together cost less than a vehicle.
  answer.vehicles_bound = std::max(0, static_cast<int>(std::floor(solution.lower_bound / fixed)));
  answer.lower_bound = std::max(0.0, solution.lower_bound - fixed * answer.vehicles);
}

Json id_json(const RouteInstance& instance, const std::string& id) {
  return instance.numeric_names ? Json(std::stol(id)) : Json(id);
}

std::string cost_text(const RouteInstance& instance, const RouteAnswer& answer) {
  switch (instance.objective) {
    case RouteObjective::kScore:
      return fmt::format("score      {:g}, no tour scores more than {:g}\n", answer.score,
                         answer.score_bound);
    case RouteObjective::kFleetThenDistance:
      return fmt::format("vehicles   {}, no fewer than {} do\ncost       {:.6f}, at least {:.6f}\n",
                         answer.vehicles, answer.vehicles_bound, answer.cost, answer.lower_bound);
    case RouteObjective::kDistance:
      break;
  }
  return fmt::format("cost       {:.6f}, at least {:.6f}\n", answer.cost, answer.lower_bound);
}

}  // namespace

RouteAnswer route_answer(const RouteInstance& instance, const TourSolution& solution,
                         double seconds) {
  RouteAnswer answer;
  answer.cost = solution.cost;
  answer.lower_bound = solution.lower_bound;
  answer.optimal = solution.optimal;
  answer.vehicles = static_cast<int>(solution.routes.size());
  answer.seconds = seconds;
  for (const TourRoute& route : solution.routes) answer.routes.push_back(ids(instance, route));
  if (instance.objective == RouteObjective::kScore) {
    set_scores(answer, instance, solution);
  } else if (instance.objective == RouteObjective::kFleetThenDistance) {
    set_fleet(answer, instance, solution);
  } else if (instance.whole_costs) {
    answer.lower_bound = std::min(answer.cost, std::ceil(answer.lower_bound - 1e-6));
    answer.optimal = answer.lower_bound == answer.cost;
  }
  return answer;
}

std::string route_json(const RouteInstance& instance, const RouteAnswer& answer,
                       const Stamp& stamp) {
  Json document = {{"name", instance.name},
                   {"format", instance.format},
                   {"cost", answer.cost},
                   {"lower_bound", answer.lower_bound},
                   {"gap_ratio", answer.gap_ratio()},
                   {"optimal", answer.optimal},
                   {"seconds", std::round(1e3 * answer.seconds) / 1e3},
                   {"vehicles", answer.vehicles}};
  if (instance.objective == RouteObjective::kFleetThenDistance) {
    document["vehicles_lower_bound"] = answer.vehicles_bound;
  }
  if (instance.objective == RouteObjective::kScore) {
    document["score"] = answer.score;
    document["score_upper_bound"] = answer.score_bound;
  }
  document["routes"] = Json::array();
  for (const auto& route : answer.routes) {
    Json json = Json::array();
    for (const std::string& id : route) json.push_back(id_json(instance, id));
    document["routes"].push_back(std::move(json));
  }
  document["left_out"] = Json::array();
  for (const std::string& id : answer.left_out) {
    document["left_out"].push_back(id_json(instance, id));
  }
  document["headland"] = {{"version", stamp.version},
                          {"seed", stamp.seed},
                          {"config_hash", stamp.config_hash},
                          {"config_yaml", stamp.config_yaml}};
  return document.dump(2) + "\n";
}

std::string route_text(const RouteInstance& instance, const RouteAnswer& answer) {
  std::string text = fmt::format("instance   {} ({}), {} places to visit\n", instance.name,
                                 instance.format, instance.task_names.size()) +
                     cost_text(instance, answer) +
                     fmt::format("status     {}, found in {:.2f} s\n",
                                 answer.optimal ? "optimal, proven"
                                                : fmt::format("feasible, gap {:.2f} %",
                                                              100.0 * answer.gap_ratio()),
                                 answer.seconds);
  for (std::size_t r = 0; r < answer.routes.size(); ++r) {
    text += fmt::format("route {:<4} {}\n", r + 1, fmt::join(answer.routes[r], " "));
  }
  return text;
}

std::string route_sol(const RouteAnswer& answer) {
  std::string text = fmt::format("{}\n", answer.cost);
  for (const auto& route : answer.routes) text += fmt::format("{}\n", fmt::join(route, ", "));
  return text;
}

}  // namespace headland::apps
