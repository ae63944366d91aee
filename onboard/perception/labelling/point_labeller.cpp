// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/point_labeller.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cairn::labelling {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

/// The label image's column (or row) of a place in the picture, which has `pixels` of them where the image has
/// `labels`.
int scaled(double place, int pixels, int labels) {
  return std::clamp(static_cast<int>(std::floor((place + 0.5) * labels / pixels)), 0, labels - 1);
}

/// At most an eighth of the picture's height: depths_ has to have bounds.
int pixels_of(double degrees, const cameras::CameraModel& camera) {
  const double pixels = camera.parameters().fy * std::tan(degrees * std::numbers::pi / 180);
  return static_cast<int>(std::min(std::ceil(pixels), camera.height() / 8.0));
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
    : config_(config),
      projection_(camera, T_base_camera, config.line_time_us),
      window_(config.occlusion_window_px / 2),
      between_(pixels_of(config.occlusion_between_deg, camera)),
      rim_(std::max(window_, between_)),
      depths_(
          static_cast<std::size_t>(camera.width() + 2 * rim_) * static_cast<std::size_t>(camera.height() + 2 * rim_),
          kNothing) {}

std::size_t PointLabeller::pixel_of(const Projected& p) const {
  const auto& camera = projection_.camera();
  const int u = std::clamp(static_cast<int>(std::lround(p.u)), 0, camera.width() - 1);
  const int v = std::clamp(static_cast<int>(std::lround(p.v)), 0, camera.height() - 1);
  return static_cast<std::size_t>(v + rim_) * static_cast<std::size_t>(camera.width() + 2 * rim_) +
         static_cast<std::size_t>(u + rim_);
}

void PointLabeller::fill_depths(std::span<const Projected> seen) {
  for (const Projected& p : seen) {
    float* pixel = depths_.data() + pixel_of(p);
    for (int x = -window_; x <= window_; ++x) pixel[x] = std::min(pixel[x], p.depth);
  }
}

void PointLabeller::clear_depths(std::span<const Projected> seen) {
  for (const Projected& p : seen) {
    float* pixel = depths_.data() + pixel_of(p);
    std::fill(pixel - window_, pixel + window_ + 1, kNothing);
  }
}

/// Whether something far nearer lies in the columns of the window, in rows `first` … `last` counted from the point's.
bool PointLabeller::nearer_in_rows(const Projected& p, int first, int last) const {
  const auto far_nearer = static_cast<float>((p.depth - config_.occlusion_m) / (1 + config_.occlusion_share));
  const auto stride = static_cast<std::ptrdiff_t>(projection_.camera().width() + 2 * rim_);
  const float* pixel = depths_.data() + pixel_of(p) + first * stride;
  unsigned found = 0;  // a minimum would wait for each pixel before the next
  for (int y = first; y <= last; ++y, pixel += stride) found |= static_cast<unsigned>(*pixel < far_nearer);
  return found != 0;
}

bool PointLabeller::hidden(const Projected& p) const {
  return nearer_in_rows(p, -window_, window_) || (nearer_in_rows(p, -between_, -1) && nearer_in_rows(p, 1, between_));
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
  const int width = projection_.camera().width(), height = projection_.camera().height();
  LabellingFigures figures;
  fill_depths(seen);
  for (const Projected& p : seen) {
    if (!(p.range <= config_.farthest_m)) continue;
    ++figures.seen;
    const std::size_t at = labels.index(scaled(p.u, width, labels.width), scaled(p.v, height, labels.height));
    const std::uint8_t class_id = labels.classes[at], probability = labels.probabilities[at];
    const bool has_class = class_id < kSemanticClasses.size() && class_id != kSkyClass;
    const std::uint8_t weight = has_class ? label_weight(config_, p.range, class_id, probability) : std::uint8_t{0};
    if (weight == 0) {
      ++figures.unlabelled;
    } else if (hidden(p)) {
      ++figures.hidden;
    } else if (at_border(labels, p)) {
      ++figures.at_border;
    } else {
      ++figures.labelled;
      out.push_back({T_odom_scan * scan.points_base[p.index], class_id, probability, weight});
    }
  }
  clear_depths(seen);
  return figures;
}

}  // namespace cairn::labelling
