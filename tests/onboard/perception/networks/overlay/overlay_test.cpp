// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/overlay/overlay.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace cairn::networks {
namespace {

Image grey_picture(int width, int height, unsigned char value) {
  Image picture;
  picture.resize(PixelFormat::kMono8, width, height);
  std::fill(picture.bytes.begin(), picture.bytes.end(), std::byte{value});
  return picture;
}

TEST(Overlay, EachLabelPaintsItsRectangleOfThePicture) {
  LabelImage labels;
  labels.resize(2, 1);
  labels.classes = {kPersonClass, kNoClass};
  Image colour;
  ASSERT_TRUE(to_colour(grey_picture(5, 4, 100), 0, colour));
  paint_labels(labels, 0.5, colour);
  const ImageView view = colour.view();
  const SemanticClass& person = kSemanticClasses[kPersonClass];
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 3; ++x) EXPECT_EQ(view.at<std::uint8_t>(x, y, 2), (100 + person.r) / 2) << x;
    for (int x = 3; x < 5; ++x) EXPECT_EQ(view.at<std::uint8_t>(x, y, 2), 100) << x;
  }
}

TEST(Overlay, BoxesMayTouchAndLeaveThePicture) {
  Image colour;
  ASSERT_TRUE(to_colour(grey_picture(40, 30, 0), 0, colour));
  const Image before = colour;
  Detections found;
  found.found = {{0, 0, 40, 30, kPersonClass, 1}, {35, 25, 100, 100, 13, 0.5F}, {-20, -20, 30, 30, 0, 0.25F}};
  paint_boxes(found, colour);
  EXPECT_NE(colour.bytes, before.bytes);
  EXPECT_EQ(colour.bytes.size(), before.bytes.size());
}

TEST(Overlay, TheLegendIsBelowThePicture) {
  LabelImage labels;
  labels.resize(10, 10);
  std::fill(labels.classes.begin(), labels.classes.end(), std::uint8_t{0});
  labels.classes[0] = kPersonClass;
  Image colour;
  ASSERT_TRUE(to_colour(grey_picture(140, 30, 7), 0, colour));
  const Image before = colour;
  add_legend(labels, colour);
  EXPECT_EQ(colour.height, 70) << "a line for each of two classes";
  EXPECT_TRUE(std::equal(before.bytes.begin(), before.bytes.end(), colour.bytes.begin()));
  Image small;
  ASSERT_TRUE(to_colour(grey_picture(3, 3, 7), 0, small));
  add_legend(labels, small);
  EXPECT_EQ(small.width, 3);
}

TEST(Overlay, APictureOfAnotherFormatIsRefused) {
  Image deep, colour;
  deep.resize(PixelFormat::kMono16, 2, 2);
  EXPECT_FALSE(to_colour(deep, 0, colour));
  EXPECT_FALSE(to_colour(Image(), 0, colour));
}

TEST(Overlay, ASmallPictureIsEnlargedAndItsBoxesWithIt) {
  Image colour;
  ASSERT_TRUE(to_colour(grey_picture(160, 120, 7), 640, colour));
  EXPECT_EQ(colour.width, 640);
  EXPECT_EQ(colour.height, 480);
  Detections found;
  found.width = 160;
  found.height = 120;
  found.found = {{100, 100, 20, 10, kPersonClass, 1}};
  paint_boxes(found, colour);
  EXPECT_NE(colour.view().at<std::uint8_t>(400, 420, 0), 7) << "the left edge";
  EXPECT_EQ(colour.view().at<std::uint8_t>(110, 105, 0), 7);
  ASSERT_TRUE(to_colour(grey_picture(641, 10, 7), 640, colour));
  EXPECT_EQ(colour.width, 641);
}

TEST(Overlay, IsAPng) {
  Image colour;
  ASSERT_TRUE(to_colour(grey_picture(3, 2, 7), 0, colour));
  const auto png = encode_png(colour);
  ASSERT_TRUE(png);
  EXPECT_EQ((*png)[1], std::byte{'P'});
}

}  // namespace
}  // namespace cairn::networks
