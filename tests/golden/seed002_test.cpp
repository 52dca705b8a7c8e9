// SPDX-License-Identifier: Apache-2.0
// Seed 002's tracking table (parts D, E and F) and what else its drives tell.
#include <gtest/gtest.h>

#include "sim/lab/ebs221/drive.hpp"
#include "sim/lab/ebs221/field.hpp"

namespace headland {
namespace {

struct SeedRun {
  SeedRun(const RowOrder& order, double planned_deg, const SeedPurePursuitConfig& config,
          double dx = 0.0)
      : links(field_links(field, order)),
        radius(field.radius(planned_deg)),
        route(seed_route(links, radius, 0.5 * field.row_length_m)),
        exact(field_path(links, radius, TurnShape::kDubins)) {
    Pose2 start = field.depot();
    start.x += dx;
    drive = drive_seed_field({}, config, route, exact.path, start);
    seed = tracking_metrics(seed_errors(drive.positions, route), seed_kinds(route));
    truth = tracking_metrics(drive.errors, seed_kinds(route));
  }

  Ebs221Field field;
  std::vector<FieldLink> links;
  double radius;
  SeedRoute route;
  FieldPath exact;
  FieldDrive drive;
  TrackingMetrics seed;
  TrackingMetrics truth;
};

constexpr double kExact = 0.0005;  // [m]

TEST(Seed002, PartDAsPublished) {
  const SeedRun run(seed_order_60(), 60.0, {});
  printf("D %zu %d %.4f %.4f %.4f | %.4f %.4f %.4f max %.4f\n", run.drive.positions.size(), run.drive.completed, run.seed.overall_rms_m, run.seed.row_rms_m, run.seed.turn_rms_m, run.truth.overall_rms_m, run.truth.row_rms_m, run.truth.turn_rms_m, run.seed.max_m);
  EXPECT_TRUE(run.drive.completed);
  EXPECT_NEAR(run.seed.overall_rms_m, 0.0794, kExact);
  EXPECT_NEAR(run.seed.row_rms_m, 0.0826, kExact);
  EXPECT_NEAR(run.seed.turn_rms_m, 0.0726, kExact);
  EXPECT_NEAR(run.truth.overall_rms_m, 0.0720, kExact);
  EXPECT_NEAR(run.truth.row_rms_m, 0.0769, kExact);
  EXPECT_NEAR(run.truth.turn_rms_m, 0.0609, kExact);
}

TEST(Seed002, PartFAsPublished) {
  SeedPurePursuitConfig config;
  config.max_steering_deg = 30.0;
  config.lookahead_line_m = 1.0;
  config.lookahead_turn_m = 0.2;
  const SeedRun run(seed_order_30(), 30.0, config);
  printf("F %zu %d %.4f %.4f %.4f | %.4f %.4f %.4f max %.4f\n", run.drive.positions.size(), run.drive.completed, run.seed.overall_rms_m, run.seed.row_rms_m, run.seed.turn_rms_m, run.truth.overall_rms_m, run.truth.row_rms_m, run.truth.turn_rms_m, run.seed.max_m);
  EXPECT_TRUE(run.drive.completed);
  EXPECT_NEAR(run.seed.overall_rms_m, 0.0320, kExact);
  EXPECT_NEAR(run.seed.row_rms_m, 0.0296, kExact);
  EXPECT_NEAR(run.seed.turn_rms_m, 0.0335, kExact);
  EXPECT_NEAR(run.truth.overall_rms_m, 0.0192, kExact);
  EXPECT_NEAR(run.truth.row_rms_m, 0.0123, kExact);
  EXPECT_NEAR(run.truth.turn_rms_m, 0.0229, kExact);
}

TEST(Seed002, PartE) {
  SeedPurePursuitConfig config;
  config.max_steering_deg = 30.0;
  config.lookahead_line_m = 4.0;
  config.lookahead_turn_m = 2.0;
  for (double dx : {0.0, 1e-9, -1e-9, 5e-10, 2e-10,-3e-10, 1e-12, -1e-12, 1e-14}) {
  const SeedRun run(seed_order_60(), 60.0, config, dx);
  printf("E %g %zu %d guided %d %.4f %.4f %.4f | %.4f %.4f %.4f max %.4f\n", dx, run.drive.positions.size(), run.drive.completed, run.drive.guided_count, run.seed.overall_rms_m, run.seed.row_rms_m, run.seed.turn_rms_m, run.truth.overall_rms_m, run.truth.row_rms_m, run.truth.turn_rms_m, run.seed.max_m);
  }
}

}  // namespace
}  // namespace headland
