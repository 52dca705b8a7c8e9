// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/ebs221/drive.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/geometry/polygon.hpp"
#include "sim/lab/ebs221/seed_fishtail.hpp"

namespace headland {
namespace {

constexpr double kEndRadius = 0.5;   // of the seed's loop [m]
constexpr int kLeastPeriods = 1000;  // of the seed's loop
constexpr double kWindow = 3.0;      // of the projection, around the tracker's progress [m]
constexpr double kStanding = 1e-3;   // [m/s]

void euler(const SeedPlant& plant, double wheelbase, double speed, double steering, Pose2& pose) {
  const double dt = plant.period_s / plant.euler_steps;
  for (int i = 0; i < plant.euler_steps; ++i) {
    pose.x += dt * speed * std::cos(pose.yaw);
    pose.y += dt * speed * std::sin(pose.yaw);
    pose.yaw += dt * speed * std::tan(steering) / wheelbase;
  }
}

struct SeedCommand {
  double steering = 0.0;  // [rad]
  Gear gear = Gear::kForward;
};

FieldDrive seed_loop(const SeedPlant& plant, const SeedPurePursuitConfig& config,
                     const SeedRoute& route, const Pose2& start,
                     const std::function<SeedCommand(const Pose2&)>& controller) {
  FieldDrive drive;
  Pose2 pose = start;
  const int most = static_cast<int>(std::lround(plant.max_time_s / plant.period_s));
  for (int k = 1; k <= most; ++k) {
    const SeedCommand command = controller(pose);
    drive.positions.push_back(pose.position());
    drive.steering.push_back(command.steering);
    drive.gears.push_back(command.gear);
    euler(plant, config.wheelbase_m, sign(command.gear) * plant.speed_mps, command.steering, pose);
    const double to_end = (pose.position() - route.points.back()).norm();
    drive.completed = to_end < kEndRadius && k >= kLeastPeriods;
    if (drive.completed) break;
  }
  drive.duration = static_cast<double>(drive.positions.size()) * plant.period_s;
  drive.distance = drive.duration * plant.speed_mps;
  return drive;
}

// Which stretch of one gear the vehicle is on. A stop at a cusp belongs to the stretch before it
// until the vehicle stands, wherever the tracker already looks.
class GearWatch {
 public:
  explicit GearWatch(const Path& path) : path_(path) {}

  // True if the vehicle moves against the gear of its stretch, or a stretch was left out.
  bool wrong(double progress, double speed) {
    const int ahead = path_.at(progress).segment;
    const bool skipped = ahead > segment_ + 1;
    const bool follows = speed * sign(segment(ahead).gear) >= -kStanding;
    if (ahead != segment_ && follows) segment_ = ahead;
    return skipped || speed * sign(segment(segment_).gear) < -kStanding;
  }

  // Error to the nearest point around the progress, within the stretch: at a cusp the path runs
  // back on itself.
  PathError error(const Point2& position, double progress) const {
    const PathSegment& own = segment(segment_);
    const Projection nearest =
        path_.project(position, std::clamp(progress - kWindow, own.begin_s, own.end_s),
                      std::clamp(progress + kWindow, own.begin_s, own.end_s));
    const int leg = path_.at(std::min(nearest.s, own.end_s - 1e-9)).leg;
    return {nearest.s, nearest.lateral_error, nearest.distance, leg};
  }

 private:
  const PathSegment& segment(int number) const {
    return path_.segments()[static_cast<std::size_t>(number)];
  }

  const Path& path_;
  int segment_ = 0;
};

}  // namespace

FieldDrive drive_seed_field(const SeedPlant& plant, const SeedPurePursuitConfig& config,
                            const SeedRoute& route, const Path& path, const Pose2& start) {
  SeedPurePursuit controller(config, route);
  int guided = 0;
  FieldDrive drive = seed_loop(plant, config, route, start, [&](const Pose2& pose) {
    const SeedPurePursuit::Output out = controller.step(pose);
    guided += out.guided ? 1 : 0;
    return SeedCommand{out.steering, Gear::kForward};
  });
  drive.guided_count = guided;
  drive.errors = errors_from_path(drive.positions, path);
  return drive;
}

FieldDrive drive_seed_fishtail(const SeedPlant& plant, const SeedPurePursuitConfig& config,
                               const SeedRoute& route, const std::vector<bool>& fishtails,
                               const Pose2& start) {
  SeedFishtailPursuit controller(config, route, fishtails);
  return seed_loop(plant, config, route, start, [&](const Pose2& pose) {
    const SeedFishtailPursuit::Output out = controller.step(pose);
    return SeedCommand{out.steering, out.reverse ? Gear::kReverse : Gear::kForward};
  });
}

FieldDrive drive_our_field(Tracker& tracker, const Vehicle& vehicle, const Reference& reference,
                           double period) {
  const Path& path = reference.path;
  const double slowest = *std::min_element(reference.leg_speed.begin(), reference.leg_speed.end());
  const int most = 1000 + static_cast<int>(3.0 * path.length() / (slowest * period));
  FieldDrive drive;
  VehicleState state;
  state.pose = path.start_pose();
  tracker.start(reference);
  GearWatch watch(path);
  for (int k = 0; k < most; ++k) {
    const TrackOutput out = tracker.step(state, period);
    drive.completed = out.status == TrackStatus::kDone && std::abs(state.speed) < kStanding;
    if (drive.completed || failed(out.status)) break;
    drive.duration += period;
    drive.wrong_gear_count += watch.wrong(out.s, state.speed) ? 1 : 0;
    const Point2 before = state.pose.position();
    state = step_vehicle(vehicle, state, out.command, period);
    drive.distance += (state.pose.position() - before).norm();
    if (std::abs(state.speed) < kStanding) continue;
    drive.positions.push_back(before);
    drive.errors.push_back(watch.error(before, out.s));
    drive.steering.push_back(state.steering);
    drive.gears.push_back(state.speed < 0.0 ? Gear::kReverse : Gear::kForward);
  }
  return drive;
}

std::vector<PathError> seed_errors(std::span<const Point2> positions, const SeedRoute& route) {
  std::vector<PathError> errors;
  errors.reserve(positions.size());
  for (const Point2& p : positions) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < route.points.size(); ++i) {
      const double squared = (route.points[i] - p).squaredNorm();
      if (squared >= least) continue;
      least = squared;
      nearest = i;
    }
    const int link = route.link[nearest];
    double distance = std::numeric_limits<double>::infinity();
    const auto last = static_cast<std::size_t>(route.last_point(link));
    const auto first = static_cast<std::size_t>(link == 0 ? 0 : route.last_point(link - 1) + 1);
    for (std::size_t i = first; i < last; ++i) {
      distance = std::min(distance, distance_to_segment(p, route.points[i], route.points[i + 1]));
    }
    errors.push_back({0.0, 0.0, distance, link});
  }
  return errors;
}

}  // namespace headland
