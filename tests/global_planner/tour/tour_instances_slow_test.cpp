// SPDX-License-Identifier: Apache-2.0
// Electric routes of CEC-12: too many customers for the exact search.
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "global_planner/tour/instance_io.hpp"
#include "global_planner/tour/tour_solver.hpp"

namespace headland {
namespace {

namespace fs = std::filesystem;

TEST(TourInstances, ElectricRoutesReachThePublishedLength) {
  const char* given = std::getenv("HEADLAND_DATA");
  const fs::path folder =
      (given != nullptr ? fs::path(given) : fs::path("..") / "shared" / "data") / "evrp";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder << "; set HEADLAND_DATA";
  const std::pair<const char*, double> best[] = {{"E-n22-k4.evrp", 384.679},
                                                 {"E-n30-k3.evrp", 509.471},
                                                 {"E-n51-k5.evrp", 529.902},
                                                 {"E-n101-k8.evrp", 839.29}};
  for (const auto& [file, length] : best) {
    const auto instance = load_instance(folder / file);
    ASSERT_TRUE(instance.has_value()) << file;
    const auto solution = solve_tour(instance->problem);
    ASSERT_TRUE(solution.has_value()) << file;
    EXPECT_EQ(check_solution(instance->problem, *solution).value_or("valid"), "valid") << file;
    EXPECT_LE(solution->cost, length) << file;
    EXPECT_LE(solution->lower_bound, solution->cost) << file;
  }
}

}  // namespace
}  // namespace headland
