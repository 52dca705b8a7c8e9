// SPDX-License-Identifier: Apache-2.0
#include "core/model/soil.hpp"

namespace headland {

// Firm, tilled, soft: Brixius' equations as in ASABE D497, each class at the lowest cone index of
// its range (1200, 900, 450 kPa), for wheels of 0.20 x 0.70 m under 600 kg to 0.40 x 1.30 m under
// 4 t, tyre deflection 20 %:
//   Bn = (CI b d / W) (1 + 5 delta/h) / (1 + 3 b/d)
//   rolling ratio = 1/Bn + 0.04 + 0.5 s/sqrt(Bn)  at 5 % slip: 0.050-0.058, 0.053-0.064,
//   0.065-0.085 traction ratio = 0.88 (1 - e^(-0.1 Bn)) (1 - e^(-7.5 s)) + 0.04, solved for the
//   slip s where the traction is 0.3 of the weight, over that traction: 0.156, 0.156, 0.158-0.173
// Track: rolled gravel 0.02 (Carvill, Mechanical Engineer's Data Handbook); slip of a hard surface.
// Sand: 0.1 to 0.2, loose 0.2 to 0.4 (Carvill); the slip is that of the Bn = 7.2 which gives 0.20.
SoilResistance soil_resistance(SoilClass soil) {
  switch (soil) {
    case SoilClass::kTrack:
      return {0.02, 0.16};
    case SoilClass::kFirm:
      break;
    case SoilClass::kTilled:
      return {0.06, 0.16};
    case SoilClass::kSoft:
      return {0.08, 0.17};
    case SoilClass::kSand:
      return {0.20, 0.38};
  }
  return {0.05, 0.16};
}

}  // namespace headland
