// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "perception/ground/internal/grid_opening.hpp"

namespace headland::perception::internal {

struct GroundSearchConfig {
  double cell = 0.5;            ///< [m]
  double widest_object = 12.0;  ///< [m]
  double slope = 0.3;           ///< of the ground at large, rise per metre
  double least_rise = 0.2;      ///< [m], of objects
};

/// Which cells of a scan show ground.
///
/// Seeds are what no opening of growing width takes away by more than a slope allows (progressive
/// morphology: Zhang et al. 2003, Pingel et al. 2013). The surface through the seeds is then
/// continued over all other cells, by means over growing blocks, and those whose lowest point lies
/// near it are ground too: edges of terraces and hilltops that the openings cut off. (Growth from
/// cell to cell up to a slope limit was tried: it climbs roofs and hedges, and one wrong seed then
/// takes a whole roof.)
class GroundSearch {
 public:
  explicit GroundSearch(const GroundSearchConfig& config) : config_(config) {}

  /// `least[cell]` becomes what points must not lie below: `pit` [m] under the fourth lowest cell
  /// within 10 to 20 m, as errors come alone and ground does not. O(cells).
  void find_pits(const HeightField& lowest, double pit, std::vector<float>& least);

  /// `ground[cell]` becomes 1 where the lowest point is ground. O(cells log width).
  void find(const HeightField& lowest, std::vector<std::uint8_t>& ground);

 private:
  static constexpr int kRanks = 4;

  void find_seeds(const HeightField& lowest, std::vector<std::uint8_t>& ground);
  void continue_surface(const HeightField& lowest, const std::vector<std::uint8_t>& ground);
  void accept(const HeightField& lowest, std::vector<std::uint8_t>& ground) const;

  GroundSearchConfig config_;
  GridOpening opening_;
  std::vector<std::array<float, kRanks>> ranks_;  // of blocks: their lowest cells, in order
  HeightField surface_;
  HeightField opened_;
  std::vector<HeightField> levels_;          // of the surface: each of half the cells a side
  std::vector<std::vector<float>> weights_;  // how many heights are in each cell's mean
};

}  // namespace headland::perception::internal
