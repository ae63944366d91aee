// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/health/picture_health.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace cairn::health {
namespace {

/// `value` of column and row, in all channels.
Image picture(PixelFormat format, const std::function<int(int, int)>& value, int width = 163, int height = 91) {
  Image image;
  image.resize(format, width, height);
  const std::size_t channels = bytes_per_pixel(format);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (std::size_t c = 0; c < channels; ++c)
        image.bytes[static_cast<std::size_t>(y) * image.stride + static_cast<std::size_t>(x) * channels + c] =
            static_cast<std::byte>(std::clamp(value(x, y), 0, 255));
  return image;
}

PictureState state_of(const std::function<int(int, int)>& value) {
  const PictureState grey = judge(figures_of(picture(PixelFormat::kMono8, value).view()));
  EXPECT_EQ(judge(figures_of(picture(PixelFormat::kBgr8, value).view())), grey) << "grey as colour";
  return grey;
}

TEST(PictureHealth, AScaleOfGreysIsGood) {
  const auto ramp = [](int x, int) { return x * 255 / 162; };
  EXPECT_EQ(state_of(ramp), PictureState::kGood);
  const auto figures = figures_of(picture(PixelFormat::kMono8, ramp).view());
  EXPECT_NEAR(figures.mean, 127, 3);
  EXPECT_NEAR(figures.deviation, 255 / std::sqrt(12.0), 4);
  EXPECT_NEAR(figures.dark, 0.045, 0.02);
  EXPECT_NEAR(figures.bright, 0.025, 0.02);
}

TEST(PictureHealth, NightWithTheNoiseOfItsGainIsDark) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(2, 3.5);
  EXPECT_EQ(state_of([&](int, int) { return static_cast<int>(noise(random)); }), PictureState::kDark);
}

TEST(PictureHealth, ASkyThatFillsThePictureIsOverexposed) {
  EXPECT_EQ(state_of([](int x, int y) { return y < 60 ? 255 : x; }), PictureState::kOverexposed);
  EXPECT_EQ(state_of([](int x, int y) { return y < 30 ? 255 : x; }), PictureState::kGood);
}

TEST(PictureHealth, FogIsFlat) {
  EXPECT_EQ(state_of([](int x, int) { return 140 + x % 3; }), PictureState::kFlat);
}

TEST(PictureHealth, APictureOfOnePixelHasFigures) {
  const auto figures = figures_of(picture(
                                      PixelFormat::kBgr8, [](int, int) { return 90; }, 1, 1)
                                      .view());
  EXPECT_EQ(figures.mean, 90);
  EXPECT_EQ(figures.deviation, 0);
}

TEST(PictureHealth, EveryStateHasItsSentence) {
  EXPECT_EQ(to_string(PictureState::kDark), "the picture is too dark");
  EXPECT_EQ(to_string(PictureState::kOverexposed), "the picture is overexposed");
  EXPECT_EQ(to_string(PictureState::kFlat), "the picture has no contrast");
}

}  // namespace
}  // namespace cairn::health
