// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/control/pure_pursuit/drive.hpp"

namespace headland {
namespace {

using namespace pure_pursuit_test;

TEST(PurePursuitBars, Print) {
  for (const double rate : {2.0, 1.0, 0.5}) {
    for (const char which : {'D', 'F', 'T', 'G'}) {
      Vehicle vehicle = study_vehicle(which == 'F' ? 30.0 : 60.0, rate);
      Reference reference;
      if (which == 'D')
        reference =
            rows({1, 3, 5, 7, 9, 10, 8, 6, 4, 2}, 3.0 / std::tan(deg_to_rad(60.0)), Turn::kDubins);
      if (which == 'F')
        reference =
            rows({1, 6, 7, 5, 10, 4, 9, 3, 8, 2}, 3.0 / std::tan(deg_to_rad(30.0)), Turn::kDubins);
      if (which == 'T')
        reference = rows({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, 3.0 / std::tan(deg_to_rad(60.0)),
                         Turn::kFishtail);
      if (which == 'G') reference = rows({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, 1.9, Turn::kFishtail);
      PurePursuitConfig c; auto env=[](const char*n,double&x){if(const char*e=std::getenv(n))x=std::atof(e);}; env("ERR",c.plan.step_error_m);env("RATIO",c.plan.least_speed_ratio);env("LA",c.lookahead_m);env("LT",c.lookahead_time_s);env("SHARE",c.plan.rate_share);env("MARGIN",c.plan.margin_m);env("HW",c.plan.heading_weight_m);env("STEP",c.plan.step_m);const Drive d = drive(vehicle, c, reference);
      std::printf(
          "%c rate %.1f status %d all %.4f rows %.4f turns %.4f max %.4f end %.4f against %d turn "
          "speed %.3f s %.1f of %.1f\n",
          which, rate, static_cast<int>(d.last), d.all.rms(), d.rows.rms(), d.turns.rms(),
          d.all.most, d.end_distance, d.against_gear, d.turn_speed, d.s, reference.path.length());
    }
  }
}

}  // namespace
}  // namespace headland
