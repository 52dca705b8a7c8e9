// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/world/farm.hpp"

namespace headland::internal {

/// What a set of given rows says about its parcel.
struct RowFit {
  double spacing_m = 0.0;    ///< median distance between neighbours; of one row: area / length
  double heading_rad = 0.0;  ///< length-weighted mean, in (-pi/2, pi/2] of the first row's heading
};

/// Requires at least one row of non-zero length.
RowFit fit_rows(const RowParcel& parcel);

}  // namespace headland::internal
