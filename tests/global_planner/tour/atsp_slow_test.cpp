// SPDX-License-Identifier: Apache-2.0
// TSPLIB's asymmetric instances: the published optima, and bounds that prove all but one.
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "global_planner/tour/instance_io.hpp"
#include "global_planner/tour/internal/order.hpp"

namespace headland {
namespace {

namespace fs = std::filesystem;

TEST(Atsp, PublishedOptimaAreFound) {
  const char* given = std::getenv("HEADLAND_DATA");
  const fs::path folder =
      (given != nullptr ? fs::path(given) : fs::path("..") / "shared" / "data") / "atsp";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder << "; set HEADLAND_DATA";
  const std::pair<const char*, double> optima[] = {{"br17", 39},       {"ft53", 6905},
                                                   {"ftv33", 1286},    {"ftv70", 1950},
                                                   {"kro124p", 36230}, {"rbg323", 1326}};
  for (const auto& [name, optimum] : optima) {
    const auto instance = load_instance(folder / (std::string(name) + ".atsp"));
    ASSERT_TRUE(instance) << name;
    const auto order = tour::solve_order(instance->problem, {});
    ASSERT_TRUE(order) << name;
    EXPECT_EQ(order->cost, optimum) << name;
    EXPECT_LE(order->lower_bound, optimum) << name;
    EXPECT_GE(order->lower_bound, 0.9995 * optimum) << name;  // kro124p: 36225; all others proven
    EXPECT_EQ(order->optimal, order->lower_bound == optimum) << name;
    EXPECT_TRUE(order->optimal || instance->name == "kro124p") << name;
  }
}

}  // namespace
}  // namespace headland
