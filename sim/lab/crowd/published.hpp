// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace headland {

/// One method in the episodes that Eiffert et al. published (stuarteiffert/MCTS-GRNN, MIT: 500
/// unseeded ones a method, robot visible, holonomic), as recomputed from its file. Their PF goes
/// diagonally at up to 1.41 m/s.
struct PublishedCrowdResult {
  std::string_view name;
  std::string_view file;
  int success = 0;    ///< episodes
  int collision = 0;  ///< episodes
  int near_miss_episodes = 0;
  double time_s = 0.0;    ///< mean of successes
  double length_m = 0.0;  ///< likewise; their count leaves out the last step
  double disturbed_ratio = 0.0;
  double disturbed_half_ratio = 0.0;
  double disturbed_quarter_ratio = 0.0;
  std::array<double, 3> success_ratio{};  ///< with 2-4, 5-8, 9-11 people
  double plan_ms = 0.0;                   ///< as their README has it
};

constexpr int kPublishedEpisodes = 500;
constexpr std::array<PublishedCrowdResult, 5> kPublishedCrowdResults = {{
    {"MCTS-GRNN SEF1",
     "test_data_mctsrnn.csv",
     493,
     2,
     57,
     17.927,
     17.676,
     0.0152,
     0.0681,
     0.1349,
     {150.0 / 152, 188.0 / 192, 155.0 / 156},
     330.0},
    {"MCTS-CV",
     "test_data_mctscv.csv",
     485,
     1,
     132,
     16.434,
     16.184,
     0.0161,
     0.0716,
     0.1431,
     {148.0 / 150, 203.0 / 209, 134.0 / 141},
     420.0},
    {"SARL",
     "test_data_sarl.csv",
     478,
     0,
     55,
     17.414,
     16.945,
     0.0155,
     0.0691,
     0.1259,
     {138.0 / 154, 198.0 / 202, 142.0 / 144},
     251.0},
    {"SARL-CV",
     "test_data_sarlcv.csv",
     485,
     0,
     64,
     17.452,
     16.968,
     0.0171,
     0.0712,
     0.1274,
     {139.0 / 152, 198.0 / 200, 148.0 / 148},
     150.0},
    {"PF",
     "test_data_pf.csv",
     457,
     4,
     19,
     16.016,
     19.365,
     0.0185,
     0.0746,
     0.1350,
     {157.0 / 158, 168.0 / 184, 132.0 / 158},
     10.0},
}};

}  // namespace headland
