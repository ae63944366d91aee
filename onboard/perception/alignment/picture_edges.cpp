// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/alignment/picture_edges.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cairn::alignment {

void PictureEdges::take_grey(const ImageView& picture) {
  width_ = picture.width;
  height_ = picture.height;
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  for (auto* plane : {&grey_, &scratch_, &upright_, &level_}) plane->assign(pixels, 0);
  const bool colour = picture.format == PixelFormat::kBgr8;
  for (int y = 0; y < height_; ++y) {
    const auto row = picture.row(y);
    for (int x = 0; x < width_; ++x) {
      const auto i = static_cast<std::size_t>(x);
      const auto value = [&](std::size_t byte) { return static_cast<float>(std::to_integer<unsigned>(row[byte])); };
      grey_[at(x, y)] =
          colour ? 0.114F * value(3 * i) + 0.587F * value(3 * i + 1) + 0.299F * value(3 * i + 2) : value(i);
    }
  }
}

/// [1 4 6 4 1] / 16 in both directions: σ is 1 pixel. The rim of two pixels stays as it is.
void PictureEdges::blur() {
  const auto smooth = [](const float* p, std::ptrdiff_t step) {
    return (p[-2 * step] + 4 * p[-step] + 6 * p[0] + 4 * p[step] + p[2 * step]) / 16;
  };
  scratch_ = grey_;
  for (int y = 0; y < height_; ++y)
    for (int x = 2; x + 2 < width_; ++x) scratch_[at(x, y)] = smooth(&grey_[at(x, y)], 1);
  for (int y = 2; y + 2 < height_; ++y)
    for (int x = 0; x < width_; ++x) grey_[at(x, y)] = smooth(&scratch_[at(x, y)], width_);
}

/// Pixels whose gradient is the largest of its row (or column) around, by the direction that it has.
void PictureEdges::find_edges() {
  const auto gradient = [&](int x, int y, int dx, int dy) {
    return grey_[at(x + dx, y + dy)] - grey_[at(x - dx, y - dy)];
  };
  constexpr int kRim = 4;
  for (int y = kRim; y + kRim < height_; ++y)
    for (int x = kRim; x + kRim < width_; ++x) {
      const float across = std::abs(gradient(x, y, 1, 0)), along = std::abs(gradient(x, y, 0, 1));
      if (across > along && across >= std::abs(gradient(x - 1, y, 1, 0)) && across > std::abs(gradient(x + 1, y, 1, 0)))
        upright_[at(x, y)] = across;
      if (along > across && along >= std::abs(gradient(x, y - 1, 0, 1)) && along > std::abs(gradient(x, y + 1, 0, 1)))
        level_[at(x, y)] = along;
    }
}

/// Leaves the strongest kShare of the pixels.
void PictureEdges::keep_strongest(std::vector<float>& strength) const {
  std::vector<float> sorted = strength;
  const auto kept = static_cast<std::size_t>(kShare * static_cast<double>(sorted.size()));
  if (kept >= sorted.size()) return;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(kept), sorted.end(), std::greater<>());
  const float least = std::max(sorted[kept], 1.0F);
  for (float& s : strength)
    if (s < least) s = 0;
}

/// Strengths become distances: two passes over the neighbours (Borgefors, 1986), at most 8 % too far.
void PictureEdges::spread(std::vector<float>& strength) const {
  for (float& s : strength) s = s > 0 ? 0 : kFar;
  constexpr float kDiagonal = std::numbers::sqrt2_v<float>;
  const auto pass = [&](int x, int y, int dy) {
    float& here = strength[at(x, y)];
    const auto from = [&](int nx, int ny, float step) {
      if (nx >= 0 && ny >= 0 && nx < width_ && ny < height_) here = std::min(here, strength[at(nx, ny)] + step);
    };
    from(x + dy, y, 1);
    for (int dx = -1; dx <= 1; ++dx) from(x + dx, y + dy, dx == 0 ? 1 : kDiagonal);
  };
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) pass(x, y, -1);
  for (int y = height_ - 1; y >= 0; --y)
    for (int x = width_ - 1; x >= 0; --x) pass(x, y, 1);
}

void PictureEdges::compute(const ImageView& picture) {
  take_grey(picture);
  blur();
  find_edges();
  for (auto* plane : {&upright_, &level_}) {
    keep_strongest(*plane);
    spread(*plane);
  }
}

float PictureEdges::distance(EdgeKind kind, const Eigen::Vector2d& pixel) const {
  if (!(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < width_ - 1 && pixel.y() < height_ - 1)) return kFar;
  const auto& plane = kind == EdgeKind::kUpright ? upright_ : level_;
  const auto x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
  const auto right = static_cast<float>(pixel.x() - x), down = static_cast<float>(pixel.y() - y);
  const float above = (1 - right) * plane[at(x, y)] + right * plane[at(x + 1, y)];
  const float below = (1 - right) * plane[at(x, y + 1)] + right * plane[at(x + 1, y + 1)];
  return (1 - down) * above + down * below;
}

}  // namespace cairn::alignment
