// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "core/world/farm_io.hpp"

namespace headland {
namespace {

RowParcel parcel(Polyline outer, double spacing, double heading_deg, double headland = 0.0) {
  RowParcel p;
  p.id = "p";
  p.boundary.outer = std::move(outer);
  p.row_spacing_m = spacing;
  p.row_heading_rad = deg_to_rad(heading_deg);
  p.headland_width_m = headland;
  return p;
}

Polyline rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

TEST(RowGenerator, RowsAreCentredAcrossTheParcelAndCountedFromTheLeft) {
  const auto rows = generate_rows(parcel(rectangle(0, 0, 25, 20), 2.5, 90.0));
  ASSERT_TRUE(rows) << to_string(rows.error());
  ASSERT_EQ(rows->size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    const Row& row = (*rows)[i];
    EXPECT_EQ(row.id, "r" + std::to_string(i + 1));
    const double x = 1.25 + 2.5 * static_cast<double>(i);  // (002): x_i = W / 2 + W (i - 1)
    EXPECT_LT((row.line.front() - Point2(x, 0)).norm(), 1e-9);
    EXPECT_LT((row.line.back() - Point2(x, 20)).norm(), 1e-9);
  }
}

TEST(RowGenerator, HeadlandIsMeasuredAlongTheRow) {
  // The lower side climbs at 45 degrees: every row still starts 3 m above it.
  const auto rows = generate_rows(parcel({{0, 0}, {20, 20}, {20, 60}, {0, 60}}, 2.0, 90.0, 3.0));
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 10u);
  for (const Row& row : *rows) {
    EXPECT_NEAR(row.line.front().y(), row.line.front().x() + 3.0, 1e-9);
    EXPECT_NEAR(row.line.back().y(), 57.0, 1e-9);
  }
}

TEST(RowGenerator, ANotchCutsARowInTwoAndAHoleDoesToo) {
  const auto count_at = [](const std::vector<Row>& rows, double x) {
    return std::count_if(rows.begin(), rows.end(),
                         [x](const Row& r) { return std::abs(r.line.front().x() - x) < 1e-9; });
  };
  // A U: the middle rows exist only in the foot, the legs are long.
  const auto u = generate_rows(parcel(
      {{0, 0}, {30, 0}, {30, 50}, {20, 50}, {20, 20}, {10, 20}, {10, 50}, {0, 50}}, 2.0, 0.0));
  ASSERT_TRUE(u);
  EXPECT_EQ(u->size(), 10u + 2u * 15u);  // 10 through the foot, 15 in each leg
  RowParcel holed = parcel(rectangle(0, 0, 20, 40), 2.0, 90.0, 1.0);
  holed.boundary.holes.push_back({{8, 18}, {8, 22}, {12, 22}, {12, 18}});
  const auto rows = generate_rows(holed);
  ASSERT_TRUE(rows);
  EXPECT_EQ(count_at(*rows, 5.0), 1);
  EXPECT_EQ(count_at(*rows, 9.0), 2);
}

TEST(RowGenerator, LawsHoldForAnyParcel) {
  RandomStream random(3, "rows");
  int parcels_with_rows = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Polyline outer;
    const int corners = 3 + random.index(12);
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * kPi * i / corners;
      outer.push_back(random.uniform(10, 60) * Point2(std::cos(angle), std::sin(angle)));
    }
    const RowParcel p =
        parcel(outer, random.uniform(1, 6), random.uniform(-180, 180), random.uniform(0, 6));
    const auto rows = generate_rows(p);
    if (!rows) {
      EXPECT_EQ(rows.error().code, ErrorCode::kNoRows);
      continue;
    }
    ++parcels_with_rows;
    const Point2 along(std::cos(p.row_heading_rad), std::sin(p.row_heading_rad));
    const Point2 right(along.y(), -along.x());
    double last_offset = -1e9;
    for (const Row& row : *rows) {
      const Point2 d = row.line.back() - row.line.front();
      EXPECT_GT(d.norm(), 2.0 * p.row_spacing_m);
      EXPECT_NEAR(along.dot(d), d.norm(), 1e-9);  // all the same way
      // Inside, and still inside a headland's width further on, but no more beyond that.
      const double h = p.headland_width_m;
      for (const double t : {1e-6 - h, 0.3 * d.norm(), 0.7 * d.norm(), d.norm() + h - 1e-6}) {
        EXPECT_TRUE(contains(p.boundary, row.line.front() + t * along));
      }
      for (const double t : {-h - 1e-6, d.norm() + h + 1e-6}) {
        EXPECT_FALSE(contains(p.boundary, row.line.front() + t * along));
      }
      const double offset = right.dot(row.line.front());
      const double steps = (offset - last_offset) / p.row_spacing_m;
      EXPECT_GT(steps, -1e-9);
      if (last_offset > -1e8) {
        EXPECT_NEAR(steps, std::round(steps), 1e-9);
      }
      last_offset = offset;
    }
  }
  EXPECT_GT(parcels_with_rows, 100);
}

TEST(RowGenerator, RoundingOfAMapDoesNotLoseARow) {
  EXPECT_EQ(generate_rows(parcel(rectangle(0, 0, 24.99, 20), 2.5, 90.0))->size(), 10u);
  EXPECT_EQ(generate_rows(parcel(rectangle(0, 0, 24.9, 20), 2.5, 90.0))->size(), 9u);
}

TEST(RowGenerator, ErrorsSayWhatDoesNotFit) {
  const auto narrow = generate_rows(parcel(rectangle(0, 0, 2, 100), 3.0, 90.0));
  ASSERT_FALSE(narrow);
  EXPECT_EQ(narrow.error().code, ErrorCode::kNoRows);
  const auto all_headland = generate_rows(parcel(rectangle(0, 0, 50, 20), 3.0, 90.0, 10.0));
  ASSERT_FALSE(all_headland);
  EXPECT_EQ(all_headland.error().code, ErrorCode::kNoRows);
  for (const double spacing : {0.0, -1.0, std::nan(""), 1e-9}) {
    const auto bad = generate_rows(parcel(rectangle(0, 0, 50, 20), spacing, 90.0));
    ASSERT_FALSE(bad);
    EXPECT_EQ(bad.error().code, ErrorCode::kOutOfRange);
  }
}

}  // namespace
}  // namespace headland
