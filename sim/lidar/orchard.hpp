// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/base/error.hpp"
#include "core/config/visit.hpp"

namespace headland {

/// What grows and stands along the rows of an orchard or a vineyard. The defaults are a vineyard in
/// leaf on wires. Heights are above the ground.
struct OrchardConfig {
  double trunk_pitch_m = 1.0;
  double trunk_radius_m = 0.03;
  double trunk_height_m = 0.8;
  double post_pitch_m = 5.0;
  double post_radius_m = 0.04;
  double post_height_m = 2.1;
  std::vector<double> wire_heights_m{0.75, 1.1, 1.5, 1.9};
  double wire_radius_m = 0.0015;
  double canopy_low_m = 0.7;
  double canopy_high_m = 2.0;
  double canopy_half_width_m = 0.2;
  double leaf_area_density_1pm = 1.0;
  double branch_area_density_1pm = 0.7;
  double crown_ratio = 0.3;
  double missing_ratio = 0.05;
  double pitch_jitter_m = 0.05;
  double lateral_jitter_m = 0.03;
  double curvature_amplitude_m = 0.0;
  double curvature_wavelength_m = 120.0;
  double grass_low_m = 0.05;
  double grass_high_m = 0.15;
  double grass_area_density_1pm = 12.0;

  template <class V>
  void visit(V& v) {
    visit_wood(v);
    visit_canopy(v);
    visit_order(v);
    visit_grass(v);
  }
  std::optional<Error> check() const;

 private:
  template <class V>
  void visit_wood(V& v) {
    v("trunk_pitch_m", trunk_pitch_m, config::Range{0.2, 50.0}, "From plant to plant [m]");
    v("trunk_radius_m", trunk_radius_m, config::Range{0.0, 1.0}, "Of a trunk [m]; 0: none");
    v("trunk_height_m", trunk_height_m, config::Range{0.0, 6.0}, "Of a trunk, to its crown [m]");
    v("post_pitch_m", post_pitch_m, config::Range{0.5, 100.0}, "From post to post [m]");
    v("post_radius_m", post_radius_m, config::Range{0.0, 0.5}, "Of a post [m]; 0: none");
    v("post_height_m", post_height_m, config::Range{0.0, 6.0}, "Of a post [m]");
    v("wire_heights_m", wire_heights_m, config::Range{0.0, 6.0}, "Wires along the row [m]");
    v("wire_radius_m", wire_radius_m, config::Range{0.0, 0.05}, "Of a wire [m]; 0: none");
  }
  template <class V>
  void visit_canopy(V& v) {
    v("canopy_low_m", canopy_low_m, config::Range{0.0, 6.0}, "Lowest leaves and branches [m]");
    v("canopy_high_m", canopy_high_m, config::Range{0.0, 6.0}, "Highest leaves and branches [m]");
    v("canopy_half_width_m", canopy_half_width_m, config::Range{0.0, 5.0},
      "From the row's line to its outermost leaves [m]");
    v("leaf_area_density_1pm", leaf_area_density_1pm, config::Range{0.0, 10.0},
      "One-sided leaf area per volume of the canopy [m2/m3]; bare: 0, in leaf: 1 to 3");
    v("branch_area_density_1pm", branch_area_density_1pm, config::Range{0.0, 10.0},
      "Area of canes and branches per volume, in the inner half of the canopy [m2/m3]");
    v("crown_ratio", crown_ratio, config::kFraction,
      "By this share the canopy is thinner half way between two plants");
  }
  template <class V>
  void visit_order(V& v) {
    v("missing_ratio", missing_ratio, config::kFraction, "Share of the plants that are missing");
    v("pitch_jitter_m", pitch_jitter_m, config::Range{0.0, 5.0},
      "Standard deviation of a plant's place along its row [m]");
    v("lateral_jitter_m", lateral_jitter_m, config::Range{0.0, 1.0},
      "Standard deviation of a plant's place across its row [m]");
    v("curvature_amplitude_m", curvature_amplitude_m, config::Range{0.0, 10.0},
      "Rows swing to either side of their straight line by this [m], all alike");
    v("curvature_wavelength_m", curvature_wavelength_m, config::Range{5.0, 10000.0},
      "Length of such a swing [m]");
  }
  template <class V>
  void visit_grass(V& v) {
    v("grass_low_m", grass_low_m, config::Range{0.0, 0.2}, "Height of the lowest grass [m]");
    v("grass_high_m", grass_high_m, config::Range{0.0, 0.2}, "Height of the highest grass [m]");
    v("grass_area_density_1pm", grass_area_density_1pm, config::Range{0.0, 100.0},
      "Area of blades per volume of the grass [m2/m3]; 0: bare soil");
  }
};

/// A vineyard: the defaults, or the same without leaves.
OrchardConfig vineyard(bool in_leaf);
/// An orchard of apple trees on wires (seed 000: rows 3.8 m apart), in leaf or bare.
OrchardConfig fruit_orchard(bool in_leaf);

/// Straight rows of plants along the map's x axis, from x = 0, on level or evenly sloping ground.
/// They lie evenly about y = 0: with an even number of rows, y = 0 is the middle of an alley.
struct RowLayout {
  int rows_count = 8;
  double spacing_m = 2.5;
  double length_m = 65.0;
  double next_block_m = 0.0;
  double next_block_length_m = 30.0;
  double slope_along_deg = 0.0;
  double slope_across_deg = 0.0;

  template <class V>
  void visit(V& v) {
    v("rows_count", rows_count, config::Range{0.0, 2000.0}, "Rows of plants");
    v("spacing_m", spacing_m, config::Range{0.5, 50.0}, "From row to row [m]");
    v("length_m", length_m, config::Range{0.0, 2000.0}, "Of a row [m]");
    v("next_block_m", next_block_m, config::Range{0.0, 100.0},
      "Headland between the rows' ends and an aligned next block [m]; 0: no such block");
    v("next_block_length_m", next_block_length_m, config::Range{0.0, 2000.0},
      "Of the next block's rows [m]");
    v("slope_along_deg", slope_along_deg, config::Range{-30.0, 30.0},
      "Ground rises along the rows [deg]");
    v("slope_across_deg", slope_across_deg, config::Range{-30.0, 30.0},
      "Ground rises to the left of the rows [deg]");
  }
};

}  // namespace headland
