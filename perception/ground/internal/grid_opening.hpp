// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace headland::perception::internal {

/// Heights on a grid, row by row; infinity where there is none.
struct HeightField {
  int columns = 0;
  int rows = 0;
  std::vector<float> heights;
};

/// Morphology by a square of 2 radius + 1 cells. Cells without a height do not count; a cell with
/// no height in reach has none. O(cells log radius); does not allocate once warm.
class GridOpening {
 public:
  /// The lowest within the square, then the highest of these: narrower rises vanish.
  void open(HeightField& field, int radius);

 private:
  // Along rows, then columns: the lowest (sign 1) or highest (sign -1) of 2 radius + 1 cells.
  void spread(HeightField& field, int radius, float sign);

  std::vector<float> padded_;
  std::vector<float> scratch_;
};

}  // namespace headland::perception::internal
