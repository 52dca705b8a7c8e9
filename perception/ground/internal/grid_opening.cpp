// SPDX-License-Identifier: Apache-2.0
#include "perception/ground/internal/grid_opening.hpp"

#include <algorithm>
#include <limits>

namespace headland::perception::internal {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();

// values[i] becomes the least of `length` values from i on, each `stride` apart, by doubling: the
// least of 2n values is that of two times n. What runs beyond the end counts as none.
void least_ahead(std::vector<float>& values, std::vector<float>& scratch, std::ptrdiff_t stride,
                 std::ptrdiff_t length) {
  const std::ptrdiff_t size = std::ssize(values);
  for (std::ptrdiff_t have = 1; have < length;) {
    const std::ptrdiff_t step = std::min(have, length - have);
    const std::ptrdiff_t end = size - step * stride;
    const float* here = values.data();
    const float* ahead = here + step * stride;
    float* out = scratch.data();
    for (std::ptrdiff_t i = 0; i < end; ++i) out[i] = ahead[i] < here[i] ? ahead[i] : here[i];
    std::copy(values.begin() + end, values.end(), scratch.begin() + end);
    values.swap(scratch);
    have += step;
  }
}

}  // namespace

void GridOpening::spread(HeightField& field, int radius, float sign) {
  const std::ptrdiff_t columns = field.columns;
  const std::ptrdiff_t rows = field.rows;
  const std::ptrdiff_t wide = columns + 2 * radius;
  const std::ptrdiff_t high = rows + 2 * radius;
  padded_.assign(static_cast<std::size_t>(wide * high), kNone);
  for (std::ptrdiff_t row = 0; row < rows; ++row) {
    const float* from = field.heights.data() + row * columns;
    float* to = padded_.data() + (row + radius) * wide + radius;
    for (std::ptrdiff_t i = 0; i < columns; ++i) to[i] = from[i] == kNone ? kNone : sign * from[i];
  }
  // Along a row the neighbour is one value ahead; what runs over into the next row falls on the
  // padding, which is not read.
  scratch_.resize(padded_.size());
  least_ahead(padded_, scratch_, 1, 2 * radius + 1);
  least_ahead(padded_, scratch_, wide, 2 * radius + 1);
  for (std::ptrdiff_t row = 0; row < rows; ++row) {
    const float* from = padded_.data() + row * wide;
    float* to = field.heights.data() + row * columns;
    for (std::ptrdiff_t i = 0; i < columns; ++i) to[i] = from[i] == kNone ? kNone : sign * from[i];
  }
}

void GridOpening::open(HeightField& field, int radius) {
  spread(field, radius, 1.0f);
  spread(field, radius, -1.0f);
}

}  // namespace headland::perception::internal
