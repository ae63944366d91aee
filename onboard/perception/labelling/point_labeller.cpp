// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/point_labeller.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::labelling {
namespace {

/// The label image's column (or row) of a place in the picture, which has `pixels` of them where the image has
/// `labels`.
int scaled(double place, int pixels, int labels) {
  return std::clamp(static_cast<int>(std::floor((place + 0.5) * labels / pixels)), 0, labels - 1);
}

Error wrong_size(const LabelImage& labels) {
  return {Errc::kMalformed,
          "the label image does not have its size",
          {},
          {},
          std::to_string(labels.width) + "x" + std::to_string(labels.height) + " pixels, " +
              std::to_string(labels.classes.size()) + " classes, " + std::to_string(labels.probabilities.size()) +
              " probabilities"};
}

bool complete(const LabelImage& labels) {
  if (labels.width < 1 || labels.height < 1) return false;
  const std::size_t pixels = static_cast<std::size_t>(labels.width) * static_cast<std::size_t>(labels.height);
  return labels.classes.size() == pixels && labels.probabilities.size() == pixels;
}

}  // namespace

PointLabeller::PointLabeller(const cameras::CameraModel& camera, const SE3& T_base_camera,
                             const LabellingConfig& config)
    : config_(config), projection_(camera, T_base_camera, config.line_time_us), occlusion_(camera, config) {}

std::size_t PointLabeller::label_of(const LabelImage& labels, const Projected& p) const {
  const auto& camera = projection_.camera();
  return labels.index(scaled(p.u, camera.width(), labels.width), scaled(p.v, camera.height(), labels.height));
}

bool PointLabeller::at_border(const LabelImage& labels, const Projected& p) const {
  const int width = projection_.camera().width(), height = projection_.camera().height();
  const int left = scaled(double{p.u} - config_.border_px, width, labels.width);
  const int right = scaled(double{p.u} + config_.border_px, width, labels.width);
  const int top = scaled(double{p.v} - config_.border_px, height, labels.height);
  const int bottom = scaled(double{p.v} + config_.border_px, height, labels.height);
  const std::uint8_t own = labels.classes[labels.index(left, top)];
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x)
      if (labels.classes[labels.index(x, y)] != own) return true;
  return false;
}

Result<LabellingFigures> PointLabeller::label(const LabelImage& labels, const PlacedScan& scan,
                                              const Exposure& exposure, std::vector<LabelledPoint>& out) {
  out.clear();
  if (!complete(labels)) return wrong_size(labels);
  const std::span<const Projected> seen = projection_.project(scan.points_base, scan.T_odom_base, exposure);
  const Eigen::Isometry3f T_odom_scan(scan.T_odom_base.matrix().cast<float>());
  LabellingFigures figures;
  for (const Projected& p : seen) occlusion_.add(p, labels.classes[label_of(labels, p)]);
  for (const Projected& p : seen) {
    if (!(p.range <= config_.farthest_m)) continue;
    ++figures.seen;
    const std::size_t at = label_of(labels, p);
    const std::uint8_t class_id = labels.classes[at], probability = labels.probabilities[at];
    const bool has_class = class_id < kSemanticClasses.size() && class_id != kSkyClass;
    const std::uint8_t weight = has_class ? label_weight(config_, p.range, class_id, probability) : std::uint8_t{0};
    if (weight == 0) {
      ++figures.unlabelled;
    } else if (occlusion_.hidden(p, class_id)) {
      ++figures.hidden;
    } else if (at_border(labels, p)) {
      ++figures.at_border;
    } else {
      ++figures.labelled;
      out.push_back({T_odom_scan * scan.points_base[p.index], class_id, probability, weight});
    }
  }
  occlusion_.clear(seen);
  return figures;
}

}  // namespace cairn::labelling
