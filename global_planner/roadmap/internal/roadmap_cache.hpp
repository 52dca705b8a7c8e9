// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "global_planner/roadmap/internal/prm.hpp"

namespace headland::internal {

/// A file in the cache folder, named by a hash of all that the roadmap depends on but the number of
/// samples: a roadmap of more samples begins with one of fewer.
class RoadmapCache {
 public:
  /// An empty folder: no cache.
  RoadmapCache(const Region& drivable, const Ground& ground, const Vehicle& vehicle,
               const RoadmapOptions& options);

  const std::filesystem::path& file() const { return file_; }
  /// None if there is no file, or if it is cut short, altered or of another version.
  std::optional<RoadGraph> load() const;
  /// Written beside and renamed, so that a reader never sees half of it. A cache that cannot be
  /// written is none.
  void store(const RoadGraph& graph) const;

 private:
  std::uint64_t key_ = 0;
  std::filesystem::path file_;
};

}  // namespace headland::internal
