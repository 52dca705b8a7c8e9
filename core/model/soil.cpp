// SPDX-License-Identifier: Apache-2.0
#include "core/model/soil.hpp"

namespace headland {

SoilResistance soil_resistance(SoilClass soil) {
  switch (soil) {
    case SoilClass::kTrack:
      return {0.02, 0.10};
    case SoilClass::kFirm:
      break;
    case SoilClass::kTilled:
      return {0.06, 0.20};
    case SoilClass::kSoft:
      return {0.08, 0.30};
    case SoilClass::kSand:
      return {0.20, 0.50};
  }
  return {0.05, 0.15};
}

}  // namespace headland
