// SPDX-License-Identifier: Apache-2.0
#include "apps/route_output.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/instance_texts.hpp"

namespace headland::apps {
namespace {

RouteInstance instance_of(const char* text) {
  return parse_instance("dir/small.txt", text).value();
}

// One route over the given tasks (-1 - s: a charge at station s).
TourSolution solution_of(const std::vector<int>& stops, double cost, double bound) {
  TourSolution solution;
  TourRoute route;
  for (const int stop : stops) {
    route.stops.push_back({stop >= 0 ? stop : -1, 0, stop >= 0 ? -1 : -1 - stop});
  }
  solution.routes = {route};
  solution.cost = cost;
  solution.lower_bound = bound;
  return solution;
}

TEST(RouteOutput, IdsAreTheFilesOwn) {
  const RouteInstance evrp = instance_of(testing::kEvrp);
  const RouteAnswer answer = route_answer(evrp, solution_of({0, -2, 1}, 20.0, 15.0), 0.5);
  EXPECT_EQ(answer.routes[0], (std::vector<std::string>{"1", "2", "4", "3", "1"}));
  EXPECT_DOUBLE_EQ(answer.gap_ratio(), 0.25);
  const auto json = nlohmann::json::parse(route_json(evrp, answer, make_stamp(3, "a: 1\n")));
  EXPECT_EQ(json["routes"][0], (nlohmann::json{1, 2, 4, 3, 1}));
  EXPECT_EQ(json["name"], "small");
  EXPECT_EQ(json["headland"]["seed"], 3);
  for (const char* key : {"cost", "lower_bound", "gap_ratio", "optimal", "seconds"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(route_sol(answer), "20\n1, 2, 4, 3, 1\n");

  const RouteInstance evrptw = instance_of(testing::kEvrptw);
  const RouteAnswer named = route_answer(evrptw, solution_of({1, -2, 0}, 1e5, 1e5), 0.5);
  EXPECT_EQ(named.routes[0], (std::vector<std::string>{"D0", "C2", "S1", "C1", "D0"}));
}

TEST(RouteOutput, AFleetIsBoundBeforeItsWays) {
  const RouteInstance instance = instance_of(testing::kEvrptw);
  const double fixed = instance.problem.vehicles.front().fixed_cost;
  const RouteAnswer answer =
      route_answer(instance, solution_of({0, 1}, fixed + 30.0, fixed + 24.0), 0.5);
  EXPECT_EQ(answer.vehicles_bound, 1);
  EXPECT_NEAR(answer.cost, 30.0, 1e-9);
  EXPECT_NEAR(answer.lower_bound, 24.0, 1e-9);
  const RouteAnswer loose = route_answer(instance, solution_of({0, 1}, fixed + 30.0, 12.0), 0.5);
  EXPECT_EQ(loose.vehicles_bound, 0);
  EXPECT_EQ(loose.lower_bound, 0.0);  // of one vehicle's ways nothing is known
}

TEST(RouteOutput, ScoresComeInTheStepsOfTheFile) {
  const RouteInstance instance = instance_of(testing::kChao);  // scores 10, 4 and 50, in steps of 2
  TourSolution solution = solution_of({0}, 54.01, 49.5);
  solution.dropped = {{1, ""}, {2, ""}};
  const RouteAnswer answer = route_answer(instance, solution, 0.5);
  EXPECT_EQ(answer.score, 10.0);
  EXPECT_EQ(answer.cost, 54.0);
  EXPECT_EQ(answer.score_bound, 14.0);  // 64 - 49.49, rounded down to an even number
  EXPECT_EQ(answer.lower_bound, 50.0);
  EXPECT_FALSE(answer.optimal);
  EXPECT_EQ(answer.left_out, (std::vector<std::string>{"4", "5"}));
  solution.lower_bound = 52.5;
  EXPECT_TRUE(route_answer(instance, solution, 0.5).optimal);  // a score of 11 does not exist
}

TEST(RouteOutput, WholeLengthsRoundTheirBoundUp) {
  const RouteInstance instance = instance_of(testing::kAtsp);
  EXPECT_TRUE(route_answer(instance, solution_of({0, 1, 2}, 10.0, 9.2), 0.5).optimal);
  EXPECT_FALSE(route_answer(instance, solution_of({0, 1, 2}, 10.0, 8.9), 0.5).optimal);
}

}  // namespace
}  // namespace headland::apps
