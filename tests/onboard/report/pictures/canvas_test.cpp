// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/pictures/canvas.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace cairn::report {
namespace {

constexpr Rgba kWhite{255, 255, 255, 255}, kBlack{0, 0, 0, 255};

int ink(const Raster& image) {
  int pixels = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) pixels += image.at(x, y) == kWhite ? 0 : 1;
  return pixels;
}

TEST(DrawLine, CoversItsWidthAndNothingElse) {
  Raster image(20, 9, kWhite);
  draw_line(image, std::array{Pixel{2.5, 4.5}, Pixel{17.5, 4.5}}, {kBlack, 1, 0});
  for (int x = 2; x <= 17; ++x) EXPECT_EQ(image.at(x, 4), kBlack) << x;
  for (int x = 2; x <= 17; ++x) EXPECT_EQ(image.at(x, 3), kWhite) << x;
  EXPECT_EQ(image.at(0, 4), kWhite);
  EXPECT_EQ(image.at(19, 4), kWhite);
}

TEST(DrawLine, IsNotDarkerWhereSegmentsMeet) {
  Raster image(20, 9, kWhite);
  draw_line(image, std::array{Pixel{2.5, 4.5}, Pixel{10.5, 4.5}, Pixel{17.5, 4.5}}, {{0, 0, 0, 128}, 1, 0});
  EXPECT_EQ(image.at(10, 4), image.at(6, 4));
}

TEST(DrawLine, DashesAreAsLongAsTheGaps) {
  Raster image(100, 3, kWhite);
  draw_line(image, std::array{Pixel{0, 1.5}, Pixel{30, 1.5}, Pixel{100, 1.5}}, {kBlack, 1, 10});
  for (int x = 0; x < 100; ++x) {
    const int phase = x % 20;
    if (phase > 1 && phase < 8) {
      EXPECT_EQ(image.at(x, 1), kBlack) << x;
    } else if (phase > 11 && phase < 18) {
      EXPECT_EQ(image.at(x, 1), kWhite) << x;
    }
  }
}

TEST(DrawLine, SurvivesPointsFarOutsideAndNotNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  Raster image(10, 10, kWhite);
  draw_line(image, std::array{Pixel{nan, 1}, Pixel{3, inf}, Pixel{-inf, 4}}, {kBlack, 1, 3});
  EXPECT_EQ(ink(image), 0);
  draw_line(image, std::array{Pixel{-1e12, 5.5}, Pixel{1e12, 5.5}}, {kBlack, 1, 3});
  draw_line(image, std::array{Pixel{-50, -50}, Pixel{-20, -90}}, {kBlack, 1, 0});
  EXPECT_EQ(ink(image), 10);
  draw_line(image, {}, {kBlack, 1, 0});
}

TEST(DrawDisc, HasItsArea) {
  Raster image(60, 60, kWhite);
  draw_disc(image, {30, 30}, 20, kBlack);
  double area = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) area += (255 - image.at(x, y).r) / 255.0;
  EXPECT_NEAR(area, M_PI * 400, 8);
}

TEST(FillRectangle, IsCutAtTheEdges) {
  Raster image(4, 4, kWhite);
  fill_rectangle(image, -2, 2, 4, 10, kBlack);
  EXPECT_EQ(ink(image), 4);
  EXPECT_EQ(image.at(1, 3), kBlack);
  fill_rectangle(image, 10, 10, 5, 5, kBlack);
  EXPECT_EQ(ink(image), 4);
}

TEST(DrawText, EveryGlyphIsDifferentAndInsideItsBox) {
  const std::string_view known = "0123456789.-+:=/()abcdefghijklmnopqrstuvwxyz";
  std::vector<std::vector<bool>> shapes;
  for (const char c : known) {
    Raster image(kGlyphWidth, kGlyphHeight, kWhite);
    draw_text(image, 0, 0, std::string_view(&c, 1), 1, kBlack);
    std::vector<bool> shape;
    for (int y = 0; y < kGlyphHeight; ++y)
      for (int x = 0; x < kGlyphWidth; ++x) shape.push_back(image.at(x, y) == kBlack);
    EXPECT_GT(ink(image), 2) << c;
    for (const auto& other : shapes) EXPECT_NE(shape, other) << c;
    shapes.push_back(shape);
  }
}

TEST(DrawText, WhatItDoesNotKnowIsBlankAndCapitalsAreSmall) {
  Raster blank(40, 10, kWhite), large(40, 10, kWhite), small(40, 10, kWhite);
  draw_text(blank, 0, 0, "\x01\xff ~", 1, kBlack);
  EXPECT_EQ(ink(blank), 0);
  draw_text(large, 0, 0, "XYZ", 1, kBlack);
  draw_text(small, 0, 0, "xyz", 1, kBlack);
  EXPECT_EQ(ink(large), ink(small));
  EXPECT_EQ(text_width("xyz", 2), 34);
  EXPECT_EQ(text_width("", 2), 0);
}

}  // namespace
}  // namespace cairn::report
