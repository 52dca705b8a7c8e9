// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/ebs221/drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/polygon.hpp"

namespace headland {
namespace {

constexpr double kEndRadius = 0.5;   // of the seed's loop [m]
constexpr int kLeastPeriods = 1000;  // of the seed's loop
constexpr double kWindow = 3.0;      // of the projection, around the tracker's progress [m]
constexpr double kStanding = 1e-3;   // [m/s]

void euler(const SeedPlant& plant, double wheelbase, double steering, Pose2& pose) {
  const double dt = plant.period_s / plant.euler_steps;
  for (int i = 0; i < plant.euler_steps; ++i) {
    pose.x += dt * plant.speed_mps * std::cos(pose.yaw);
    pose.y += dt * plant.speed_mps * std::sin(pose.yaw);
    pose.yaw += dt * plant.speed_mps * std::tan(steering) / wheelbase;
  }
}

// Nearest point of the path around the tracker's progress, never across a cusp: there the path
// runs back on itself.
PathError error_at(const Path& path, const Point2& position, double progress) {
  const PathSegment& segment = path.segments()[static_cast<std::size_t>(path.at(progress).segment)];
  const Projection nearest = path.project(position, std::max(segment.begin_s, progress - kWindow),
                                          std::min(segment.end_s, progress + kWindow));
  const int leg = path.at(std::min(nearest.s, segment.end_s - 1e-9)).leg;
  return {nearest.s, nearest.lateral_error, nearest.distance, leg};
}

}  // namespace

FieldDrive drive_seed_field(const SeedPlant& plant, const SeedPurePursuitConfig& config,
                            const SeedRoute& route, const Path& path, const Pose2& start) {
  SeedPurePursuit controller(config, route);
  FieldDrive drive;
  Pose2 pose = start;
  const int most = static_cast<int>(std::lround(plant.max_time_s / plant.period_s));
  for (int k = 1; k <= most; ++k) {
    const SeedPurePursuit::Output out = controller.step(pose);
    drive.positions.push_back(pose.position());
    drive.steering.push_back(out.steering);
    drive.guided_count += out.guided ? 1 : 0;
    euler(plant, config.wheelbase_m, out.steering, pose);
    const double to_end = (pose.position() - route.points.back()).norm();
    drive.completed = to_end < kEndRadius && k >= kLeastPeriods;
    if (drive.completed) break;
  }
  drive.duration = static_cast<double>(drive.positions.size()) * plant.period_s;
  drive.distance = drive.duration * plant.speed_mps;
  drive.errors = errors_from_path(drive.positions, path);
  return drive;
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
  for (int k = 0; k < most; ++k) {
    const TrackOutput out = tracker.step(state, period);
    drive.completed = out.status == TrackStatus::kDone && std::abs(state.speed) < kStanding;
    if (drive.completed || out.status == TrackStatus::kPathLost) break;
    drive.positions.push_back(state.pose.position());
    drive.errors.push_back(error_at(path, state.pose.position(), out.s));
    if (state.speed * sign(path.at(out.s).gear) < -kStanding) ++drive.wrong_gear_count;
    const Point2 before = state.pose.position();
    state = step_vehicle(vehicle, state, out.command, period);
    drive.steering.push_back(state.steering);
    drive.distance += (state.pose.position() - before).norm();
  }
  drive.duration = static_cast<double>(drive.positions.size()) * period;
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
