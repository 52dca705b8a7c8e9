// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/curve.hpp"
#include "core/geometry/region.hpp"
#include "core/model/vehicle.hpp"

namespace headland::roadmap {

/// Does a vehicle's outline with its margin stay in an area? The area must outlive this.
/// Thread-safe; does not allocate.
class OutlineFit {
 public:
  /// @param margin Kept between the outline and the edge of the area [m].
  OutlineFit(const Region& area, const Footprint& outline, double margin);

  bool fits(const Pose2& pose) const;
  /// All along the piece. Straights exactly, by the band that the outline sweeps; arcs by samples
  /// between which no point of the outline moves by more than twice the margin, so that a sample
  /// vouches, with its margin, for the outline halfway to its neighbours.
  bool fits(const Pose2& from, const CurvePiece& piece) const;
  bool fits(const Pose2& from, const Curve& curve) const;

  const Region& area() const { return area_; }
  /// Of the largest disc around the base that the outline with its margin holds [m].
  double disc_radius() const;

 private:
  bool fits_arc(const Pose2& from, const CurvePiece& arc) const;

  const Region& area_;
  Footprint outline_;
  double margin_;
};

}  // namespace headland::roadmap
