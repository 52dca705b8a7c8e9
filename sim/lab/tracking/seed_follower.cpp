// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/tracking/seed_follower.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kRowSpacing = 0.5;    // (002) part D [m]
constexpr double kTurnSpacing = 0.25;  // [m]
constexpr double kDoneWithin = 0.5;    // [m]
constexpr double kSearch = 2.0;        // [m]

}  // namespace

SeedFollower::SeedFollower(const Vehicle& vehicle, const SeedPurePursuitConfig& config)
    : vehicle_(vehicle), config_(config) {
  config_.wheelbase_m = vehicle.wheelbase_m;
  config_.max_steering_deg = vehicle.max_steering_deg;
}

Result<void> SeedFollower::do_start() {
  const Path& path = reference().path;
  if (path.segments().size() > 1) {
    return fail(ErrorCode::kUnsupported, "seed 002's pure pursuit knows no reverse gear",
                "a path without cusps");
  }
  route_ = {};
  int leg = -1;
  for (const PathPiece& piece : path.pieces()) leg = std::max(leg, piece.leg);
  for (int l = 0; l <= leg; ++l) {
    const auto [begin, end] = path.leg_range(l);
    const bool turn = path.at(0.5 * (begin + end)).curvature != 0.0;
    const double spacing = turn ? kTurnSpacing : kRowSpacing;
    const int count = std::max(2, static_cast<int>(std::ceil((end - begin) / spacing)) + 1);
    for (int i = l == 0 ? 0 : 1; i < count; ++i) {
      route_.points.push_back(path.at(begin + (end - begin) * i / (count - 1)).pose.position());
    }
    route_.link.resize(route_.points.size(), l);
    route_.is_turn.push_back(turn);
    route_.guided.push_back(route_.points.back());
  }
  pursuit_.emplace(config_, route_);
  s_ = 0.0;
  done_ = false;
  return {};
}

TrackOutput SeedFollower::do_step(const VehicleEstimate& estimate, double dt) {
  const VehicleState& state = estimate.state;
  const Path& path = reference().path;
  s_ = std::max(s_, path.project(state.pose.position(), s_ - kSearch, s_ + kSearch).s);
  const Point2 left = path.end_pose().position() - state.pose.position();
  done_ = done_ || (left.norm() < kDoneWithin && s_ > path.length() - 2.0 * kDoneWithin) ||
          s_ >= path.length() - 1e-6;
  if (done_) {
    const bool still = std::abs(state.speed) < 1e-3;
    return {{0.0, state.steering, 0.0}, still ? TrackStatus::kDone : TrackStatus::kTracking, s_};
  }
  const double wanted = reference().leg_speed[static_cast<std::size_t>(path.at(s_).leg)];
  const double most = vehicle_.acceleration_mps2 * dt;
  const double speed = std::clamp(wanted, state.speed - most, state.speed + most);
  return {{speed, pursuit_->step(state.pose).steering, 0.0}, TrackStatus::kTracking, s_};
}

}  // namespace headland
