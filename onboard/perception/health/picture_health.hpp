// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "hal/image.hpp"

namespace cairn::health {

/// What brightness says of a picture, over every fourth pixel of every fourth row. Of colour the green value counts,
/// which is most of the brightness.
struct PictureFigures {
  double mean = 0, deviation = 0;  ///< of 0…255
  double dark = 0, bright = 0;     ///< shares of the pixels below kDarkBelow and above kBrightAbove
};
inline constexpr int kDarkBelow = 11, kBrightAbove = 249;

/// kBgr8 or kMono8, not empty.
[[nodiscard]] PictureFigures figures_of(const ImageView& picture);

/// Whether something can be seen on a picture.
enum class PictureState : std::uint8_t {
  kGood,
  kDark,         ///< night, or the lens is covered
  kOverexposed,  ///< the exposure is wrong, or the sun shines into the lens
  kFlat,         ///< no contrast: fog, dirt, or a wall at the lens
};

/// Dark: more than 90 % of the pixels are. By night the simulator's visible camera has 99 %, by day 0 %; KITTI's has
/// 3 %. Overexposed: more than 60 % are bright; KITTI's has 15 %. Flat: the deviation is below 4 steps; noise alone has
/// 2 to 3.5.
[[nodiscard]] PictureState judge(const PictureFigures& figures);

/// As an event has it: "the picture is too dark".
[[nodiscard]] std::string_view to_string(PictureState state);

}  // namespace cairn::health
