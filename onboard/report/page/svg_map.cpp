// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/page/svg_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "onboard/report/page/html_text.hpp"
#include "onboard/report/pictures/map_paint.hpp"

namespace cairn::report::html {
namespace {

constexpr double kWidth = 960, kTallest = 1100, kMargin_m = 0.5;

/// Map metres to SVG units: the box around map and paths, at kWidth or less.
struct Frame {
  Eigen::AlignedBox2d box;
  double scale = 1;

  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector2d& p) const {
    return {(p.x() - box.min().x()) * scale, (box.max().y() - p.y()) * scale};
  }
  [[nodiscard]] Eigen::Vector2d size() const { return box.sizes() * scale; }
};

using Path = std::vector<Eigen::Vector2d>;

Path path_of(const std::vector<StampedPose>& poses) {
  Path path;
  for (const StampedPose& p : poses) path.push_back(p.pose.translation().head<2>());
  return path;
}

Frame frame_of(const std::optional<MapPicture>& picture, const Path& trajectory, const Path& truth) {
  Frame frame;
  if (picture) {
    frame.box.extend(picture->corner_m);
    frame.box.extend(
        Eigen::Vector2d(picture->corner_m + picture->cell_m * Eigen::Vector2d(picture->width, picture->height)));
  }
  for (const Path* path : {&trajectory, &truth})
    for (const Eigen::Vector2d& p : *path)
      if (p.allFinite()) frame.box.extend(p);
  if (frame.box.isEmpty()) frame.box.extend(Eigen::Vector2d(0, 0));
  frame.box.min().array() -= kMargin_m;
  frame.box.max().array() += kMargin_m;
  frame.scale = std::min(kWidth / frame.box.sizes().x(), kTallest / frame.box.sizes().y());
  return frame;
}

Result<std::string> layer(const Frame& frame, const MapPicture& picture, const Raster& image, const char* css) {
  const auto png = encode_png(image);
  if (!png) return png.error();
  const double tall = picture.cell_m * picture.height;
  const Eigen::Vector2d upper_left = frame.at(picture.corner_m + Eigen::Vector2d(0, tall));
  return fmt::format(
      "<image class=\"{}\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
      "href=\"data:image/png;base64,{}\"/>\n",
      css, upper_left.x(), upper_left.y(), picture.cell_m * picture.width * frame.scale, tall * frame.scale,
      base64(*png));
}

/// Points are left out where they lie close together; however long the path, a few thousand remain.
std::string polyline(const Frame& frame, const Path& path, const char* css, double points = 4000) {
  constexpr double kNearest = 0.7;
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    if ((path[i] - path[i - 1]).allFinite()) length += (path[i] - path[i - 1]).norm() * frame.scale;
  const double spacing = std::max(kNearest, length / points);
  std::string d;
  Eigen::Vector2d last(-1e9, -1e9);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Eigen::Vector2d p = frame.at(path[i]);
    const bool end = i + 1 == path.size();
    if (!p.allFinite() || (!end && (p - last).norm() < spacing)) continue;
    d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", p.x(), p.y());
    last = p;
  }
  return fmt::format("<path class=\"{}\" d=\"{}\"/>", css, d);
}

std::string disc(const Frame& frame, const Eigen::Vector2d& point, const char* css, const char* title) {
  const Eigen::Vector2d p = frame.at(point);
  return fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"6\"><title>{}</title></circle>", css, p.x(),
                     p.y(), title);
}

std::string scale_bar(const Frame& frame) {
  const double length = round_below(frame.box.sizes().x() / 4), pixels = length * frame.scale,
               y = frame.size().y() - 16;
  return fmt::format(
      "<g class=\"bar\"><path class=\"halo\" d=\"M16 {0:.1f}v8h{1:.1f}v-8\"/><path d=\"M16 {0:.1f}v8h{1:.1f}v-8\"/>"
      "<text x=\"{2:.1f}\" y=\"{3:.1f}\">{4:g} m</text></g>",
      y - 8, pixels, 16 + pixels + 8, y + 4, length);
}

std::string grid(const Frame& frame) {
  const double step = round_below(frame.box.sizes().maxCoeff() / 4);
  std::string d;
  for (double x = std::ceil(frame.box.min().x() / step) * step; x < frame.box.max().x(); x += step)
    d += fmt::format("M{:.1f} 0V{:.1f}", frame.at({x, 0}).x(), frame.size().y());
  for (double y = std::ceil(frame.box.min().y() / step) * step; y < frame.box.max().y(); y += step)
    d += fmt::format("M0 {:.1f}H{:.1f}", frame.at({0, y}).y(), frame.size().x());
  return fmt::format("<path class=\"grid\" d=\"{}\"/>", d);
}

}  // namespace

Result<std::string> svg_map(const RunReport& report) {
  std::vector<StampedPose> means;
  for (const PoseEstimate& p : report.trajectory) means.push_back({p.stamp, p.T_odom_base.mean});
  const Path trajectory = path_of(means);
  const Path truth = path_of(truth_in_estimate_frame(means, report.ground_truth, TrajectoryErrorOptions{}.max_gap));
  const Frame frame = frame_of(report.picture, trajectory, truth);
  std::string s =
      fmt::format("<svg class=\"map\" viewBox=\"0 0 {:.1f} {:.1f}\" role=\"img\" aria-label=\"map from above\">\n",
                  frame.size().x(), frame.size().y());
  if (report.picture) {
    const auto free = layer(frame, *report.picture, paint_free(*report.picture), "free");
    const bool classes = report.picture->labelled();
    const auto occupied = layer(frame, *report.picture,
                                classes ? paint_classes(*report.picture) : paint_occupied(*report.picture), "occupied");
    if (!free) return free.error();
    if (!occupied) return occupied.error();
    s += *free + *occupied;
  }
  s += grid(frame);
  if (report.people)
    for (const Path& path : report.people->paths) s += polyline(frame, path, "person", 200);
  if (!trajectory.empty()) s += polyline(frame, trajectory, "halo") + polyline(frame, trajectory, "trajectory");
  if (!truth.empty()) s += polyline(frame, truth, "truth");
  if (!trajectory.empty())
    s += disc(frame, trajectory.front(), "start", "start") + disc(frame, trajectory.back(), "end", "end");
  return s + scale_bar(frame) + "</svg>\n";
}

}  // namespace cairn::report::html
