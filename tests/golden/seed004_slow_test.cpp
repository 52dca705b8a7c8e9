// SPDX-License-Identifier: Apache-2.0
// Seed 004, Tables 2 and 3, over many drives.
#include <gtest/gtest.h>

#include "sim/lab/polito/figures.hpp"
#include "sim/lab/polito_study.hpp"

namespace headland {
namespace {

const StudyResult& noisy_study() {
  static const StudyResult result = [] {
    PolitoStudyConfig config;
    config.runs_count = 40;
    config.grid_lookahead_m = {};
    config.cycles_s = {};
    return run_polito_study(config).value();
  }();
  return result;
}

TEST(Seed004Accuracy, OursBeatsTable3WithItsWholeInterval) {
  for (const PublishedAccuracy& published : kPublishedAccuracies) {
    if (published.accuracy_m == 0.0) continue;
    const std::string cell = "track/ours/" + cell_key("noise", published.accuracy_m);
    for (const std::string variant : {"", "/arc_plant", "/odometry_1.01", "/heading_0.5"}) {
      const StudyCell* found = noisy_study().find(cell + variant);
      ASSERT_NE(found, nullptr) << cell << variant;
      EXPECT_EQ(found->n, 40);
      EXPECT_EQ(found->find("completed_ratio")->mean, 1.0) << cell << variant;
      for (const char* rule : {"ra_1pm", "literal_ra_1pm", "exact_ra_1pm", "wave_ra_1pm"}) {
        EXPECT_GT(*found->find(rule)->ci_low, published.ra_threshold_1pm)
            << cell << variant << " " << rule;
      }
    }
  }
}

TEST(Seed004Accuracy, FollowerFallsToTheOrderOfTable2) {
  for (const PublishedAccuracy& published : kPublishedAccuracies) {
    if (published.accuracy_m == 0.0) continue;
    const StudyCell* cell =
        noisy_study().find("track/seed/" + cell_key("noise", published.accuracy_m));
    ASSERT_NE(cell, nullptr);
    const double ratio = cell->find("ra_1pm")->mean / published.ra_1pm;
    EXPECT_GT(ratio, 0.5) << published.accuracy_m;
    EXPECT_LT(ratio, 2.0) << published.accuracy_m;
  }
}

}  // namespace
}  // namespace headland
