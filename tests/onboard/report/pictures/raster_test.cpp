// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/pictures/raster.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/onboard/report/png_decode.hpp"

namespace cairn::report {
namespace {

Raster noise(int width, int height) {
  Raster image(width, height, {});
  std::mt19937 engine(1);
  const auto byte = [&] { return static_cast<std::uint8_t>(engine() & 255U); };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y) = {byte(), byte(), byte(), byte()};
  return image;
}

TEST(EncodePng, IsReadBackPixelByPixelAndAlwaysTheSame) {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {64, 129}}) {
    const Raster image = noise(width, height);
    const auto bytes = encode_png(image);
    ASSERT_TRUE(bytes.has_value());
    EXPECT_EQ(*bytes, encode_png(image).value());
    const auto back = decode_png(*bytes);
    ASSERT_TRUE(back.has_value());
    ASSERT_EQ(back->width(), width);
    ASSERT_EQ(back->height(), height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) ASSERT_EQ(back->at(x, y), image.at(x, y)) << x << ' ' << y;
  }
}

TEST(EncodePng, OfAnEmptyPictureIsAnErrorNotACrash) { EXPECT_FALSE(encode_png(Raster(0, 0, {})).has_value()); }

TEST(Blend, IsTheUpperColourWhereItIsOpaqueAndTheLowerWhereItIsNot) {
  const Rgba under{10, 20, 30, 255}, over{200, 100, 50, 255};
  EXPECT_EQ(blend(under, over), over);
  EXPECT_EQ(blend(under, over, 0), under);
  EXPECT_EQ(blend(under, {200, 100, 50, 0}), under);
  EXPECT_EQ(blend({0, 0, 0, 0}, {200, 100, 50, 128}), (Rgba{200, 100, 50, 128}));
  EXPECT_EQ(blend({0, 0, 0, 255}, {255, 255, 255, 255}, 0.5), (Rgba{128, 128, 128, 255}));
  EXPECT_EQ(blend({9, 9, 9, 0}, {7, 7, 7, 0}), (Rgba{0, 0, 0, 0}));
}

TEST(Mix, GoesFromOneToTheOther) {
  EXPECT_EQ(mix({0, 100, 0, 255}, {100, 0, 0, 255}, 0), (Rgba{0, 100, 0, 255}));
  EXPECT_EQ(mix({0, 100, 0, 255}, {100, 0, 0, 255}, 0.25), (Rgba{25, 75, 0, 255}));
  EXPECT_EQ(mix({0, 100, 0, 255}, {100, 0, 0, 255}, 1), (Rgba{100, 0, 0, 255}));
}

}  // namespace
}  // namespace cairn::report
