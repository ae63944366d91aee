// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/point_labeller.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cairn::labelling {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

/// What lies flat goes on behind itself.
bool stands(std::uint8_t class_id) {
  static const std::uint8_t road = *find_class("road"), sidewalk = *find_class("sidewalk"),
                            terrain = *find_class("terrain");
  return class_id != road && class_id != sidewalk && class_id != terrain;
}

/// The label image's column (or row) of a place in the picture, which has `pixels` of them where the image has
/// `labels`.
int scaled(double place, int pixels, int labels) {
  return std::clamp(static_cast<int>(std::floor((place + 0.5) * labels / pixels)), 0, labels - 1);
}

/// At most an eighth of the picture's height: nearest_ has to have bounds.
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
      nearest_(
          static_cast<std::size_t>(camera.width() + 2 * rim_) * static_cast<std::size_t>(camera.height() + 2 * rim_),
          Nearest{kNothing, kNoClass}) {}

std::size_t PointLabeller::pixel_of(const Projected& p) const {
  const auto& camera = projection_.camera();
  const int u = std::clamp(static_cast<int>(std::lround(p.u)), 0, camera.width() - 1);
  const int v = std::clamp(static_cast<int>(std::lround(p.v)), 0, camera.height() - 1);
  return static_cast<std::size_t>(v + rim_) * static_cast<std::size_t>(camera.width() + 2 * rim_) +
         static_cast<std::size_t>(u + rim_);
}

std::size_t PointLabeller::label_of(const LabelImage& labels, const Projected& p) const {
  const auto& camera = projection_.camera();
  return labels.index(scaled(p.u, camera.width(), labels.width), scaled(p.v, camera.height(), labels.height));
}

void PointLabeller::fill_nearest(const LabelImage& labels, std::span<const Projected> seen) {
  for (const Projected& p : seen) {
    const Nearest own{p.depth, labels.classes[label_of(labels, p)]};
    Nearest* pixel = nearest_.data() + pixel_of(p);
    for (int x = -window_; x <= window_; ++x) {
      Nearest& there = pixel[x];
      const bool tied = own.depth == there.depth && own.class_id < there.class_id;  // whichever comes first
      if (own.depth < there.depth || tied) there = own;
    }
  }
}

void PointLabeller::clear_nearest(std::span<const Projected> seen) {
  for (const Projected& p : seen) {
    Nearest* pixel = nearest_.data() + pixel_of(p);
    std::fill(pixel - window_, pixel + window_ + 1, Nearest{kNothing, kNoClass});
  }
}

/// Whether something far nearer lies in the window, both above and below, or has the same label above or below. The
/// label is then the nearer thing's: its edge is up to the angle between two lasers beyond its last point.
bool PointLabeller::hidden(const Projected& p, std::uint8_t class_id) const {
  const auto far_nearer = static_cast<float>((p.depth - config_.occlusion_m) / (1 + config_.occlusion_share));
  const auto stride = static_cast<std::ptrdiff_t>(projection_.camera().width() + 2 * rim_);
  const Nearest* pixel = nearest_.data() + pixel_of(p) - rim_ * stride;
  unsigned in_window = 0, above = 0, below = 0, of_class = 0;  // a minimum would wait for each pixel before the next
  for (int y = -rim_; y <= rim_; ++y, pixel += stride) {
    const auto nearer = static_cast<unsigned>(pixel->depth < far_nearer);
    const auto between = nearer & static_cast<unsigned>(std::abs(y) <= between_);
    in_window |= nearer & static_cast<unsigned>(std::abs(y) <= window_);
    above |= between & static_cast<unsigned>(y < 0);
    below |= between & static_cast<unsigned>(y > 0);
    of_class |= between & static_cast<unsigned>(pixel->class_id == class_id);
  }
  return (in_window | (above & below) | (of_class & static_cast<unsigned>(stands(class_id)))) != 0;
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
  fill_nearest(labels, seen);
  for (const Projected& p : seen) {
    if (!(p.range <= config_.farthest_m)) continue;
    ++figures.seen;
    const std::size_t at = label_of(labels, p);
    const std::uint8_t class_id = labels.classes[at], probability = labels.probabilities[at];
    const bool has_class = class_id < kSemanticClasses.size() && class_id != kSkyClass;
    const std::uint8_t weight = has_class ? label_weight(config_, p.range, class_id, probability) : std::uint8_t{0};
    if (weight == 0) {
      ++figures.unlabelled;
    } else if (hidden(p, class_id)) {
      ++figures.hidden;
    } else if (at_border(labels, p)) {
      ++figures.at_border;
    } else {
      ++figures.labelled;
      out.push_back({T_odom_scan * scan.points_base[p.index], class_id, probability, weight});
    }
  }
  clear_nearest(seen);
  return figures;
}

}  // namespace cairn::labelling
