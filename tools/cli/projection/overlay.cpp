// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/projection/overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/camera/picture_file.hpp"

namespace cairn::cli {
namespace {

using Colour = std::array<std::uint8_t, 3>;  // blue, green, red

constexpr double kNearestShown_m = 3, kFarthestShown_m = 50;
constexpr Colour kUprightColour{255, 255, 255}, kLevelColour{0, 255, 255};

/// From red over green to blue, evenly in the logarithm of the depth.
Colour depth_colour(double depth) {
  const double share =
      std::clamp(std::log(depth / kNearestShown_m) / std::log(kFarthestShown_m / kNearestShown_m), 0.0, 1.0);
  const auto ramp = [&](double peak) {
    return static_cast<std::uint8_t>(255 * std::clamp(1.5 - std::abs(4 * share - peak), 0.0, 1.0));
  };
  return {ramp(3.5), ramp(2), ramp(0.5)};
}

class Canvas {
 public:
  explicit Canvas(const ImageView& picture) {
    image_.resize(PixelFormat::kBgr8, picture.width, picture.height);
    const std::size_t bytes = bytes_per_pixel(picture.format);
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        const auto row = picture.row(y);
        unsigned sum = 0;
        for (std::size_t c = 0; c < bytes; ++c)
          sum += std::to_integer<unsigned>(row[static_cast<std::size_t>(x) * bytes + c]);
        const auto grey = static_cast<std::uint8_t>(sum / bytes * 3 / 4);
        set(x, y, {grey, grey, grey});
      }
  }
  void dot(const Eigen::Vector2d& pixel, int radius, const Colour& colour) {
    const auto u = static_cast<int>(std::lround(pixel.x())), v = static_cast<int>(std::lround(pixel.y()));
    for (int y = v - radius; y <= v + radius; ++y)
      for (int x = u - radius; x <= u + radius; ++x) set(x, y, colour);
  }
  [[nodiscard]] const Image& image() const { return image_; }

 private:
  void set(int x, int y, const Colour& colour) {
    if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
    const std::size_t at = static_cast<std::size_t>(y) * image_.stride + 3 * static_cast<std::size_t>(x);
    for (std::size_t c = 0; c < 3; ++c) image_.bytes[at + c] = std::byte{colour[c]};
  }
  Image image_;
};

}  // namespace

Result<std::vector<std::byte>> draw_overlay(const ImageView& picture, std::span<const labelling::Projected> points,
                                            std::span<const Eigen::Vector2d> upright,
                                            std::span<const Eigen::Vector2d> level) {
  Canvas canvas(picture);
  for (const labelling::Projected& p : points) canvas.dot({p.u, p.v}, 0, depth_colour(p.depth));
  for (const auto& pixel : upright) canvas.dot(pixel, 1, kUprightColour);
  for (const auto& pixel : level) canvas.dot(pixel, 1, kLevelColour);
  const Image& image = canvas.image();
  const camera::FrameHeader header{static_cast<std::uint32_t>(camera::FrameFormat::kBgr),
                                   static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height),
                                   static_cast<std::uint32_t>(image.stride), false};
  const auto frame = camera::check_frame(header, image.bytes);
  if (!frame) return frame.error();
  std::vector<std::byte> png;
  if (const auto made = camera::frame_to_picture(*frame, png); !made) return made.error();
  return png;
}

}  // namespace cairn::cli
