// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "core/world/lidar.hpp"
#include "perception/mapping/masked_disc.hpp"

namespace headland {

/// Defaults: OctoMap's (Hornung et al. 2013).
struct OctreeMapConfig {
  double cell_m = 0.2;
  double range_m = 40.0;
  double hit_ratio = 0.7;
  double miss_ratio = 0.4;
  double least_ratio = 0.1192;
  double most_ratio = 0.971;

  template <class V>
  void visit(V& v) {
    v("cell_m", cell_m, config::Range{0.01, 10.0}, "Side of the smallest cells [m]");
    v("range_m", range_m, config::kPositive,
      "Rays clear no farther, and farther returns mark none [m]");
    v("hit_ratio", hit_ratio, config::Range{0.5, 0.95}, "That a cell with a return is occupied");
    v("miss_ratio", miss_ratio, config::Range{0.05, 0.5}, "That one passed by a ray is");
    v("least_ratio", least_ratio, config::Range{0.01, 0.5}, "No cell is less likely occupied");
    v("most_ratio", most_ratio, config::Range{0.5, 0.99}, "No cell is more likely occupied");
  }
};

/// The map of record: an octree of occupancy over all that has been seen, by OctoMap, in the files
/// that others read. Slow (seconds for a scan at 0.1 m and 40 m): what drives uses RollingGrid.
class OctreeMap {
 public:
  explicit OctreeMap(const OctreeMapConfig& config = {});
  ~OctreeMap();
  OctreeMap(OctreeMap&&) noexcept;
  OctreeMap& operator=(OctreeMap&&) noexcept;

  /// Reads a map by its extension: .bt (free or occupied) or .ot (probabilities).
  /// @return kFileNotFound, kUnsupported (another extension, or another kind of tree), or kSyntax.
  static Result<OctreeMap> read(const std::filesystem::path& file);
  /// Writes .bt or .ot, pruned. @return Nothing, or kUnsupported or kFileNotWritable.
  std::optional<Error> write(const std::filesystem::path& file) const;

  /// Takes in a scan. @param points Returns in `map` [m]; not finite ones are left out, those of
  /// masked discs neither mark nor clear. @param origin The sensor [m, map].
  void insert(std::span<const LidarPoint> points, const Eigen::Vector3d& origin,
              std::span<const MaskedDisc> masked = {});

  /// Whether a cell is more likely occupied than not; none where nothing has been seen.
  std::optional<bool> occupied(const Eigen::Vector3d& place) const;
  /// Probability of being occupied; none where nothing has been seen.
  std::optional<double> probability(const Eigen::Vector3d& place) const;

  double cell() const;             ///< side of the smallest cells [m]
  std::size_t node_count() const;  ///< of the tree

 private:
  struct State;

  std::unique_ptr<State> state_;
};

}  // namespace headland
