// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/run/perception_config.hpp"

namespace headland {

OrchardConfig plants_of(Crop crop) {
  const bool in_leaf = crop == Crop::kOrchardLeaf || crop == Crop::kVineyardLeaf;
  const bool vines = crop == Crop::kVineyardBare || crop == Crop::kVineyardLeaf;
  return vines ? vineyard(in_leaf) : fruit_orchard(in_leaf);
}

}  // namespace headland
