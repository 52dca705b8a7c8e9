// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/geometry/pose2.hpp"

namespace headland {

/// The pose after driving the signed `distance` [m] while the curvature changes evenly: it is
/// `curvature + sharpness * u` [1/m] after the signed distance u. Gauss-Legendre quadrature with as
/// many panels as the turning needs: exact to 2e-12 of the length. Without sharpness the same as
/// `advance` without it.
Pose2 advance(const Pose2& from, double curvature, double sharpness, double distance);

/// A forward curve whose curvature changes evenly along it.
struct Clothoid {
  Pose2 start;
  double curvature = 0.0;  ///< at the start [1/m], positive left
  double sharpness = 0.0;  ///< change of curvature per metre [1/m2]
  double length = 0.0;     ///< [m]

  Pose2 pose_at(double s) const { return advance(start, curvature, sharpness, s); }
  double curvature_at(double s) const { return curvature + sharpness * s; }
  double max_abs_curvature() const;  ///< [1/m]
};

struct ClothoidFit {
  Clothoid curve;
  int iterations = 0;  ///< evaluations that Newton's method took
};

/// The one clothoid that leaves `from` and arrives in `to` without winding around (Bertolazzi and
/// Frego 2015). None where the poses share their place. Its curvature may be anything, and near a
/// full circle its length too: ask max_abs_curvature(). Deterministic, thread-safe, does not
/// allocate.
std::optional<ClothoidFit> fit_clothoid(const Pose2& from, const Pose2& to);

}  // namespace headland
