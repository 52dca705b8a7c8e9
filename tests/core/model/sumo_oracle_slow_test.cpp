// SPDX-License-Identifier: Apache-2.0
// Our energy model beside that of SUMO (Eclipse, EPL 2.0), step by step, where that is installed:
// SUMO drives an electric vehicle over a small network and says how it moved and what it drew; our
// model says what that movement draws.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"
#include "core/model/energy.hpp"

namespace headland {
namespace {

using Attributes = std::map<std::string, std::string>;

constexpr double kLargestRadius = 1e4;  // [m] SUMO takes no larger one while the heading changes

struct Parameters {
  double roll = 0.02;
  double radial = 0.3;
  double constant_power_w = 0.0;
};

// What SUMO says of one step of 1 s.
struct Step {
  double energy_wh = 0.0;
  double speed = 0.0;
  double slope = 0.0;  // [rad]
  double angle = 0.0;  // [rad]
};

// Hills and bends: uphill, over the top, down through a curve, and along a plain; speed limits
// change.
constexpr const char* kHillyEdges = R"(<edges>
 <edge id="up" from="a" to="b" speed="15" shape="0,0,0 100,0,3 200,10,12 300,5,16 400,0,20"/>
 <edge id="down" from="b" to="c" speed="9"
  shape="400,0,20 450,5,18 500,25,14 550,60,10 600,120,8 650,180,6 700,200,5"/>
 <edge id="on" from="c" to="d" speed="20"/>
</edges>)";
constexpr const char* kHillyNodes = R"(<nodes>
 <node id="a" x="0" y="0" z="0"/><node id="b" x="400" y="0" z="20"/>
 <node id="c" x="700" y="200" z="5"/><node id="d" x="1100" y="200" z="5"/>
</nodes>)";
// Straight on the level, each part faster than the one before.
constexpr const char* kFlatEdges = R"(<edges>
 <edge id="up" from="a" to="b" speed="5"/><edge id="down" from="b" to="c" speed="10"/>
 <edge id="on" from="c" to="d" speed="15"/>
</edges>)";
constexpr const char* kFlatNodes = R"(<nodes>
 <node id="a" x="0" y="0"/><node id="b" x="300" y="0"/>
 <node id="c" x="700" y="0"/><node id="d" x="1100" y="0"/>
</nodes>)";

std::string routes(const Parameters& p, double sigma) {
  const auto key = [](const char* name, double value) {
    return fmt::format("<param key=\"{}\" value=\"{}\"/>\n", name, value);
  };
  return fmt::format(
             "<routes><vType id=\"ev\" accel=\"1.2\" decel=\"2\" sigma=\"{}\" "
             "emissionClass=\"Energy/unknown\" maxSpeed=\"25\">\n"
             "<param key=\"has.battery.device\" value=\"true\"/>\n",
             sigma) +
         key("vehicleMass", 1500.0) + key("frontSurfaceArea", 2.5) +
         key("airDragCoefficient", 0.4) + key("internalMomentOfInertia", 40.0) +
         key("radialDragCoefficient", p.radial) + key("rollDragCoefficient", p.roll) +
         key("constantPowerIntake", p.constant_power_w) + key("propulsionEfficiency", 0.9) +
         key("recuperationEfficiency", 0.7) + key("maximumBatteryCapacity", 35000.0) +
         key("actualBatteryCapacity", 20000.0) +
         "</vType><vehicle id=\"v\" type=\"ev\" depart=\"0\"><route edges=\"up down on\"/>"
         "</vehicle></routes>\n";
}

std::vector<Attributes> vehicles_in(const std::filesystem::path& file) {
  static const std::regex kAttribute("(\\w+)=\"([^\"]*)\"");
  std::vector<Attributes> list;
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("<vehicle ") == std::string::npos) continue;
    Attributes attributes;
    for (std::sregex_iterator at(line.begin(), line.end(), kAttribute), end; at != end; ++at) {
      attributes[(*at)[1]] = (*at)[2];
    }
    list.push_back(std::move(attributes));
  }
  return list;
}

bool sumo_is_here() { return std::system("command -v sumo netconvert > /dev/null 2>&1") == 0; }

std::vector<Step> simulated(const std::string& nodes, const std::string& edges,
                            const std::string& vehicle) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const auto folder =
      std::filesystem::path(::testing::TempDir()) / (std::string("headland_sumo_") + test->name());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "n.nod.xml") << nodes;
  std::ofstream(folder / "n.edg.xml") << edges;
  std::ofstream(folder / "v.rou.xml") << vehicle;
  const std::string command = fmt::format(
      "cd '{}' && netconvert -n n.nod.xml -e n.edg.xml -o net.xml --precision 6 -X never > log "
      "2>&1 "
      "&& sumo -n net.xml -r v.rou.xml -X never --seed 7 --step-length 1 --precision 12 "
      "--battery-output bat.xml --battery-output.precision 12 --fcd-output fcd.xml "
      "--no-step-log >> log 2>&1",
      folder.string());
  if (std::system(command.c_str()) != 0) {
    ADD_FAILURE() << "SUMO failed, see " << folder / "log";
    return {};
  }
  const auto battery = vehicles_in(folder / "bat.xml");
  const auto motion = vehicles_in(folder / "fcd.xml");
  EXPECT_EQ(battery.size(), motion.size());
  std::vector<Step> steps;
  for (std::size_t i = 0; i < std::min(battery.size(), motion.size()); ++i) {
    steps.push_back({std::stod(battery[i].at("energyConsumed")), std::stod(motion[i].at("speed")),
                     deg_to_rad(std::stod(motion[i].at("slope"))),
                     deg_to_rad(std::stod(motion[i].at("angle")))});
  }
  std::filesystem::remove_all(folder);
  return steps;
}

EnergyModel model_of(const Parameters& p) {
  EnergyModel model;
  model.mass_kg = 1500.0;
  model.rotating_mass_kg = 40.0;
  model.drag_area_m2 = 2.5 * 0.4;
  model.turn_loss_ratio = p.radial;
  model.drive_efficiency_ratio = 0.9;
  model.recuperation_efficiency_ratio = 0.7;
  model.base_power_w = p.constant_power_w / model.drive_efficiency_ratio;  // SUMO: before the drive
  return model;
}

// Largest difference [Wh] over all steps.
double compare(const std::vector<Step>& steps, const Parameters& p) {
  const EnergyModel model = model_of(p);
  double worst = 0.0;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    DriveStep step;
    step.distance_m = steps[i].speed;
    step.duration_s = 1.0;
    step.rise_m = steps[i].speed * std::sin(steps[i].slope);
    step.speed_mps = steps[i].speed;
    step.speed_before_mps = steps[i - 1].speed;
    step.soil = {p.roll, 0.0};  // SUMO knows no slip
    const double turned = std::abs(wrap_angle(steps[i].angle - steps[i - 1].angle));
    if (turned > 0.0 && step.distance_m > 0.0) {
      step.curvature_1pm = std::max(turned / step.distance_m, 1.0 / kLargestRadius);
    }
    double difference = std::abs(step_energy(model, step) / 3600.0 - steps[i].energy_wh);
    if (turned == 0.0) {
      // Nothing to the twelve digits that are written; but SUMO may have seen a change in the
      // sixteenth, and then takes its largest radius.
      step.curvature_1pm = 1.0 / kLargestRadius;
      difference =
          std::min(difference, std::abs(step_energy(model, step) / 3600.0 - steps[i].energy_wh));
    }
    EXPECT_LT(difference, 1e-6) << "Wh, in step " << i;
    worst = std::max(worst, difference);
  }
  return worst;
}

TEST(SumoOracle, HillsBendsAndChangingSpeedDrawTheSame) {
  if (!sumo_is_here()) GTEST_SKIP() << "no sumo here: apt-get install sumo";
  const Parameters p;
  const auto steps = simulated(kHillyNodes, kHillyEdges, routes(p, 0.5));
  ASSERT_GT(steps.size(), 60u);
  int turning = 0;
  int uphill = 0;
  int recuperating = 0;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    turning += std::abs(wrap_angle(steps[i].angle - steps[i - 1].angle)) > 0.01 ? 1 : 0;
    uphill += steps[i].slope > 0.01 ? 1 : 0;
    recuperating += steps[i].energy_wh < 0.0 ? 1 : 0;
  }
  EXPECT_GT(turning, 5);
  EXPECT_GT(uphill, 10);
  EXPECT_GT(recuperating, 5);
  RecordProperty("steps", static_cast<int>(steps.size()));
  RecordProperty("worst_wh", fmt::format("{:.2e}", compare(steps, p)));
}

TEST(SumoOracle, WithoutTurnLossNothingIsLeftOpen) {
  if (!sumo_is_here()) GTEST_SKIP() << "no sumo here: apt-get install sumo";
  const Parameters p{.radial = 0.0};
  compare(simulated(kHillyNodes, kHillyEdges, routes(p, 0.5)), p);
}

TEST(SumoOracle, TheBaseLoadDrawsTheSameWhereTheVehicleNeverBrakes) {
  if (!sumo_is_here()) GTEST_SKIP() << "no sumo here: apt-get install sumo";
  const Parameters p{.radial = 0.0, .constant_power_w = 300.0};
  const auto steps = simulated(kFlatNodes, kFlatEdges, routes(p, 0.0));
  ASSERT_GT(steps.size(), 60u);
  for (std::size_t i = 1; i < steps.size(); ++i) EXPECT_GE(steps[i].speed, steps[i - 1].speed);
  compare(steps, p);
}

}  // namespace
}  // namespace headland
