// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/acfr/episode.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "core/base/random.hpp"
#include "sim/crowd/sight.hpp"

namespace headland {
namespace {

constexpr double kBack = 3.0;          // the path is searched this far back for the progress [m]
constexpr double kAhead = 8.0;         // ... and ahead
constexpr double kFree = 3.0;          // around the robot no agent starts [m]
constexpr double kStill = 0.05;        // slower, the robot is not at fault [m/s]
constexpr double kStanding = 0.01;     // [m/s]
constexpr double kSamplePeriod = 5.0;  // of the displacement [s]
constexpr double kFilmed = 12.0;       // around the robot, agents are filmed [m]
constexpr double kFilmedPath = 0.5;    // between points of the filmed path [m]

class Drive {
 public:
  Drive(const AcfrDrive& drive, LocalPlanner& planner)
      : drive_(drive),
        tour_(*drive.tour),
        world_(*drive.world),
        planner_(planner),
        low_(tour_.low - Point2(world_.margin_m, world_.margin_m)),
        high_(tour_.high + Point2(world_.margin_m, world_.margin_m)),
        crowd_(world_.crowd, agents(), {}, drive.seed,
               goals_within(
                   Region({{{low_, {high_.x(), low_.y()}, high_, {low_.x(), high_.y()}}, {}}}))),
        noise_(drive.seed, "study/acfr/noise") {
    robot_.pose = tour_.path.start_pose();
    if (drive_.film != nullptr) begin_film();
  }

  AcfrOutcome run() {
    next_place(0.0);
    const long period = std::max(1L, std::lround(world_.plan_period_s / world_.step_s));
    for (long tick = 0; place_ < tour_.places.size(); ++tick) {
      const double time = static_cast<double>(tick) * world_.step_s;
      if (tick % period == 0) decide(time);
      move(time);
      count_interactions(time + world_.step_s);
      if (drive_.film != nullptr) film(time + world_.step_s);
      sample(time + world_.step_s);
      check_place(time + world_.step_s);
    }
    for (auto& [id, meeting] : meetings_) outcome_.interactions.push_back(meeting);
    return std::move(outcome_);
  }

 private:
  Point2 centre() const {
    const Footprint& f = drive_.vehicle.footprint;
    return robot_.pose.position() + 0.5 * (f.front_m - f.rear_m) * robot_.pose.heading();
  }

  std::vector<CrowdAgent> agents() const {
    RandomStream random(drive_.seed, "study/acfr/agents");
    const auto anywhere = [&] {
      return Point2(random.uniform(low_.x(), high_.x()), random.uniform(low_.y(), high_.y()));
    };
    const double area = (high_ - low_).prod();
    std::vector<CrowdAgent> all(static_cast<std::size_t>(area / drive_.density_m2));
    const Point2 start = tour_.path.start_pose().position();
    for (CrowdAgent& agent : all) {
      do {
        agent.position = anywhere();
      } while ((agent.position - start).norm() < kFree);
      agent.goal = anywhere();
      agent.radius_m = world_.agent_radius_m + world_.slack_m;
      agent.speed_mps = random.uniform(world_.agent_speed_min_mps, world_.agent_speed_max_mps);
      agent.max_speed_mps = world_.agent_speed_max_mps;
    }
    return all;
  }

  void next_place(double time) {
    assigned_s_ = time;
    if (place_ < tour_.places.size()) {
      assigned_m_ = (tour_.places[place_] - robot_.pose.position()).norm();
    }
  }

  // What the robot sees, with noise.
  LocalScene look(double time) {
    see_agents(crowd_.agents(), centre(), world_.view_m, world_.agent_noise_ratio, noise_, seen_);
    for (Agent& agent : seen_) agent.radius_m = world_.agent_radius_m;
    LocalScene scene;
    scene.time_s = time;
    scene.agents = seen_;
    VehicleState& told = scene.robot.state;
    told = robot_;
    told.pose.x += world_.position_noise_m * noise_.normal();
    told.pose.y += world_.position_noise_m * noise_.normal();
    told.pose.yaw += deg_to_rad(world_.heading_noise_deg) * noise_.normal();
    return scene;
  }

  void decide(double time) {
    const LocalScene scene = look(time);
    const double end = tour_.place_s[place_];
    const Point2 told = scene.robot.state.pose.position();
    const double from = std::max(0.0, std::min(progress_, end) - kBack);
    progress_ = tour_.path.project(told, from, std::min(end, progress_ + kAhead)).s;
    LocalGoal goal;
    goal.path = &tour_.path;
    goal.s = progress_;
    goal.place = tour_.places[place_];
    goal.place_s = end;
    goal.accuracy_m = drive_.accuracy_m;
    goal.speed_mps = world_.speed_mps;
    const double begin = drive_.clock != nullptr ? drive_.clock->now() : 0.0;
    planner_.observe(scene);
    planner_.plan(scene, goal, drive_.budget, plan_);
    if (drive_.clock != nullptr) {
      outcome_.plan_ms.push_back(1e3 * (drive_.clock->now() - begin));
    }
  }

  void move(double time) {
    const VehicleState wanted = plan_.at(time + world_.step_s);
    const Command command{wanted.speed, wanted.steering, wanted.yaw_rate};
    const CrowdRobot body{centre(), robot_.speed * robot_.pose.heading(),
                          world_.robot_radius_m + world_.slack_m, world_.robot_share_ratio};
    const Point2 before = robot_.pose.position();
    robot_ = step_vehicle(drive_.vehicle, robot_, command, world_.step_s);
    crowd_.step(world_.step_s, {&body, 1});
    outcome_.length_m += (robot_.pose.position() - before).norm();
    stand_s_ = std::abs(robot_.speed) < kStanding ? stand_s_ + world_.step_s : 0.0;
    if (stand_s_ > 0.0) outcome_.standing_s += world_.step_s;
    outcome_.longest_stand_s = std::max(outcome_.longest_stand_s, stand_s_);
  }

  void count_interactions(double time) {
    const Point2 here = centre();
    const Point2 velocity = robot_.speed * robot_.pose.heading();
    for (const Agent& agent : crowd_.agents()) {
      const Point2 off = agent.position - here;
      const double distance = off.norm();
      const auto known = meetings_.find(agent.id);
      if (distance >= world_.interaction_m) {
        if (known == meetings_.end()) continue;
        outcome_.interactions.push_back(known->second);
        meetings_.erase(known);
        continue;
      }
      AcfrInteraction& meeting =
          meetings_.try_emplace(agent.id, AcfrInteraction{distance}).first->second;
      meeting.least_m = std::min(meeting.least_m, distance);
      const Point2 towards = distance > 1e-9 ? Point2(off / distance) : Point2(1.0, 0.0);
      const double by_robot = velocity.dot(towards);
      const double by_agent = -agent.velocity.dot(towards);
      if (distance < world_.near_m && !meeting.near) {
        meeting.near = true;
        meeting.robot_fault = by_robot > kStill && by_robot >= by_agent;
        tell(time, agent.position, meeting.robot_fault ? "near_robot" : "near_agent",
             "near-collision");
      }
      if (outline_gap(drive_.vehicle.footprint, robot_.pose, agent.position,
                      world_.agent_radius_m) < 0.0) {
        if (!meeting.contact) tell(time, agent.position, "contact", "contact");
        meeting.contact = true;
        meeting.robot_contact = meeting.robot_contact || by_robot > kStill;
      }
    }
  }

  Projection on_path() const {
    return tour_.path.project(robot_.pose.position(), std::max(0.0, progress_ - 3.0 * kAhead),
                              progress_ + 3.0 * kAhead);
  }

  void sample(double time) {
    if (time < next_sample_) return;
    next_sample_ += kSamplePeriod;
    outcome_.displacements.emplace_back(time, on_path().distance);
  }

  void begin_film() {
    Film& film = *drive_.film;
    film.outline = drive_.vehicle.footprint;
    for (const PathSample& sample : tour_.path.sample(kFilmedPath)) {
      film.path.push_back(sample.pose.position());
    }
    for (std::size_t i = 0; i < tour_.places.size(); ++i) {
      const bool station = i + 1 == tour_.places.size();
      film.places.push_back({station ? "station" : fmt::format("waypoint {}", i + 1),
                             tour_.places[i], drive_.accuracy_m});
    }
  }

  void film(double time) {
    FilmFrame frame{time, robot_.pose, robot_.speed, robot_.steering, outcome_.length_m};
    const Projection at = on_path();
    frame.off_m = std::copysign(at.distance, at.lateral_error);
    frame.place = static_cast<int>(place_);
    frame.clearance_m = kFilmed;
    for (Agent agent : crowd_.agents()) {
      if ((agent.position - centre()).norm() > kFilmed) continue;
      agent.radius_m = world_.agent_radius_m;
      frame.clearance_m = std::min(
          frame.clearance_m,
          outline_gap(drive_.vehicle.footprint, robot_.pose, agent.position, agent.radius_m));
      frame.agents.push_back(agent);
    }
    drive_.film->frames.push_back(std::move(frame));
  }

  void tell(double time, const Point2& where, const char* kind, std::string text) {
    if (drive_.film != nullptr) drive_.film->events.push_back({time, where, kind, std::move(text)});
  }

  void check_place(double time) {
    const double off = (tour_.places[place_] - robot_.pose.position()).norm();
    const double taken = time - assigned_s_;
    const bool reached = off <= drive_.accuracy_m;
    if (!reached && taken < world_.timeout_s) return;
    outcome_.visits.push_back({assigned_m_, taken, reached});
    if (!reached) tell(time, tour_.places[place_], "given_up", "given up");
    outcome_.duration_s = time;
    ++place_;
    next_place(time);
  }

  const AcfrDrive& drive_;
  const AcfrTour& tour_;
  const AcfrWorldConfig& world_;
  LocalPlanner& planner_;
  Point2 low_;
  Point2 high_;
  Crowd crowd_;
  RandomStream noise_;
  VehicleState robot_;
  LocalPlan plan_;
  std::vector<Agent> seen_;
  std::map<int, AcfrInteraction> meetings_;
  AcfrOutcome outcome_;
  std::size_t place_ = 0;
  double assigned_s_ = 0.0;
  double assigned_m_ = 0.0;
  double progress_ = 0.0;
  double stand_s_ = 0.0;
  double next_sample_ = 0.0;
};

}  // namespace

AcfrOutcome drive_acfr(const AcfrDrive& drive, LocalPlanner& planner) {
  return Drive(drive, planner).run();
}

}  // namespace headland
