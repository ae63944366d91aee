// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/occlusion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cairn::labelling {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

/// What lies flat goes on behind itself; so may what is not known.
bool stands(std::uint8_t class_id) {
  static const std::uint8_t road = *find_class("road"), sidewalk = *find_class("sidewalk"),
                            terrain = *find_class("terrain");
  return class_id != kNoClass && class_id != road && class_id != sidewalk && class_id != terrain;
}

/// At most an eighth of the picture's height: nearest_ has to have bounds.
int pixels_of(double degrees, const cameras::CameraModel& camera) {
  const double pixels = camera.parameters().fy * std::tan(degrees * std::numbers::pi / 180);
  return static_cast<int>(std::min(std::ceil(pixels), camera.height() / 8.0));
}

}  // namespace

Occlusion::Occlusion(const cameras::CameraModel& camera, const LabellingConfig& config)
    : farther_m_(config.occlusion_m),
      farther_share_(config.occlusion_share),
      width_(camera.width()),
      height_(camera.height()),
      window_(config.occlusion_window_px / 2),
      between_(pixels_of(config.occlusion_between_deg, camera)),
      rim_(std::max(window_, between_)),
      nearest_(static_cast<std::size_t>(width_ + 2 * rim_) * static_cast<std::size_t>(height_ + 2 * rim_),
               Nearest{kNothing, kNoClass}) {}

std::size_t Occlusion::pixel_of(const Projected& p) const {
  const int u = std::clamp(static_cast<int>(std::lround(p.u)), 0, width_ - 1);
  const int v = std::clamp(static_cast<int>(std::lround(p.v)), 0, height_ - 1);
  return static_cast<std::size_t>(v + rim_) * static_cast<std::size_t>(width_ + 2 * rim_) +
         static_cast<std::size_t>(u + rim_);
}

void Occlusion::add(const Projected& p, std::uint8_t class_id) {
  Nearest* pixel = nearest_.data() + pixel_of(p);
  for (int x = -window_; x <= window_; ++x) {
    Nearest& there = pixel[x];
    const bool tied = p.depth == there.depth && class_id < there.class_id;  // whichever comes first
    if (p.depth < there.depth || tied) there = {p.depth, class_id};
  }
}

void Occlusion::clear(std::span<const Projected> noted) {
  for (const Projected& p : noted) {
    Nearest* pixel = nearest_.data() + pixel_of(p);
    std::fill(pixel - window_, pixel + window_ + 1, Nearest{kNothing, kNoClass});
  }
}

/// Whether something far nearer lies in the window, both above and below, or has the same label above or below. The
/// label is then the nearer thing's: its edge is up to the angle between two lasers beyond its last point.
bool Occlusion::hidden(const Projected& p, std::uint8_t class_id) const {
  const auto far_nearer = static_cast<float>((p.depth - farther_m_) / (1 + farther_share_));
  const auto stride = static_cast<std::ptrdiff_t>(width_ + 2 * rim_);
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

}  // namespace cairn::labelling
