// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/instance_io.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/support/instance_texts.hpp"

namespace headland {
namespace {

using namespace testing;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(InstanceIo, AnAtspIsOneVehicleFromNodeOneAndBack) {
  const RouteInstance instance = parse_instance("dir/four.atsp", kAtsp).value();
  EXPECT_EQ(instance.name, "four");
  EXPECT_EQ(instance.format, "ATSP");
  EXPECT_EQ(instance.task_names, (std::vector<std::string>{"2", "3", "4"}));
  EXPECT_EQ(instance.start_name, "1");
  const TourProblem& problem = instance.problem;
  ASSERT_EQ(problem.vehicles.size(), 1U);
  EXPECT_EQ(problem.vehicles[0].start, 0);
  EXPECT_EQ(problem.tasks[2].reward, kNever);
  EXPECT_EQ(problem.way(0, 0, 1).cost, 1.0);
  EXPECT_EQ(problem.way(0, 1, 0).cost, 9.0);
  EXPECT_EQ(problem.way(0, 3, 0).cost, 4.0);
  EXPECT_TRUE(instance.whole_costs);
}

TEST(InstanceIo, TriangularMatricesAreSymmetric) {
  const std::string text =
      "TYPE: TSP\nDIMENSION: 3\nEDGE_WEIGHT_TYPE: EXPLICIT\nEDGE_WEIGHT_FORMAT: {}\n"
      "EDGE_WEIGHT_SECTION\n";
  for (const auto& [format, numbers] : {std::pair{"UPPER_ROW", "1 2 3"},
                                        {"UPPER_DIAG_ROW", "0 1 2 0 3 0"},
                                        {"LOWER_ROW", "1 2 3"},
                                        {"LOWER_DIAG_ROW", "0 1 0 2 3 0"}}) {
    const auto instance = parse_instance("t", replaced(text, "{}", format) + numbers);
    ASSERT_TRUE(instance) << format;
    EXPECT_EQ(instance->problem.way(0, 0, 1).cost, 1.0) << format;
    EXPECT_EQ(instance->problem.way(0, 2, 0).cost, 2.0) << format;
    EXPECT_EQ(instance->problem.way(0, 1, 2).cost, 3.0) << format;
    EXPECT_EQ(instance->problem.way(0, 2, 1).cost, 3.0) << format;
  }
}

TEST(InstanceIo, AnEvrpHasStationsThatFillAtOnceAndNoRounding) {
  const RouteInstance instance = parse_instance("two.evrp", kEvrp).value();
  EXPECT_EQ(instance.format, "EVRP");
  const TourProblem& problem = instance.problem;
  EXPECT_EQ(problem.tasks.size(), 2U);
  EXPECT_EQ(problem.tasks[1].demand, 7.0);
  EXPECT_DOUBLE_EQ(problem.way(0, 1, 2).cost, std::hypot(3.0, 7.0));
  EXPECT_DOUBLE_EQ(problem.way(0, 0, 1).energy_j, 6.0);
  EXPECT_EQ(instance.station_names, (std::vector<std::string>{"1", "4"}));
  const TourVehicle& vehicle = problem.vehicles.front();
  EXPECT_EQ(vehicle.start_energy_j, 12.0);
  EXPECT_EQ(vehicle.charging[1].points.back().time_s, 0.0);
  EXPECT_EQ(vehicle.charging[1].points.back().energy_j, 12.0);
  EXPECT_EQ(problem.vehicles.size(), 2U);  // 13 of load by 10: two, never three
}

TEST(InstanceIo, AnEvrptwPutsFewVehiclesBeforeShortWays) {
  const RouteInstance instance = parse_instance("c.txt", kEvrptw).value();
  EXPECT_EQ(instance.format, "E-VRPTW");
  EXPECT_EQ(instance.start_name, "D0");
  EXPECT_FALSE(instance.numeric_names);
  const TourProblem& problem = instance.problem;
  EXPECT_EQ(problem.way(0, 0, 3).cost, 5.0);
  EXPECT_EQ(problem.way(0, 0, 3).duration_s, 10.0);
  EXPECT_EQ(problem.tasks[0].earliest_s, 20.0);
  EXPECT_EQ(problem.tasks[0].latest_s, 30.0);
  EXPECT_EQ(problem.profiles[0].work[0][0].duration_s, 5.0);
  const TourVehicle& vehicle = problem.vehicles.front();
  EXPECT_EQ(vehicle.latest_s, 100.0);
  EXPECT_EQ(vehicle.charging[1].points.back().time_s, 26.0);  // 2 a unit, full from empty
  EXPECT_GT(vehicle.fixed_cost, 2 * (5.0 + 8.0));
  EXPECT_EQ(instance.station_names, (std::vector<std::string>{"S0", "S1"}));
}

TEST(InstanceIo, OrienteeringLosesScoresWithinABudget) {
  const RouteInstance instance = parse_instance("c.txt", kChao).value();
  EXPECT_EQ(instance.format, "OP");
  EXPECT_EQ(instance.task_names, (std::vector<std::string>{"3", "4", "5"}));
  EXPECT_EQ(instance.finish_name, "2");
  const TourProblem& problem = instance.problem;
  EXPECT_EQ(problem.vehicles[0].latest_s, 12.0);
  EXPECT_EQ(problem.vehicles[0].finish, 1);
  EXPECT_EQ(problem.tasks[2].reward, 50.0);
  EXPECT_EQ(problem.way(0, 0, 2).duration_s, 5.0);
  EXPECT_LT(problem.way(0, 0, 2).cost * 12.0 / 5.0, 1.0);  // a whole tour is worth no score

  const RouteInstance oplib = parse_instance("o.oplib", kOplib).value();
  EXPECT_EQ(oplib.problem.vehicles[0].finish, 0);
  EXPECT_EQ(oplib.problem.tasks[1].reward, 7.0);
  EXPECT_EQ(oplib.problem.vehicles[0].latest_s, 11.0);
}

struct Wrong {
  const char* text;
  const char* from;
  const char* to;
  const char* says;  // how the message begins
};

TEST(InstanceIo, WhatIsWrongIsSaidWithItsLine) {
  const Wrong cases[] = {
      {kAtsp, "9 9999 2", "x 9999 2", "f:8: weight 'x' is not a number"},
      {kAtsp, "9 9999 2", "nan 9999 2", "f:8: weight 'nan' is out of range"},
      {kAtsp, "9999 2 9", "9999 -2 9", "f:8: weight '-2' is out of range"},
      {kAtsp, "9 9 9999\nEOF", "9 9\nEOF", "f:10: EDGE_WEIGHT_SECTION has 15 words"},
      {kAtsp, "TYPE: ATSP", "TYPE: HCP", "f:2: TYPE: unknown type of problem"},
      {kAtsp, "DIMENSION: 4", "COMMENT: 4", "f:11: DIMENSION: required key is missing"},
      {kAtsp, "DIMENSION: 4", "DIMENSION: 1e9", "f:3: DIMENSION '1e9' is out of range"},
      {kAtsp, "DIMENSION: 4", "DIMENSION: 2.5", "f:3: DIMENSION '2.5' is out of range"},
      {kAtsp, "FULL_MATRIX", "FUNCTION", "f:5: EDGE_WEIGHT_FORMAT: unknown format"},
      {kAtsp, "EXPLICIT", "GEO", "f:4: EDGE_WEIGHT_TYPE: unknown type"},
      {kEvrp, "STATIONS_COORD_SECTION\r\n4", "", "f:22: STATIONS_COORD_SECTION: required"},
      {kEvrp, "2 6 \r\n", "", "f:16: DEMAND_SECTION has 4 words"},
      {kEvrp, "3 7", "2 7", "f:17: node 2 a second time"},
      {kEvrp, "\r\n1\r\n-1", "\r\n2\r\n-1", "f:20: DEPOT_SECTION: the depot is not node 1"},
      {kEvrp, "ENERGY_CAPACITY: 12", "ENERGY_CAPACITY: 0", "f:5: CAPACITY or ENERGY_CAPACITY"},
      {kEvrptw, "C1 c", "C1 k", "f:5: unknown type of place"},
      {kEvrptw, "20 30 5", "30 20 5", "f:5: DueDate lies before ReadyTime"},
      {kEvrptw, "/13/", "/inf/", "f:8: Q 'inf' is out of range"},
      {kEvrptw, "g inverse", "h inverse", "f:11: neither a place nor a value"},
      {kEvrptw, "v average Velocity /0.5/\n", "", "f:11: no value of v"},
      {kEvrptw, "S0 f", "S0 d", "f:12: 2 depots"},
      {kChao, "3 4 10", "3 4", "f:4: 2 words where a point stands"},
      {kChao, "3 4 10", "3 4 -1", "f:4: score '-1' is out of range"},
      {kChao, "12\t1", "12\t0", "f:1: number of paths '0' is out of range"},
      {kChao, "12\t1", "twelve\t1", "f:1: not a routing instance"},
  };
  for (const Wrong& wrong : cases) {
    const auto instance = parse_instance("f", replaced(wrong.text, wrong.from, wrong.to));
    ASSERT_FALSE(instance) << wrong.says;
    EXPECT_EQ(exit_code(instance.error().code), 2);
    EXPECT_EQ(to_string(instance.error()).rfind(wrong.says, 0), 0U)
        << to_string(instance.error()) << "\nwanted: " << wrong.says;
    EXPECT_FALSE(instance.error().remedy.empty()) << wrong.says;
  }
  EXPECT_FALSE(parse_instance("f", ""));
  EXPECT_EQ(to_string(load_instance("no/such.atsp").error()).rfind("no/such.atsp: no such", 0), 0U);
}

// An instance is read or refused, whatever the bytes; what is read is whole.
void expect_sound(const std::string& text) {
  const auto instance = parse_instance("f", text);
  if (!instance) {
    EXPECT_FALSE(instance.error().what.empty());
    return;
  }
  const TourProblem& problem = instance->problem;
  const auto sites = static_cast<std::size_t>(problem.sites);
  ASSERT_EQ(problem.profiles.at(0).ways.size(), sites * sites);
  ASSERT_EQ(problem.tasks.size(), instance->task_names.size());
  ASSERT_EQ(problem.stations.size(), instance->station_names.size());
  ASSERT_FALSE(problem.vehicles.empty());
  for (const TourLeg& way : problem.profiles[0].ways) ASSERT_TRUE(std::isfinite(way.cost));
}

TEST(InstanceIo, NoTruncationOrGarbageCrashes) {
  RandomStream random(7, "garbage");
  for (const std::string text : {kAtsp, kEvrp, kEvrptw, kChao, kOplib}) {
    for (std::size_t length = 0; length < text.size(); ++length) {
      expect_sound(text.substr(0, length));
    }
    for (int round = 0; round < 2000; ++round) {
      std::string garbled = text;
      for (int edits = 1 + random.index(4); edits > 0; --edits) {
        const auto at = static_cast<std::size_t>(random.index(static_cast<int>(garbled.size())));
        const std::string_view likely = "0123456789 \n\t:-.eE/dfcQ";
        garbled[at] =
            random.index(4) == 0
                ? static_cast<char>(random.index(256))
                : likely[static_cast<std::size_t>(random.index(static_cast<int>(likely.size())))];
      }
      expect_sound(garbled);
    }
  }
}

}  // namespace
}  // namespace headland
