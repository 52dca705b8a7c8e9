// SPDX-License-Identifier: Apache-2.0
#include "perception/ground/clusters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace headland {
namespace {

constexpr int kBits = 21;
constexpr int kHalf = 1 << (kBits - 1);
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
constexpr int kReach = 2;  // cells: points two apart may be near, three apart may not

std::uint64_t packed(const Eigen::Array3i& cell) {
  return (static_cast<std::uint64_t>(cell.x()) << (2 * kBits)) |
         (static_cast<std::uint64_t>(cell.y()) << kBits) | static_cast<std::uint64_t>(cell.z());
}

int z_of(std::uint64_t key) { return static_cast<int>(key & kMask); }
int y_of(std::uint64_t column) { return static_cast<int>(column & kMask); }
int x_of(std::uint64_t column) { return static_cast<int>(column >> kBits); }

std::uint64_t column_key(int x, int y) {
  return (static_cast<std::uint64_t>(x) << kBits) | static_cast<std::uint64_t>(y);
}

// Squared distance of a point to a box; 0 inside.
float distance2(const Eigen::Vector3f& p, const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  return (low - p).cwiseMax(p - high).cwiseMax(0.0f).squaredNorm();
}

}  // namespace

std::span<const Cluster> ClusterFinder::find(std::span<const LidarPoint> points,
                                             std::span<const GroundLabel> labels) {
  sort_into_cells(points, labels);
  find_columns();
  parents_.resize(cells_.size());
  for (int i = 0; i < std::ssize(cells_); ++i) parents_[static_cast<std::size_t>(i)] = i;
  // The nearest first: most pairs farther apart then belong together already.
  for (int reach = 1; reach <= kReach; ++reach) join_neighbours(points, reach);
  collect(points);
  return clusters_;
}

void ClusterFinder::sort_into_cells(std::span<const LidarPoint> points,
                                    std::span<const GroundLabel> labels) {
  const auto per_metre = static_cast<float>(std::sqrt(3.0) / config_.tolerance_m);
  entries_.clear();
  entries_.reserve(points.size());
  Eigen::Array3i least = Eigen::Array3i::Constant(kHalf);
  for (int i = 0; i < std::ssize(points); ++i) {
    const auto index = static_cast<std::size_t>(i);
    if (!labels.empty() && labels[index] != GroundLabel::kObject) continue;
    const Eigen::Array3f scaled = points[index].position.array() * per_metre;
    if (!(scaled.abs().maxCoeff<Eigen::PropagateNaN>() < static_cast<float>(kHalf / 2 - kReach))) {
      continue;
    }
    const Eigen::Array3i cell = scaled.floor().cast<int>();
    least = least.min(cell);
    entries_.push_back({packed(cell + kHalf / 2), i});
  }
  // Counted from the lowest occupied cells, most numbers are short, and quick to sort by.
  const std::uint64_t corner = packed(least + kHalf / 2 - kReach);
  for (Entry& entry : entries_) entry.key -= corner;
  sort_entries();
  cells_.clear();
  for (int i = 0; i < std::ssize(entries_); ++i) {
    const Entry& entry = entries_[static_cast<std::size_t>(i)];
    const Eigen::Vector3f& p = points[static_cast<std::size_t>(entry.point)].position;
    if (cells_.empty() || cells_.back().key != entry.key) cells_.push_back({entry.key, i, 0, p, p});
    Cell& cell = cells_.back();
    ++cell.count;
    cell.low = cell.low.cwiseMin(p);
    cell.high = cell.high.cwiseMax(p);
  }
}

// By key, then point: by counting digits from the lowest up, leaving out those that are all zero.
void ClusterFinder::sort_entries() {
  constexpr int kDigit = 11;
  std::uint64_t used = 0;
  for (const Entry& entry : entries_) used |= entry.key;
  sorted_.resize(entries_.size());
  for (const int axis : {0, kBits, 2 * kBits}) {
    for (int shift = axis; shift < axis + kBits; shift += kDigit) {
      const int bits = std::min(kDigit, axis + kBits - shift);
      const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
      if ((used >> shift & mask) == 0) continue;
      std::array<int, (1 << kDigit) + 1> starts{};
      for (const Entry& entry : entries_) ++starts[(entry.key >> shift & mask) + 1];
      for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
      for (const Entry& entry : entries_) {
        sorted_[static_cast<std::size_t>(starts[entry.key >> shift & mask]++)] = entry;
      }
      entries_.swap(sorted_);
    }
  }
}

void ClusterFinder::find_columns() {
  columns_.clear();
  for (int i = 0; i < std::ssize(cells_); ++i) {
    const std::uint64_t key = cells_[static_cast<std::size_t>(i)].key >> kBits;
    if (columns_.empty() || columns_.back().key != key) columns_.push_back({key, i, 0});
    ++columns_.back().count;
  }
}

// All pairs of cells at most `reach` apart in each direction, each once.
void ClusterFinder::join_neighbours(std::span<const LidarPoint> points, int reach) {
  // Columns are in order of x, then y; so are those sought for each dx from column to column.
  std::size_t next[kReach + 1] = {};
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Column& column = columns_[i];
    join(points, column, column, reach);
    const int x = x_of(column.key);
    const int y = y_of(column.key);
    for (int dx = 0; dx <= reach; ++dx) {
      const std::uint64_t from = dx == 0 ? column.key + 1 : column_key(x + dx, y - reach);
      const std::uint64_t to = column_key(x + dx, y + reach);
      std::size_t& at = next[dx];
      while (at < columns_.size() && columns_[at].key < from) ++at;
      for (std::size_t j = at; j < columns_.size() && columns_[j].key <= to; ++j) {
        join(points, column, columns_[j], reach);
      }
    }
  }
}

void ClusterFinder::join(std::span<const LidarPoint> points, const Column& a, const Column& b,
                         int reach) {
  int first = b.first;
  for (int i = a.first; i < a.first + a.count; ++i) {
    const Cell& cell = cells_[static_cast<std::size_t>(i)];
    const int z = z_of(cell.key);
    while (first < b.first + b.count &&
           z_of(cells_[static_cast<std::size_t>(first)].key) < z - reach) {
      ++first;
    }
    for (int j = first; j < b.first + b.count; ++j) {
      const Cell& other = cells_[static_cast<std::size_t>(j)];
      if (z_of(other.key) > z + reach) break;
      const int mine = root(i);
      const int others = root(j);
      if (mine == others || !near(points, cell, other)) continue;
      parents_[static_cast<std::size_t>(std::max(mine, others))] = std::min(mine, others);
    }
  }
}

// Whether any point of one cell is within the tolerance of any of the other.
bool ClusterFinder::near(std::span<const LidarPoint> points, const Cell& a, const Cell& b) const {
  const auto most2 = static_cast<float>(config_.tolerance_m * config_.tolerance_m);
  const Eigen::Vector3f gap = (b.low - a.high).cwiseMax(a.low - b.high).cwiseMax(0.0f);
  if (gap.squaredNorm() > most2) return false;
  const Eigen::Vector3f span = (b.high - a.low).cwiseMax(a.high - b.low);
  if (span.squaredNorm() <= most2) return true;
  const auto point = [&](const Cell& cell, int i) -> const Eigen::Vector3f& {
    const Entry& entry = entries_[static_cast<std::size_t>(cell.first + i)];
    return points[static_cast<std::size_t>(entry.point)].position;
  };
  for (int i = 0; i < a.count; ++i) {
    const Eigen::Vector3f& p = point(a, i);
    if (distance2(p, b.low, b.high) > most2) continue;
    for (int j = 0; j < b.count; ++j) {
      if ((p - point(b, j)).squaredNorm() <= most2) return true;
    }
  }
  return false;
}

int ClusterFinder::root(int cell) {
  int at = cell;
  while (parents_[static_cast<std::size_t>(at)] != at) {
    int& parent = parents_[static_cast<std::size_t>(at)];
    parent = parents_[static_cast<std::size_t>(parent)];  // halves the way for the next search
    at = parent;
  }
  return at;
}

void ClusterFinder::collect(std::span<const LidarPoint> points) {
  counts_.assign(cells_.size(), 0);
  for (int i = 0; i < std::ssize(cells_); ++i) {
    counts_[static_cast<std::size_t>(root(i))] += cells_[static_cast<std::size_t>(i)].count;
  }
  places_.assign(cells_.size(), -1);
  clusters_.clear();
  indices_.resize(entries_.size());
  int place = 0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const int count = counts_[i];
    if (count < std::max(config_.least_points_count, 1) || count > config_.most_points_count) {
      continue;
    }
    places_[i] = place;
    const auto first = static_cast<std::size_t>(place);
    clusters_.push_back(
        {.indices = std::span(indices_).subspan(first, static_cast<std::size_t>(count))});
    place += count;
  }
  for (int i = 0; i < std::ssize(cells_); ++i) {
    int& at = places_[static_cast<std::size_t>(root(i))];
    const Cell& cell = cells_[static_cast<std::size_t>(i)];
    for (int j = cell.first; at >= 0 && j < cell.first + cell.count; ++j) {
      indices_[static_cast<std::size_t>(at++)] = entries_[static_cast<std::size_t>(j)].point;
    }
  }
  std::size_t first = 0;
  for (Cluster& cluster : clusters_) {
    const auto begin = indices_.begin() + static_cast<std::ptrdiff_t>(first);
    std::sort(begin, begin + cluster.count());
    first += cluster.indices.size();
    const Eigen::Vector3f& start = points[static_cast<std::size_t>(cluster.indices[0])].position;
    cluster.low = cluster.high = start;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();  // from the first point: less is rounded off
    for (const int index : cluster.indices) {
      const Eigen::Vector3f& p = points[static_cast<std::size_t>(index)].position;
      cluster.low = cluster.low.cwiseMin(p);
      cluster.high = cluster.high.cwiseMax(p);
      sum += p - start;
    }
    cluster.centroid = start + sum / static_cast<float>(cluster.count());
  }
  std::sort(clusters_.begin(), clusters_.end(), [](const Cluster& a, const Cluster& b) {
    return a.count() != b.count() ? a.count() > b.count() : a.indices[0] < b.indices[0];
  });
}

}  // namespace headland
