// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "sim/lab/ebs221/drive.hpp"
#include "sim/lab/study_result.hpp"

namespace headland {

/// Cross-track errors [m] that (002) prints for one of its drives, from its results files.
struct PublishedDrive {
  const char* cell;
  double overall_rms_m;
  double row_rms_m;
  double turn_rms_m;
};
inline constexpr std::array<PublishedDrive, 4> kPublishedDrives = {
    {{"track/seed/D", 0.0794, 0.0826, 0.0726},
     {"track/seed/E", 1.2519, 0.8660, 1.4916},
     {"track/seed/F", 0.0320, 0.0296, 0.0335},
     {"track/seed/fishtail", 0.1943, 0.0818, 0.3178}}};

/// Tour lengths [m] and times [s] that (002) prints.
struct PublishedTour {
  const char* cell;
  double cost_m;
  double planning_s;
};
inline constexpr std::array<PublishedTour, 2> kPublishedTours = {
    {{"tour/seed/60deg", 114.4140, 9.0469}, {"tour/seed/30deg", 297.0661, 8.1875}}};

/// Published and measured figures side by side, from the cells.
void add_drive_table(StudyResult& result);
void add_tour_table(StudyResult& result);

/// Where the drive went beside its path, its error and its steering over the driven distance.
void add_drive_plots(const std::string& cell, const FieldDrive& drive, const Path& path,
                     StudyResult& result);

}  // namespace headland
