// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/labelling_config.hpp"

#include <algorithm>
#include <cmath>

#include "hal/semantic_class.hpp"

namespace cairn::labelling {

void declare(config::Section& s, LabellingConfig& c) {
  s.number("occlusion_m", c.occlusion_m, {0.01, 100}, "m",
           "a point this far behind the nearest point around its pixel is hidden and gets no label");
  s.number("occlusion_share", c.occlusion_share, {0, 1}, "", "plus this share of the nearest point's depth");
  s.integer("occlusion_window_px", c.occlusion_window_px, {1, 31}, "px",
            "edge of the square around the pixel; an even number counts as the next odd one");
  s.number(
      "occlusion_between_deg", c.occlusion_between_deg, {0, 10}, "deg",
      "a point is hidden if nearer ones are above and below it within this angle, or if one of them has its label; "
      "best the angle between two lasers of the LiDAR; 0: not looked for");
  s.integer("border_px", c.border_px, {0, 20}, "px", "pixels this near to another class give no label");
  s.number("line_time_us", c.line_time_us, {0, 1000}, "µs",
           "rolling shutter: from the exposure of one row to that of the next; 0: all rows at once");
  s.number("full_weight_m", c.full_weight_m, {0.1, 1000}, "m",
           "labels of farther points count less, by the inverse of the distance");
  s.number("farthest_m", c.farthest_m, {1, 1000}, "m", "points beyond get no label");
  s.number("movable_weight", c.movable_weight, {0, 1}, "", "factor for labels of people and vehicles");
  s.number("doubtful", c.doubtful, {0.01, 1}, "", "labels below this probability count less, in proportion");
}

std::uint8_t label_weight(const LabellingConfig& c, double range_m, std::uint8_t class_id, std::uint8_t probability) {
  double weight = std::min(1.0, c.full_weight_m / std::max(range_m, 1e-3));
  if (class_id < kSemanticClasses.size() && kSemanticClasses[class_id].movable) weight *= c.movable_weight;
  weight *= std::min(1.0, probability / (255 * c.doubtful));
  return static_cast<std::uint8_t>(std::lround(255 * weight));
}

}  // namespace cairn::labelling
