// SPDX-License-Identifier: Apache-2.0
#include "control/path_progress.hpp"

#include <algorithm>

namespace headland {
namespace {

constexpr double kTangentFrom = 0.05;  // of a segment's end, where its tangent measures [m]
constexpr double kPastCusp = 2e-6;  // behind a cusp, of the segments that meet there the later [m]

}  // namespace

void PathProgress::start(const Path& path) {
  path_ = &path;
  number_ = 0;
  s_ = 0.0;
}

void PathProgress::next_segment() {
  ++number_;
  s_ = segment().begin_s;
}

double PathProgress::inside(double s) const {
  return std::clamp(s, segment().begin_s, segment().end_s);
}

Projection PathProgress::nearest(const Point2& p_map, double search) const {
  return path_->project(p_map, inside(s_ - search), inside(s_ + search));
}

double PathProgress::remaining(const Pose2& pose, double s) const {
  const PathSegment& now = segment();
  if (s < now.end_s - kTangentFrom) return now.end_s - s;
  const PathSample end = path_->at(now.end_s - kBeforeEnd);
  return sign(now.gear) * (end.pose.position() - pose.position()).dot(end.pose.heading());
}

void PathProgress::move_to(double s) {
  const double least = std::max(s_, segment().begin_s + kPastCusp);
  s_ = std::clamp(s, least, std::max(least, segment().end_s - kBeforeEnd));
}

}  // namespace headland
