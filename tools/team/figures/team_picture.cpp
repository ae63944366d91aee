// SPDX-License-Identifier: Apache-2.0
#include "tools/team/figures/team_picture.hpp"

#include <algorithm>
#include <array>

#include "onboard/report/pictures/map_paint.hpp"
#include "onboard/report/pictures/map_picture.hpp"
#include "tools/team/figures/team_figures.hpp"

namespace cairn::team_run {
namespace {

// Apart from each other also for those who see few colours (Okabe, Ito, "Color universal design", 2008).
constexpr std::array kColours{report::Rgba{0xd5, 0x5e, 0x00, 255}, report::Rgba{0x00, 0x72, 0xb2, 255},
                              report::Rgba{0x00, 0x9e, 0x73, 255}, report::Rgba{0xcc, 0x79, 0xa7, 255},
                              report::Rgba{0xe6, 0x9f, 0x00, 255}, report::Rgba{0x56, 0xb4, 0xe9, 255}};

report::MapPath path_of(const RobotResult& robot, const SE3& T_team_odom, report::Rgba colour) {
  report::MapPath path{{}, false, colour, robot.name};
  for (const auto& pose : robot.trajectory)
    path.points.push_back(report::project(report::MapView::kTop, T_team_odom * pose.pose.translation()));
  return path;
}

}  // namespace

Result<std::vector<std::byte>> draw_team(const std::vector<RobotResult>& robots) {
  const RobotResult& shown = robots.at(in_largest_team(robots));
  const auto picture = report::look_at(*shown.team_map, {});
  if (!picture) return picture.error();
  report::MapDrawing drawing;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const bool member = &robots[i] == &shown || std::ranges::count(shown.merged_with, robots[i].name) > 0;
    if (member) drawing.paths.push_back(path_of(robots[i], robots[i].T_team_odom, kColours[i % kColours.size()]));
  }
  const auto image = report::draw_map(*picture, drawing);
  if (!image) return image.error();
  return report::encode_png(*image);
}

}  // namespace cairn::team_run
