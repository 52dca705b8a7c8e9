// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/world/internal/geojson.hpp"

namespace headland::internal {

/// Translates features of the AGRIDS vineyard schema (properties.class) into our own kinds:
/// block -> row_parcel, row -> row of its block, entrance_exit -> gate, building and conservation
/// areas -> keep_out, points of buildings, toilets and hazardous material -> poi with the class as
/// its role. Other classes (drainage lines, posts, single vines) are left out. A row's id is its
/// shortCode, made unique where that repeats or is missing.
std::vector<Feature> from_agrids(std::vector<Feature> features);

}  // namespace headland::internal
