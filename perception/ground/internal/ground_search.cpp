// SPDX-License-Identifier: Apache-2.0
#include "perception/ground/internal/ground_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace headland::perception::internal {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();

constexpr double kBlock = 10.0;  // [m]

std::size_t index(const HeightField& field, int row, int column) {
  return static_cast<std::size_t>(row * field.columns + column);
}

// Weighted means of two by two cells.
void coarsen(const HeightField& fine, const std::vector<float>& fine_weights, HeightField& coarse,
             std::vector<float>& coarse_weights) {
  coarse.columns = (fine.columns + 1) / 2;
  coarse.rows = (fine.rows + 1) / 2;
  coarse.heights.assign(static_cast<std::size_t>(coarse.columns * coarse.rows), 0.0f);
  coarse_weights.assign(coarse.heights.size(), 0.0f);
  for (int row = 0; row < fine.rows; ++row) {
    for (int column = 0; column < fine.columns; ++column) {
      const std::size_t from = index(fine, row, column);
      const std::size_t to = index(coarse, row / 2, column / 2);
      coarse.heights[to] += fine_weights[from] * fine.heights[from];
      coarse_weights[to] += fine_weights[from];
    }
  }
  for (std::size_t i = 0; i < coarse.heights.size(); ++i) {
    if (coarse_weights[i] == 0.0f) continue;
    coarse.heights[i] /= coarse_weights[i];
    coarse_weights[i] = std::min(coarse_weights[i], 1.0f);
  }
}

// Cells without a height take it from the coarser cells around them, the nearer the more.
void refine(const HeightField& coarse, const std::vector<float>& coarse_weights, HeightField& fine,
            std::vector<float>& fine_weights) {
  for (int row = 0; row < fine.rows; ++row) {
    for (int column = 0; column < fine.columns; ++column) {
      const std::size_t to = index(fine, row, column);
      if (fine_weights[to] > 0.0f) continue;
      const int y = row / 2;
      const int x = column / 2;
      const int beside_y = std::clamp(y + (row % 2 == 0 ? -1 : 1), 0, coarse.rows - 1);
      const int beside_x = std::clamp(x + (column % 2 == 0 ? -1 : 1), 0, coarse.columns - 1);
      float sum = 0.0f;
      float weight = 0.0f;
      const auto add = [&](int from_y, int from_x, float share) {
        const std::size_t from = index(coarse, from_y, from_x);
        sum += share * coarse_weights[from] * coarse.heights[from];
        weight += share * coarse_weights[from];
      };
      add(y, x, 9.0f);
      add(y, beside_x, 3.0f);
      add(beside_y, x, 3.0f);
      add(beside_y, beside_x, 1.0f);
      if (weight == 0.0f) continue;
      fine.heights[to] = sum / weight;
      fine_weights[to] = 1.0f;
    }
  }
}

}  // namespace

void GroundSearch::find_pits(const HeightField& lowest, double pit, std::vector<float>& least) {
  const int block = std::max(1, static_cast<int>(std::ceil(kBlock / config_.cell)));
  const int blocks_x = (lowest.columns + block - 1) / block;
  const int blocks_y = (lowest.rows + block - 1) / block;
  const auto index = [](int width, int y, int x) {
    return static_cast<std::size_t>(y * width + x);
  };
  const auto insert = [](std::array<float, kRanks>& ranks, float height) {
    for (float& rank : ranks) {
      if (height < rank) std::swap(height, rank);
    }
  };
  std::array<float, kRanks> none;
  none.fill(kNone);
  ranks_.assign(static_cast<std::size_t>(blocks_x * blocks_y), none);
  for (int y = 0; y < lowest.rows; ++y) {
    for (int x = 0; x < lowest.columns; ++x) {
      insert(ranks_[index(blocks_x, y / block, x / block)],
             lowest.heights[index(lowest.columns, y, x)]);
    }
  }
  least.resize(lowest.heights.size());
  for (int by = 0; by < blocks_y; ++by) {
    for (int bx = 0; bx < blocks_x; ++bx) {
      std::array<float, kRanks> around = none;
      for (int y = std::max(0, by - 1); y <= std::min(blocks_y - 1, by + 1); ++y) {
        for (int x = std::max(0, bx - 1); x <= std::min(blocks_x - 1, bx + 1); ++x) {
          for (const float height : ranks_[index(blocks_x, y, x)]) insert(around, height);
        }
      }
      const float bound = around.back() == kNone ? -kNone : around.back() - static_cast<float>(pit);
      for (int y = by * block; y < std::min(lowest.rows, (by + 1) * block); ++y) {
        for (int x = bx * block; x < std::min(lowest.columns, (bx + 1) * block); ++x) {
          least[index(lowest.columns, y, x)] = bound;
        }
      }
    }
  }
}

void GroundSearch::find(const HeightField& lowest, std::vector<std::uint8_t>& ground) {
  find_seeds(lowest, ground);
  continue_surface(lowest, ground);
  accept(lowest, ground);
}

void GroundSearch::find_seeds(const HeightField& lowest, std::vector<std::uint8_t>& ground) {
  const std::size_t cells = lowest.heights.size();
  ground.assign(cells, 0);
  for (std::size_t i = 0; i < cells; ++i) ground[i] = lowest.heights[i] != kNone ? 1 : 0;
  surface_ = lowest;
  const int widest = static_cast<int>(std::ceil(0.5 * config_.widest_object / config_.cell));
  for (int radius = 1; radius <= widest; radius = std::max(radius + 1, radius * 4 / 3)) {
    opened_ = surface_;
    opening_.open(opened_, radius);
    const auto most =
        static_cast<float>(config_.least_rise + config_.slope * config_.cell * radius);
    for (std::size_t i = 0; i < cells; ++i) {
      if (surface_.heights[i] - opened_.heights[i] > most) ground[i] = 0;
    }
    std::swap(surface_, opened_);
  }
}

// Means over blocks of two, four, ... cells a side, and back: what has no height takes that of the
// smallest block around it that has one, blended between blocks.
void GroundSearch::continue_surface(const HeightField& lowest,
                                    const std::vector<std::uint8_t>& ground) {
  int depth = 1;
  while ((1 << depth) < std::max(lowest.columns, lowest.rows)) ++depth;
  levels_.resize(static_cast<std::size_t>(depth) + 1);
  weights_.resize(levels_.size());
  levels_[0] = lowest;
  weights_[0].resize(ground.size());
  for (std::size_t i = 0; i < ground.size(); ++i) {
    weights_[0][i] = ground[i] != 0 ? 1.0f : 0.0f;
    if (ground[i] == 0) levels_[0].heights[i] = 0.0f;
  }
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    coarsen(levels_[level - 1], weights_[level - 1], levels_[level], weights_[level]);
  }
  for (std::size_t level = levels_.size() - 1; level > 0; --level) {
    refine(levels_[level], weights_[level], levels_[level - 1], weights_[level - 1]);
  }
}

void GroundSearch::accept(const HeightField& lowest, std::vector<std::uint8_t>& ground) const {
  const HeightField& surface = levels_[0];
  const auto rise = static_cast<float>(config_.least_rise);
  for (int row = 0; row < lowest.rows; ++row) {
    for (int column = 0; column < lowest.columns; ++column) {
      const std::size_t i = index(lowest, row, column);
      if (ground[i] != 0 || lowest.heights[i] == kNone || weights_[0][i] == 0.0f) continue;
      const auto at = [&](int y, int x) {
        return surface.heights[index(lowest, std::clamp(y, 0, lowest.rows - 1),
                                     std::clamp(x, 0, lowest.columns - 1))];
      };
      const float along = at(row, column + 1) - at(row, column - 1);
      const float across = at(row + 1, column) - at(row - 1, column);
      const float most = rise + 0.5f * std::hypot(along, across);
      if (lowest.heights[i] - surface.heights[i] <= most) ground[i] = 1;
    }
  }
}

}  // namespace headland::perception::internal
