// SPDX-License-Identifier: Apache-2.0
#include "core/model/herd.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/config/yaml.hpp"

namespace headland {
namespace {

const Point2 kNoNoise(0.0, 0.0);

Point2 turned(const Point2& v, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

TEST(Herd, UndisturbedAnAnimalGrazesAlongItsNoise) {
  const HerdModel model;
  const HerdThreat far{{{12.1, 0.0}, {-2.0, 0.0}}, 12.0};
  const Point2 v = herd_velocity(model, {}, {}, {&far, 1}, {0.6, 0.8});
  EXPECT_LT((v - model.graze_mps * Point2(0.6, 0.8)).norm(), 1e-12);
  EXPECT_EQ(herd_velocity(model, {}, {}, {}, kNoNoise), Point2(0.0, 0.0));
}

TEST(Herd, AnimalsThatStandCloserThanTheirSpacingDrawApart) {
  const HerdModel model;
  const HerdBody near{{0.9, 0.0}, {0.0, 0.0}};
  const HerdBody fine{{1.1, 0.0}, {0.0, 0.0}};
  EXPECT_LT(herd_velocity(model, {}, {&near, 1}, {}, kNoNoise).x(), 0.0);
  EXPECT_EQ(herd_velocity(model, {}, {&fine, 1}, {}, kNoNoise), Point2(0.0, 0.0));
}

TEST(Herd, AnAnimalFleesStraightAwayAtAWalkOrAsFastAsTheThreatComes) {
  const HerdModel model;
  HerdThreat threat{{{3.0, 4.0}, {0.0, 0.0}}, 12.0};
  const Point2 away(-0.6, -0.8);
  const auto flight = [&] { return herd_velocity(model, {}, {}, {&threat, 1}, kNoNoise); };
  EXPECT_LT((flight() - model.walk_mps * away).norm(), 1e-12);
  threat.body.velocity = 2.5 * away;
  EXPECT_LT((flight() - 2.5 * away).norm(), 1e-12);
  threat.body.velocity = 25.0 * away;
  EXPECT_LT((flight() - model.run_mps * away).norm(), 1e-12);
  threat.body.velocity = -2.5 * away;  // it leaves
  EXPECT_LT((flight() - model.walk_mps * away).norm(), 1e-12);
}

TEST(Herd, InFlightAnimalsCloseUpAndGoTheWayOfTheOthers) {
  const HerdModel model;
  const HerdThreat dog{{{-6.0, 0.0}, {1.0, 0.0}}, 12.0};
  const HerdBody standing{{0.0, 5.0}, {0.0, 0.0}};
  HerdBody walking = standing;
  walking.velocity = {0.0, -1.0};
  const Point2 alone = herd_velocity(model, {}, {}, {&dog, 1}, kNoNoise);
  const Point2 drawn = herd_velocity(model, {}, {&standing, 1}, {&dog, 1}, kNoNoise);
  const Point2 aligned = herd_velocity(model, {}, {&walking, 1}, {&dog, 1}, kNoNoise);
  EXPECT_NEAR(alone.y(), 0.0, 1e-12);
  EXPECT_GT(drawn.y(), 0.5);
  EXPECT_LT(aligned.y(), drawn.y() - 0.5);
}

TEST(Herd, TheResponseTurnsWithTheScene) {
  const HerdModel model;
  RandomStream random(1, "herd");
  for (int i = 0; i < 200; ++i) {
    std::vector<HerdBody> neighbors(5);
    for (HerdBody& b : neighbors) {
      b.position = {random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0)};
      b.velocity = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
    }
    HerdThreat threat{{{random.uniform(-6.0, 6.0), 4.0}, {random.uniform(-2.0, 2.0), 0.3}}, 8.0};
    const Point2 before = herd_velocity(model, {}, neighbors, {&threat, 1}, {1.0, 0.0});
    const double angle = random.uniform(-3.0, 3.0);
    for (HerdBody& b : neighbors) b = {turned(b.position, angle), turned(b.velocity, angle)};
    threat.body = {turned(threat.body.position, angle), turned(threat.body.velocity, angle)};
    const Point2 after =
        herd_velocity(model, {}, neighbors, {&threat, 1}, turned({1.0, 0.0}, angle));
    ASSERT_LT((after - turned(before, angle)).norm(), 1e-9);
  }
}

TEST(Herd, BodiesInOnePlaceGiveNumbers) {
  const HerdModel model;
  const std::vector<HerdBody> neighbors(12);
  const std::vector<HerdThreat> threats(3);
  EXPECT_TRUE(herd_velocity(model, {}, neighbors, threats, {1.0, 0.0}).allFinite());
}

TEST(Herd, InertiaAndNoiseDoNotDependOnTheStep) {
  const HerdModel model;
  Point2 fine(1.0, 0.0);
  for (int i = 0; i < 100; ++i) fine = respond(model, fine, {0.0, 2.0}, 0.01);
  EXPECT_LT((fine - respond(model, {1.0, 0.0}, {0.0, 2.0}, 1.0)).norm(), 1e-9);
  // The correlation of the noise over its time is 1/e.
  for (const int steps : {1, 5, 20}) {
    RandomStream random(7, "herd_noise");
    double sum = 0.0;
    for (int i = 0; i < 20000; ++i) {
      Point2 noise(1.0, 0.0);
      for (int k = 0; k < steps; ++k) {
        noise = turned_noise(model, noise, model.noise_s / steps, random);
      }
      sum += noise.x();
    }
    EXPECT_NEAR(sum / 20000.0, std::exp(-1.0), 0.015) << steps << " steps";
  }
}

TEST(Herd, AFlockThatADogDrivesStaysTogetherAndGoesTheSameWay) {
  const HerdModel model;
  RandomStream random(3, "flock");
  std::vector<HerdBody> flock(14);
  std::vector<Point2> noise(14, Point2(1.0, 0.0));
  for (HerdBody& b : flock) b.position = {random.uniform(0.0, 8.0), random.uniform(0.0, 8.0)};
  Point2 dog(-6.0, 4.0);
  Point2 heading(0.0, 0.0);
  Point2 centre(0.0, 0.0);
  for (int i = 0; i < 400; ++i) {
    const HerdThreat threat{{dog, {1.2, 0.0}}, model.flight_m};
    std::vector<HerdBody> next = flock;
    for (std::size_t a = 0; a < flock.size(); ++a) {
      std::vector<HerdBody> others = flock;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(a));
      const Point2 at = flock[a].position;
      std::sort(others.begin(), others.end(), [&at](const HerdBody& b, const HerdBody& c) {
        return (b.position - at).norm() < (c.position - at).norm();
      });
      noise[a] = turned_noise(model, noise[a], 0.1, random);
      const Point2 wanted = herd_velocity(model, flock[a], others, {&threat, 1}, noise[a]);
      next[a].velocity = respond(model, flock[a].velocity, wanted, 0.1);
      next[a].position += 0.1 * next[a].velocity;
    }
    flock = next;
    heading.setZero();
    centre.setZero();
    for (const HerdBody& b : flock) {
      heading += b.velocity.normalized() / 14.0;
      centre += b.position / 14.0;
    }
    dog.x() += 0.12;
    dog.y() += std::clamp(centre.y() - dog.y(), -0.2, 0.2);
  }
  EXPECT_GT(heading.norm(), 0.8);
  EXPECT_GT(heading.x(), 0.8);
  for (const HerdBody& b : flock) EXPECT_LT((b.position - centre).norm(), 6.0);
}

TEST(Herd, TheModelIsReadFromAFileWithItsRanges) {
  const auto read = [](const std::string& text, HerdModel& model) {
    const auto node = config::Node::parse(text, "herd.yaml");
    return node && config::read_into(*node, model);
  };
  HerdModel model = cattle_herd();
  EXPECT_TRUE(read("{flight_m: 3, walk_mps: 0.9}", model));
  EXPECT_DOUBLE_EQ(model.flight_m, 3.0);
  EXPECT_DOUBLE_EQ(model.spacing_m, cattle_herd().spacing_m);
  EXPECT_FALSE(read("{response_s: 0}", model));
}

}  // namespace
}  // namespace headland
