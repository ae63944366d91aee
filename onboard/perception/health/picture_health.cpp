// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/health/picture_health.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cairn::health {
namespace {

constexpr int kStep = 4;
constexpr double kMostDark = 0.9, kMostBright = 0.6, kLeastDeviation = 4;

}  // namespace

PictureFigures figures_of(const ImageView& picture) {
  const std::size_t pixel = bytes_per_pixel(picture.format), channel = pixel == 3 ? 1 : 0;
  std::int64_t count = 0, sum = 0, squares = 0, dark = 0, bright = 0;
  for (int y = 0; y < picture.height; y += kStep) {
    const auto row = picture.row(y);
    for (std::size_t at = channel; at < row.size(); at += kStep * pixel) {
      const auto value = std::to_integer<int>(row[at]);
      ++count;
      sum += value;
      squares += value * value;
      dark += value < kDarkBelow ? 1 : 0;
      bright += value > kBrightAbove ? 1 : 0;
    }
  }
  const auto n = static_cast<double>(count);
  const double mean = static_cast<double>(sum) / n;
  return {.mean = mean,
          .deviation = std::sqrt(std::max(0.0, static_cast<double>(squares) / n - mean * mean)),
          .dark = static_cast<double>(dark) / n,
          .bright = static_cast<double>(bright) / n};
}

PictureState judge(const PictureFigures& figures) {
  if (figures.dark > kMostDark) return PictureState::kDark;
  if (figures.bright > kMostBright) return PictureState::kOverexposed;
  return figures.deviation < kLeastDeviation ? PictureState::kFlat : PictureState::kGood;
}

std::string_view to_string(PictureState state) {
  switch (state) {
    case PictureState::kGood:
      return "the picture is good";
    case PictureState::kDark:
      return "the picture is too dark";
    case PictureState::kOverexposed:
      return "the picture is overexposed";
    case PictureState::kFlat:
      break;
  }
  return "the picture has no contrast";
}

}  // namespace cairn::health
