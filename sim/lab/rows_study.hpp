// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "sim/lab/rows/row_drive.hpp"
#include "sim/lab/study_result.hpp"

namespace headland {

/// A scan of real plants, cut into strips along their rows that are tiled along the scene's.
struct ScannedPlants {
  std::string file;
  double heading_deg = 0.0;
  std::vector<double> offsets_m;
  double half_width_m = 0.6;

  template <class V>
  void visit(V& v) {
    v.required("file", file,
               "PCD or PLY, relative to the study's; $HEADLAND_DATA: the folder of data");
    v("heading_deg", heading_deg, config::Range{-360.0, 360.0},
      "Of the scanned rows, in the scan's frame [deg]");
    v("offsets_m", offsets_m, "Of the scanned rows across that heading, to the left [m]");
    v("half_width_m", half_width_m, config::kPositive, "Of a strip [m]");
  }
};

/// One of seed 000's scenes, or real plants.
struct RowScenario {
  std::string name;
  RowLayout layout;
  OrchardConfig plants;
  std::optional<ScannedPlants> scan;

  template <class V>
  void visit(V& v) {
    v.required("name", name, "Such as orchard_leaf: a cell's name");
    v("layout", layout, "Rows");
    v("plants", plants, "What grows along them; of scanned ones, grass and curvature");
    v("scan", scan, "Real plants in their place");
  }
};

/// Seed 000, V (Tables I and II): how well the lane between rows is seen, as published and ours.
struct RowsStudyConfig {
  std::string study = "rows";
  int seed = 1;
  int runs_count = 5;  ///< of a scene, with other plants each
  std::vector<RowScenario> scenes;
  LidarConfig lidar;
  SensorMount mount;
  RowDriveConfig drive;
  RowDetectorConfig detector;  ///< width and sensor's place are the scene's

  std::optional<Error> check() const;

  template <class V>
  void visit(V& v) {
    v("study", study, "Which study this file is for");
    v("seed", seed, config::Range{0, 1000000000}, "Of plants, noise and wander");
    v("runs_count", runs_count, config::Range{1, 10000}, "Drives a scene");
    v("scenes", scenes, "Where");
    v("lidar", lidar, "The sensor");
    v("mount", mount, "Where it sits");
    v("drive", drive, "How the robot goes");
    v("detector", detector, "Settings of both detectors");
  }
};

/// Cells `<scene>` (ours) and `<scene>/published`: mae_m, max_m, std_m of the centre line while the
/// robot wanders, heading_rms_deg, coverage_ratio (valid within the rows), false_ratio (valid in
/// the headland), row_end_error_m (mean over the last 8 m), row_end_max_m, row_end_first_m (ours);
/// lateral_mae_m and lateral_std_m of the difference of the distances to both sides in the closed
/// loop, driven_ratio; scan_ms (processor time of an update, with p99). All else is deterministic,
/// whatever `jobs` is. Scans' files are relative to `folder`. Errors: of those files; kOutOfRange
/// where a strip of one holds no plant.
Result<StudyResult> run_rows_study(const RowsStudyConfig& config,
                                   const std::filesystem::path& folder, int jobs = 1);

}  // namespace headland
