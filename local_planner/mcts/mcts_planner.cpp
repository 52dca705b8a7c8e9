// SPDX-License-Identifier: Apache-2.0
#include "local_planner/mcts/mcts_planner.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "local_planner/mcts/internal/tree.hpp"
#include "local_planner/outline.hpp"
#include "local_planner/rollout.hpp"
#include "local_planner/standstill.hpp"

namespace headland {

using namespace mcts;

namespace {

constexpr double kPlanStep = 0.1;        // of the plans handed out [s]
constexpr double kCommit = 0.5;          // what is driven before the next plan can stop it [s]
constexpr double kAnyNearer = 0.05;      // [m]
constexpr double kAim = 0.75;            // of the accuracy is aimed at: positions are measured
constexpr int kLooksBetweenClocks = 64;  // a clock is read every so many nodes
constexpr int kMostLooks = 2000000;      // ... and may stand still

// Constant velocities, with what is known of their noise; observed `age` [s] ago.
void coast(std::span<const Agent> agents, double age, double step_s, int steps,
           Prediction& prediction) {
  constexpr double kAcceleration = 0.5;  // spectral density of its noise [m2/s3]
  prediction.step_s = step_s;
  prediction.steps = steps;
  prediction.ids.clear();
  prediction.radius_m.clear();
  prediction.mean.clear();
  prediction.covariance.clear();
  for (const Agent& agent : agents) {
    if (!agent.position.allFinite() || !agent.velocity.allFinite()) continue;
    prediction.ids.push_back(agent.id);
    prediction.radius_m.push_back(agent.radius_m);
    for (int k = 1; k <= steps; ++k) {
      const double t = k * step_s;
      const double since = t + age;
      const double variance =
          agent.noise_m * agent.noise_m + kAcceleration * since * since * since / 3.0 + 1e-4;
      prediction.mean.push_back(agent.position + t * agent.velocity);
      prediction.covariance.push_back(variance * Eigen::Matrix2d::Identity());
    }
  }
}

// Moves a prediction on in time by `age` [s], as each agent goes on.
void move_on(Prediction& prediction, double age) {
  const double share = age / prediction.step_s;
  for (int agent = 0; agent < prediction.agents(); ++agent) {
    Point2 way(0.0, 0.0);  // of one step
    for (int k = 0; k < prediction.steps; ++k) {
      Point2& mean = prediction.mean[prediction.index(agent, k)];
      if (k + 1 < prediction.steps) way = prediction.mean[prediction.index(agent, k + 1)] - mean;
      mean += share * way;
    }
  }
}

}  // namespace

struct MctsPlanner::Impl {
  Impl(const Vehicle& vehicle_in, const MctsConfig& config_in,
       std::unique_ptr<Predictor> predictor_in)
      : vehicle(vehicle_in),
        config(config_in),
        moves(vehicle_in, config_in.step_s),
        predictor(std::move(predictor_in)),
        discs(vehicle_in.footprint) {
    const Footprint& outline = vehicle.footprint;
    centre = 0.5 * (outline.front_m - outline.rear_m);
    radius = std::hypot(0.5 * (outline.front_m + outline.rear_m), 0.5 * outline.width_m);
  }

  Point2 robot_centre(const VehicleState& state) const {
    return state.pose.position() + centre * state.pose.heading();
  }

  LocalScene as_of_now(const LocalScene& scene);
  void set_task(const LocalScene& scene, const LocalGoal& goal);
  double impatience() const;
  double risk_here(const LocalScene& scene) const;
  void set_forecasts(const LocalScene& scene, const mcts::Motion& root);
  std::vector<Point2> robot_path(const mcts::Motion& root, int action) const;
  double tree_match(const LocalScene& scene) const;
  void set_tree(const LocalScene& scene, const mcts::Motion& root);
  void write(const LocalScene& scene, LocalPlan& plan);

  Vehicle vehicle;
  MctsConfig config;
  Manoeuvres moves;
  std::unique_ptr<Predictor> predictor;
  double centre;
  double radius;
  OutlineDiscs discs;
  LocalPlan scratch;

  std::vector<Agent> agents;  // as of now
  std::vector<Forecast> forecasts;
  Prediction prediction;
  Tree tree;
  Task task;
  Found found;
  bool has_tree = false;
  double planned_s = 0.0;  // when
  Standstill standstill;
  int kept = 0;
};

// The scene with its agents moved on since they were seen.
LocalScene MctsPlanner::Impl::as_of_now(const LocalScene& scene) {
  LocalScene now = scene;
  now.age_s = std::max(0.0, scene.age_s);
  agents.assign(scene.agents.begin(), scene.agents.end());
  for (Agent& agent : agents) agent.position += now.age_s * agent.velocity;
  now.agents = agents;
  return now;
}

// The local goal: ahead on the global path, or the next place itself where it is near.
void MctsPlanner::Impl::set_task(const LocalScene& scene, const LocalGoal& goal) {
  const Point2 here = scene.robot.state.pose.position();
  task.moves = &moves;
  task.config = &config;
  task.forecasts = &forecasts;
  task.map = scene.map;
  task.radius = radius;
  if (scene.map != nullptr && !scene.map->empty()) {
    // Nearer to an obstacle than that already, it may go as near, to get away.
    task.radius =
        std::min(radius, scene.map->clearance(robot_centre(scene.robot.state)) - kAnyNearer);
  }
  task.centre = centre;
  task.wanted = speed_within(vehicle, goal.speed_mps, Gear::kForward, 0.0);
  task.final = true;
  task.along = {0.0, 0.0};
  Point2 place = goal.place;
  if (goal.path != nullptr && !goal.path->empty() && goal.s + config.lookahead_m < goal.place_s) {
    const PathSample ahead = goal.path->at(goal.s + config.lookahead_m);
    place = ahead.pose.position();
    task.along = ahead.pose.heading();
    task.final = false;
  }
  task.detour = config.detour_s * impatience();
  task.goal = place - here;
  task.accuracy = task.final ? kAim * std::max(0.0, goal.accuracy_m) : 0.5;
  const double distance = task.goal.norm();
  task.scale = config.cost == MctsCost::kSeed ? std::max(1.0, distance * distance) : 5.0;
}

// Where the robot's centre would be if it began with that action and went on by itself.
std::vector<Point2> MctsPlanner::Impl::robot_path(const mcts::Motion& root, int action) const {
  std::vector<Point2> path;
  mcts::Motion at = root;
  for (int k = 0; k < config.depth_count; ++k) {
    const bool slower = cluster_of(action) == Manoeuvres::kTurns;
    const int heading = moves.towards(at, task.goal.x(), task.goal.y(), task.wanted);
    const Action next =
        slower ? moves.braking(at) : moves.action(at, k == 0 ? action : heading, task.wanted);
    at = moves.drive(at, next);
    path.push_back(Point2(at.x + centre * at.c, at.y + centre * at.s) + forecasts.front().origin());
  }
  return path;
}

// Counts standing: 1 while the robot moves.
double MctsPlanner::Impl::impatience() const {
  return 1.0 + standstill.duration() / config.patience_s;
}

// In the open, keeping well away costs little; in a crowd nobody would get on.
double MctsPlanner::Impl::risk_here(const LocalScene& scene) const {
  const Point2 here = robot_centre(scene.robot.state);
  const auto near = std::count_if(scene.agents.begin(), scene.agents.end(), [&](const Agent& a) {
    return (a.position - here).norm() <= config.view_m;
  });
  const double density = static_cast<double>(near) / (kPi * config.view_m * config.view_m);
  const double crowded = std::min(1.0, density / config.crowd_per_m2);
  return config.open_risk_ratio + crowded * (config.risk_ratio - config.open_risk_ratio);
}

void MctsPlanner::Impl::set_forecasts(const LocalScene& scene, const mcts::Motion& root) {
  const Point2 here = scene.robot.state.pose.position();
  MctsConfig impatient = config;
  impatient.risk_ratio = risk_here(scene) / impatience();
  if (predictor == nullptr) {
    coast(scene.agents, scene.age_s, config.step_s, config.depth_count, prediction);
    forecasts.resize(1);
    forecasts.front().set(prediction, scene.agents, here, radius, impatient);
    return;
  }
  const bool reacts = predictor->reacts();
  forecasts.resize(reacts ? kClusters : 1);
  for (std::size_t i = 0; i < forecasts.size(); ++i) forecasts[i].set({}, {}, here, radius, config);
  for (std::size_t i = 0; i < forecasts.size(); ++i) {
    const int turn = std::min(static_cast<int>(i), Manoeuvres::kTurns - 1);
    const int speed = static_cast<int>(i) == Manoeuvres::kTurns ? 0 : 2;
    std::vector<Point2> path;
    if (reacts) path = robot_path(root, turn * Manoeuvres::kSpeeds + speed);
    predictor->predict(path, config.step_s, config.depth_count, prediction);
    if (scene.age_s > 0.0) move_on(prediction, scene.age_s);
    forecasts[i].set(prediction, scene.agents, here, radius, impatient);
  }
}

// Gamma of (003) Eq. 3 for the tree of the last plan; 0 if it does not fit what is seen now. With
// nobody near, half: what the equation gives for a perfect match.
double MctsPlanner::Impl::tree_match(const LocalScene& scene) const {
  if (!has_tree || found.braking) return 0.0;
  const double level = (scene.time_s - planned_s) / config.step_s;
  if (std::abs(level - 1.0) > 0.3 || scene.time_s - planned_s > config.stale_s + config.step_s) {
    return 0.0;
  }
  const Point2 here = robot_centre(scene.robot.state);
  const Forecast& forecast =
      forecasts[forecasts.size() == 1 ? 0
                                      : static_cast<std::size_t>(cluster_of(found.first_action))];
  double sum = 0.0;
  int count = 0;
  for (const Agent& agent : scene.agents) {
    if (!((agent.position - here).norm() <= 2.0 * config.influence_m)) continue;
    Point2 expected;
    if (!forecast.expected(agent.id, level, expected)) return 0.0;
    const double error = (agent.position - expected).norm();
    if (!(error < config.match_m)) return 0.0;
    sum += (config.match_m - error) / config.match_m;
    ++count;
  }
  return count == 0 ? 0.5 : sum / (2.0 * count);
}

void MctsPlanner::Impl::set_tree(const LocalScene& scene, const mcts::Motion& root) {
  const double gamma = tree_match(scene);
  kept = gamma > 0.0 ? tree.advance(found.first_action, root, gamma) : 0;
  if (kept == 0) tree.reset(root);
}

// The plan in short steps, driven by the vehicle's own model.
void MctsPlanner::Impl::write(const LocalScene& scene, LocalPlan& plan) {
  if (found.braking || found.actions.empty()) {
    brake(vehicle, scene.robot.state, scene.time_s, LocalStatus::kBraking, plan);
    if (std::abs(scene.robot.state.speed) < 1e-3) plan.status = LocalStatus::kBlocked;
    return;
  }
  plan.status = LocalStatus::kPlanned;
  plan.begin_s = scene.time_s;
  const int parts = std::max(1, static_cast<int>(std::lround(config.step_s / kPlanStep)));
  plan.step_s = config.step_s / parts;
  plan.states.assign(1, scene.robot.state);
  for (const Action& action : found.actions) {
    for (int i = 0; i < parts; ++i) {
      const VehicleState& now = plan.states.back();
      plan.states.push_back(step_vehicle(
          vehicle, now, moves.command(vehicle, now, action, plan.step_s), plan.step_s));
    }
  }
  // The tree looks at discs of the outline, level by level; this, at what is driven.
  if (!stays_clear(vehicle, discs, scene.map, plan, kCommit, scratch)) {
    brake(vehicle, scene.robot.state, scene.time_s, LocalStatus::kBraking, plan);
  }
}

MctsPlanner::MctsPlanner(const Vehicle& vehicle, const MctsConfig& config,
                         std::unique_ptr<Predictor> predictor)
    : LocalPlanner(vehicle), impl_(std::make_unique<Impl>(vehicle, config, std::move(predictor))) {}
MctsPlanner::~MctsPlanner() = default;

int MctsPlanner::kept_nodes() const { return impl_->kept; }

void MctsPlanner::do_observe(const LocalScene& scene) {
  if (impl_->predictor == nullptr) return;
  const VehicleState& robot = scene.robot.state;
  impl_->predictor->observe(scene.agents, impl_->robot_centre(robot),
                            robot.speed * robot.pose.heading(), scene.time_s - scene.age_s);
}

void MctsPlanner::do_plan(const LocalScene& seen, const LocalGoal& goal, const PlanBudget& budget,
                          LocalPlan& plan) {
  Impl& d = *impl_;
  const LocalScene scene = d.as_of_now(seen);
  d.standstill.update(scene.time_s, scene.robot.state.speed);
  d.set_task(scene, goal);
  VehicleState local = scene.robot.state;
  local.pose.x = 0.0;
  local.pose.y = 0.0;
  const mcts::Motion root = d.moves.from(local);
  d.set_tree(scene, root);
  d.set_forecasts(scene, root);
  d.tree.begin(d.task);
  int looks = 0;
  const bool live = budget.deadline.clock != nullptr;
  const int most = live && budget.iterations <= 0 ? kMostLooks : budget.iterations;
  while (looks < most) {
    if (live && looks % kLooksBetweenClocks == 0 && budget.deadline.passed()) break;
    d.tree.expand(d.task);
    ++looks;
  }
  d.tree.best(d.task, d.found);
  d.has_tree = true;
  d.planned_s = scene.time_s;
  d.write(scene, plan);
  plan.expansions = looks;
  plan.cost = d.found.cost;
}

}  // namespace headland
