// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cairn::vm {

enum class PixelFormat : std::uint8_t { kY16, kZ16, kYuyv, kMjpeg };

/// What the emulated camera offers, in the order of its descriptors.
struct Mode {
  PixelFormat format;
  std::uint16_t width;
  std::uint16_t height;
  std::uint32_t max_bytes;  ///< of one frame
  std::uint32_t interval;   ///< of two frames, in 100 ns
};
inline constexpr std::array<Mode, 4> kModes{{
    {PixelFormat::kY16, 160, 120, 160 * 120 * 2, 1'111'111},
    {PixelFormat::kZ16, 320, 240, 320 * 240 * 2, 333'333},
    {PixelFormat::kYuyv, 320, 240, 320 * 240 * 2, 333'333},
    {PixelFormat::kMjpeg, 320, 240, 40'000, 333'333},
}};

/// The pixel at column `x` of frame `number`, the same in every row; number is 0 for the first frame of a camera and
/// wraps. Y16: centikelvin, 0 °C at the left of the first frame. Z16: millimetres.
[[nodiscard]] constexpr std::uint16_t y16_pixel(std::uint32_t x, std::uint32_t number) {
  return static_cast<std::uint16_t>(27315 + number + 3 * x);
}
[[nodiscard]] constexpr std::uint16_t z16_pixel(std::uint32_t x, std::uint32_t number) {
  return static_cast<std::uint16_t>(500 + number + 3 * x);
}
/// YUYV: its luma; both chroma are 128, so the picture is grey.
[[nodiscard]] constexpr std::uint8_t yuyv_luma(std::uint32_t x, std::uint32_t number) {
  return static_cast<std::uint8_t>(x + number);
}
/// MJPEG: the luma of the 8×8 block in column `bx` and row `by`. It decodes to exactly this, for a block has no other
/// frequency and its step of quantisation is one grey level; chroma is 128.
[[nodiscard]] constexpr std::uint8_t mjpeg_luma(std::uint32_t bx, std::uint32_t by, std::uint32_t number) {
  return static_cast<std::uint8_t>(5 * bx + 2 * by + number);
}

/// Frame `number` in the mode's native bytes.
[[nodiscard]] std::vector<std::uint8_t> make_frame(const Mode& mode, std::uint32_t number);

}  // namespace cairn::vm
