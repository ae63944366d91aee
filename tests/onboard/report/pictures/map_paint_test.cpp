// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/pictures/map_paint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/onboard/report/png_decode.hpp"

namespace cairn::report {
namespace {

/// Two by two cells of 1 m: occupied and high at the lower left, free at the lower right, nothing above.
MapPicture tiny() {
  MapPicture p;
  p.width = p.height = 2;
  p.cell_m = p.voxel_m = 1;
  p.free = {0, 1, 0, 0};
  p.filled = {5, 0, 0, 0};
  p.nearest_m = {2.5F, -1e9F, -1e9F, -1e9F};
  p.low_m = 0.5, p.high_m = 2.5;
  return p;
}

TEST(PaintOccupied, IsTheColourOfTheHeightAtTheLowerLeft) {
  const Raster image = paint_occupied(tiny());
  EXPECT_EQ(image.at(0, 1), height_colour(1));
  EXPECT_EQ(image.at(1, 1).a, 0);
  EXPECT_EQ(image.at(0, 0).a, 0);
}

TEST(PaintOccupied, ShowsFloorsThinnerThanWalls) {
  MapPicture p = tiny();
  p.filled[0] = 1;
  EXPECT_LT(paint_occupied(p).at(0, 1).a, 255);
  EXPECT_EQ(paint_occupied(tiny()).at(0, 1).a, 255);
}

TEST(PaintClasses, HasTheClassesColours) {
  MapPicture p = tiny();
  p.classes = {13, kNoClass, kNoClass, kNoClass};
  EXPECT_EQ(paint_classes(p).at(0, 1), (Rgba{0, 0, 142, 255}));
  EXPECT_EQ(paint_classes(p).at(1, 1).a, 0);
  EXPECT_EQ(classes_in(p), std::vector<std::uint8_t>{13});
  p.classes[0] = kNoClass;
  EXPECT_EQ(paint_classes(p).at(0, 1), class_colour(kNoClass));
}

std::size_t pixels_of(const Raster& image, Rgba colour) {
  return static_cast<std::size_t>(std::count(image.data(), image.data() + image.width() * image.height(), colour));
}

TEST(DrawMap, TheLegendNamesTheClasses) {
  MapPicture p = tiny();
  p.classes = {13, kNoClass, kNoClass, kNoClass};
  const Raster image = draw_map(p, {40, {}, true}).value();
  const std::size_t cell = 40 * 40, swatch = 9 * 8;
  EXPECT_GT(pixels_of(image, {0, 0, 142, 255}), swatch + cell / 2);
  EXPECT_EQ(pixels_of(image, class_colour(kNoClass)), swatch);
}

TEST(PaintFree, MarksFreeCellsOnly) {
  const Raster image = paint_free(tiny());
  EXPECT_EQ(image.at(1, 1), (Rgba{255, 255, 255, 255}));
  EXPECT_EQ(image.at(0, 1).a, 0);
  EXPECT_EQ(image.at(1, 0).a, 0);
}

/// The map's pixels begin where the first pixel is not the white of the margin.
Pixel corner_of(const Raster& image, Rgba unknown) {
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      if (image.at(x, y) == unknown) return {x, y};
  return {-1, -1};
}

TEST(DrawMap, HasTheRightPixelsAfterDecoding) {
  const Rgba unknown{0xd5, 0xda, 0xe1, 255}, free{0xfb, 0xfc, 0xfd, 255};
  const auto png = encode_png(draw_map(tiny(), {40, {}}).value());
  const auto image = decode_png(*png);
  ASSERT_TRUE(image.has_value());
  // Grid lines lie on the cells' edges; middles show the cells themselves.
  const Pixel corner = corner_of(*image, unknown);
  ASSERT_GE(corner.x(), 0);
  const int left = static_cast<int>(corner.x()) / 4 * 4, top = static_cast<int>(corner.y()) / 4 * 4;
  EXPECT_EQ(image->at(left + 20, top + 20), unknown);
  EXPECT_EQ(image->at(left + 60, top + 20), unknown);
  EXPECT_EQ(image->at(left + 20, top + 60), height_colour(1));
  EXPECT_EQ(image->at(left + 60, top + 60), free);
}

TEST(DrawMap, DrawsPathsAtTheirPlace) {
  const MapPicture p = tiny();
  const Raster without = draw_map(p, {40, {}}).value();
  const Raster with = draw_map(p, {40, {{{{0.5, 1.5}, {1.5, 1.5}}, false}}}).value();
  int changed = 0, lowest = 0, highest = with.height();
  for (int y = 0; y < with.height(); ++y)
    for (int x = 0; x < with.width(); ++x)
      if (with.at(x, y) != without.at(x, y)) {
        ++changed;
        lowest = std::max(lowest, y);
        highest = std::min(highest, y);
      }
  EXPECT_GT(changed, 40);
  EXPECT_LT(lowest - highest, 12);
}

TEST(DrawMap, GivesEachPathItsColourAndName) {
  const Rgba blue{0, 0x72, 0xb2, 255};
  const auto draw = [](Rgba colour, const std::string& name) {
    return draw_map(tiny(), {40, {{{{0.5, 1.5}, {1.5, 1.5}}, false, colour, name}}}).value();
  };
  EXPECT_EQ(pixels_of(draw(MapPath{}.colour, ""), blue), 0U);
  const std::size_t unnamed = pixels_of(draw(blue, ""), blue);
  EXPECT_GT(unnamed, 5U);  // the edges are smooth
  EXPECT_GT(pixels_of(draw(blue, "robot_1"), blue), unnamed + 50);
}

TEST(DrawMap, ANameStaysInsideThePicture) {
  const std::string longer(200, 'x');
  const auto image = draw_map(tiny(), {40, {{{{0.5, 1.5}, {1.5, 1.5}}, false, MapPath{}.colour, longer}}});
  EXPECT_TRUE(image.has_value());
}

TEST(DrawMap, RefusesAPictureThatIsTooLarge) {
  const auto image = draw_map(tiny(), {1e6, {}});
  ASSERT_FALSE(image.has_value());
  EXPECT_THAT(to_string(image.error()), testing::HasSubstr("too large"));
}

TEST(DrawMap, ChoosesAScaleThatFits) {
  EXPECT_NEAR(pixels_per_metre(tiny(), {}), 700, 1e-9);
  EXPECT_EQ(pixels_per_metre(tiny(), {12, {}}), 12);
}

TEST(HeightColour, HoldsAtBothEnds) {
  EXPECT_EQ(height_colour(-5), height_colour(0));
  EXPECT_EQ(height_colour(7), height_colour(1));
  EXPECT_NE(height_colour(0), height_colour(1));
}

TEST(RoundBelow, IsOneTwoOrFive) {
  EXPECT_DOUBLE_EQ(round_below(1), 1);
  EXPECT_DOUBLE_EQ(round_below(4.9), 2);
  EXPECT_DOUBLE_EQ(round_below(73), 50);
  EXPECT_DOUBLE_EQ(round_below(0.099), 0.05);
}

}  // namespace
}  // namespace cairn::report
