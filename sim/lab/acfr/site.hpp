// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "core/geometry/path.hpp"
#include "core/geometry/region.hpp"
#include "core/model/vehicle.hpp"
#include "core/world/ground.hpp"

namespace headland {

/// The pasture of seed 003 and the tours over it. The paper gives waypoints' number and spacing;
/// terrain stands for its site near Bringelly.
struct AcfrSiteConfig {
  double side_m = 170.0;
  double relief_m = 6.0;
  double wavelength_m = 120.0;
  double cell_m = 2.0;
  int samples_count = 1500;
  int waypoints_min_count = 5;
  int waypoints_max_count = 12;
  double spacing_m = 25.0;

  std::optional<Error> check() const;

  template <class V>
  void visit(V& v) {
    v("side_m", side_m, config::Range{60.0, 2000.0}, "Of the square pasture [m]");
    v("relief_m", relief_m, config::Range{0.0, 200.0}, "Highest less lowest point [m]");
    v("wavelength_m", wavelength_m, config::Range{10.0, 5000.0}, "Of the largest hills [m]");
    v("cell_m", cell_m, config::Range{0.5, 50.0}, "Of the terrain [m]");
    v("samples_count", samples_count, config::Range{100, 100000}, "Poses of the roadmap");
    v("waypoints_min_count", waypoints_min_count, config::Range{2, 14},
      "Waypoints of an iteration, at least ...");
    v("waypoints_max_count", waypoints_max_count, config::Range{2, 14}, "... and at most");
    v("spacing_m", spacing_m, config::Range{5.0, 100.0},
      "Mean straight distance along the tour [m]");
  }
};

/// One iteration's plan: from the recharging station through all waypoints and back, with the least
/// energy (003 III-A).
struct AcfrTour {
  Path path;
  std::vector<Point2> places;   ///< waypoints in the order of visits, and the station again
  std::vector<double> place_s;  ///< where along the path they lie [m]
  double energy_j = 0.0;
  Point2 low{0.0, 0.0};  ///< corners of the rectangle around all places
  Point2 high{0.0, 0.0};
};

/// A pasture with its roadmap. Immutable; may be shared among threads.
class AcfrSite {
 public:
  /// Errors as Roadmap::build.
  static Result<AcfrSite> build(const AcfrSiteConfig& config, const Vehicle& vehicle,
                                std::uint64_t seed);
  ~AcfrSite();
  AcfrSite(AcfrSite&&) noexcept;
  AcfrSite& operator=(AcfrSite&&) noexcept;

  const Ground& ground() const;
  /// The tour of an iteration, seeded. Error kNoPath where a waypoint cannot be joined to the
  /// others, kEnergyInfeasible if the tour takes more than the battery holds above its reserve.
  Result<AcfrTour> tour(std::uint64_t seed) const;

 private:
  struct Impl;
  explicit AcfrSite(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace headland
