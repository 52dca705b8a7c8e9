// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <utility>

#include "core/config/visit.hpp"

namespace headland {

/// What the ground is made of, as far as rolling on it goes.
enum class SoilClass { kTrack, kFirm, kTilled, kSoft, kSand };

/// Resistance of one class of soil to a pneumatic tyre.
struct SoilResistance {
  double rolling_ratio = 0.0;      ///< rolling resistance over weight
  double slip_per_traction = 0.0;  ///< slip ratio per traction force over weight
};

/// The table, with its sources in soil.cpp.
SoilResistance soil_resistance(SoilClass soil);

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::SoilClass> {
  static constexpr std::pair<headland::SoilClass, std::string_view> values[] = {
      {headland::SoilClass::kTrack, "track"},
      {headland::SoilClass::kFirm, "firm"},
      {headland::SoilClass::kTilled, "tilled"},
      {headland::SoilClass::kSoft, "soft"},
      {headland::SoilClass::kSand, "sand"}};
};
