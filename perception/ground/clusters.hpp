// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/config/visit.hpp"
#include "core/world/lidar.hpp"
#include "perception/ground/height_grid.hpp"

namespace headland {

struct ClusterConfig {
  double tolerance_m = 0.5;
  int least_points_count = 5;
  int most_points_count = 1'000'000;

  template <class V>
  void visit(V& v) {
    v("tolerance_m", tolerance_m, config::Range{0.01, 100.0},
      "Points nearer to each other than this belong together [m]");
    v("least_points_count", least_points_count, config::Range{1, 1e9}, "Smaller ones are left out");
    v("most_points_count", most_points_count, config::Range{1, 1e9}, "Larger ones are left out");
  }
};

/// Points of which each is near to another.
struct Cluster {
  std::span<const int> indices{};              ///< of its points, ascending; until the next find()
  Eigen::Vector3f centroid{0.0f, 0.0f, 0.0f};  ///< [m]
  Eigen::Vector3f low{0.0f, 0.0f, 0.0f};       ///< least coordinates [m]
  Eigen::Vector3f high{0.0f, 0.0f, 0.0f};      ///< greatest coordinates [m]
  std::ptrdiff_t count() const { return std::ssize(indices); }
};

/// Euclidean clusters (single linkage), exactly: two points at most the tolerance apart share one.
///
/// Cells of tolerance / sqrt(3) hold only points of one cluster; neighbouring cells are joined
/// (union-find) once two of their points are near, for which boxes about the points mostly suffice.
/// Against a search around each point the cost hardly depends on how many points a cell holds.
class ClusterFinder {
 public:
  explicit ClusterFinder(const ClusterConfig& config = {}) : config_(config) {}

  /// The clusters of all points, or of those labelled kObject where labels are given (one a point).
  /// Largest first, then by their first point. Points that are not finite, or beyond 2^19 cells,
  /// belong to none. About 0.1 us a point; does not allocate once it has held as many points.
  std::span<const Cluster> find(std::span<const LidarPoint> points,
                                std::span<const GroundLabel> labels = {});

 private:
  struct Entry {
    std::uint64_t key;  // of the cell: x, y, z, 21 bits each
    int point;
  };
  struct Cell {
    std::uint64_t key;
    int first;  // of its entries
    int count;
    Eigen::Vector3f low;
    Eigen::Vector3f high;
  };
  struct Column {
    std::uint64_t key;  // x and y
    int first;          // of its cells
    int count;
  };

  void sort_into_cells(std::span<const LidarPoint> points, std::span<const GroundLabel> labels);
  void sort_entries();
  void find_columns();
  void join_neighbours(std::span<const LidarPoint> points, int reach);
  void join(std::span<const LidarPoint> points, const Column& a, const Column& b, int reach);
  bool near(std::span<const LidarPoint> points, const Cell& a, const Cell& b) const;
  int root(int cell);
  void collect(std::span<const LidarPoint> points);

  ClusterConfig config_;
  std::vector<Entry> entries_;
  std::vector<Entry> sorted_;
  std::vector<Cell> cells_;
  std::vector<Column> columns_;
  std::vector<int> parents_;  // of cells
  std::vector<int> counts_;   // of points, by root
  std::vector<int> places_;   // of the next index, by root
  std::vector<int> indices_;
  std::vector<Cluster> clusters_;
};

}  // namespace headland
