// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/costmap_lines.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "hal/bytes.hpp"
#include "onboard/client/view/distance_field.hpp"
#include "onboard/report/page/html_text.hpp"

namespace cairn::cli {
namespace {

using client::Costmap;

std::string distances_of(const Costmap& map) {
  constexpr double kNone = 65535, kCmPerM = 100;
  std::vector<std::uint8_t> lethal(map.cost.size());
  std::ranges::transform(map.cost, lethal.begin(), [](std::uint8_t c) { return c == Costmap::kLethal ? 1 : 0; });
  std::vector<std::byte> bytes;
  for (const float metres : client::distances_2d(lethal, map.cells, map.cells, map.resolution_m))
    append_le(bytes, static_cast<std::uint16_t>(std::min(kNone, std::round(kCmPerM * static_cast<double>(metres)))));
  return report::html::base64(bytes);
}

}  // namespace

nlohmann::ordered_json costmap_line(const client::PlannerView& view, const client::PoseMessage& pose,
                                    const client::CostmapConfig& robot) {
  const SE3& T = pose.T_odom_base.mean;
  const Costmap map = client::make_costmap(view, T, robot);
  const float nearest = client::make_distance_field(view, T).at(T.translation());
  nlohmann::ordered_json line{{"stamp_ns", pose.stamp.time_since_epoch().count()},
                              {"epoch", pose.epoch},
                              {"x_m", map.x_m},
                              {"y_m", map.y_m},
                              {"resolution_m", map.resolution_m},
                              {"cells", map.cells},
                              {"cost", report::html::base64(std::as_bytes(std::span(map.cost)))},
                              {"distance_cm", distances_of(map)}};
  line["nearest_m"] = std::isfinite(nearest) ? nlohmann::ordered_json(nearest) : nullptr;
  return line;
}

}  // namespace cairn::cli
