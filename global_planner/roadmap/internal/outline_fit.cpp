// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/internal/outline_fit.hpp"

#include <algorithm>
#include <cmath>

namespace headland::roadmap {
namespace {

constexpr double kSmallestStep = 0.02;  // [m] between samples, where there is no margin

}  // namespace

OutlineFit::OutlineFit(const Region& area, const Footprint& outline, double margin)
    : area_(area), outline_(outline), margin_(margin) {}

double OutlineFit::disc_radius() const {
  return std::min({outline_.front_m, outline_.rear_m, 0.5 * outline_.width_m}) + margin_;
}

bool OutlineFit::fits(const Pose2& pose) const { return area_.contains(pose, outline_, margin_); }

bool OutlineFit::fits(const Pose2& from, const CurvePiece& piece) const {
  if (piece.curvature != 0.0) return fits_arc(from, piece);
  Footprint swept = outline_;
  swept.front_m += std::max(piece.length, 0.0);
  swept.rear_m += std::max(-piece.length, 0.0);
  return area_.contains(from, swept, margin_);
}

bool OutlineFit::fits_arc(const Pose2& from, const CurvePiece& arc) const {
  // The farthest corner from the turning centre moves fastest.
  const double radius = 1.0 / std::abs(arc.curvature);
  const double corner =
      std::hypot(radius + 0.5 * outline_.width_m, std::max(outline_.front_m, outline_.rear_m));
  const double moved = std::abs(arc.length) * corner / radius;
  const double step = std::max(2.0 * margin_, kSmallestStep);
  const int count = std::max(1, static_cast<int>(std::ceil(moved / step)));
  const auto fits_at = [&](int k) {
    return fits(advance(from, arc.curvature, arc.length * k / count));
  };
  if (!fits_at(0) || !fits_at(count)) return false;
  // From coarse to fine, so that an arc that does not fit is found out early.
  int stride = 1;
  while (stride < count) stride *= 2;
  for (stride /= 2; stride >= 1; stride /= 2) {
    for (int k = stride; k < count; k += 2 * stride) {
      if (!fits_at(k)) return false;
    }
  }
  return true;
}

bool OutlineFit::fits(const Pose2& from, const Curve& curve) const {
  if (!fits(curve.end_pose(from))) return false;
  Pose2 start = from;
  for (const CurvePiece& piece : curve) {
    if (!fits(start, piece)) return false;
    start = advance(start, piece.curvature, piece.length);
  }
  return true;
}

}  // namespace headland::roadmap
