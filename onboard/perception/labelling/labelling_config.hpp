// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/config/config.hpp"

namespace cairn::labelling {

/// How points get their labels from a picture. Pixels are those of the camera's picture, also where the label image is
/// smaller.
struct LabellingConfig {
  double occlusion_m = 0.5;       ///< a point so far behind the nearest point around its pixel is hidden …
  double occlusion_share = 0.05;  ///< … plus this share of the nearest point's depth
  int occlusion_window_px = 5;    ///< edge of the square around the pixel; odd
  /// A point is hidden, too, if there are such nearer points above it and below it within this angle: the lasers of
  /// many LiDARs are so far apart that a thing before it has gaps in the picture. The ground, which is nearer below
  /// alone, hides nothing. One such point is enough if it has the same label and stands upright: the label is then its
  /// own, since a thing's edge is beyond the last laser that meets it. 0: not looked for.
  double occlusion_between_deg = 2.2;
  int border_px = 2;        ///< pixels next to another class that give no label: borders are where networks err
  double line_time_us = 0;  ///< rolling shutter: from the exposure of a row to the next one's; 0: all rows at once
  /// Up to here a label counts fully, beyond it by the inverse of the distance: a pixel covers more and more of the
  /// world, and errors of the mount move labels farther.
  double full_weight_m = 15;
  double farthest_m = 80;       ///< points beyond get no label
  double movable_weight = 0.5;  ///< factor for people and vehicles, which may leave while their voxel stays
  double doubtful = 0.5;        ///< below this probability a label counts by its share of it
};

/// Keys, units and bounds.
void declare(config::Section& section, LabellingConfig& config);

/// How much a label counts, in 255ths: min(1, full_weight_m / range) · (movable_weight, if the class is movable) ·
/// min(1, probability / doubtful). Range in metres from the camera, probability in 255ths.
[[nodiscard]] std::uint8_t label_weight(const LabellingConfig& config, double range_m, std::uint8_t class_id,
                                        std::uint8_t probability);

}  // namespace cairn::labelling
