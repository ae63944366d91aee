// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/alignment/picture_edges.hpp"

#include <gtest/gtest.h>

namespace cairn::alignment {
namespace {

/// Dark left of column 40, bright from there on; dark below row 60.
Image corner(PixelFormat format) {
  Image image;
  image.resize(format, 100, 80);
  const std::size_t bytes = bytes_per_pixel(format);
  for (std::size_t i = 0; i < image.bytes.size(); ++i) {
    const std::size_t x = i / bytes % 100, y = i / bytes / 100;
    image.bytes[i] = std::byte{static_cast<unsigned char>(x >= 40 && y < 60 ? 200 : 30)};
  }
  return image;
}

TEST(PictureEdges, KnowHowFarTheNearestEdgeOfItsKindIs) {
  for (const auto format : {PixelFormat::kMono8, PixelFormat::kBgr8}) {
    PictureEdges edges;
    const Image image = corner(format);
    edges.compute(image.view());
    // The step lies between two pixel centres, at 39.5 and at 59.5.
    for (double u = 25; u < 55; ++u)
      EXPECT_NEAR(edges.distance(EdgeKind::kUpright, {u, 30}), std::abs(u - 39.5), 0.51) << u;
    for (double v = 45; v < 74; ++v)
      EXPECT_NEAR(edges.distance(EdgeKind::kLevel, {70, v}), std::abs(v - 59.5), 0.51) << v;
    EXPECT_EQ(edges.distance(EdgeKind::kLevel, {70, 20}), PictureEdges::kFar);
    EXPECT_EQ(edges.distance(EdgeKind::kUpright, {-1, 30}), PictureEdges::kFar);
    EXPECT_EQ(edges.distance(EdgeKind::kUpright, {100, 30}), PictureEdges::kFar);
  }
}

TEST(PictureEdges, APictureWithoutContrastHasNone) {
  PictureEdges edges;
  Image grey;
  grey.resize(PixelFormat::kMono8, 64, 48);
  std::fill(grey.bytes.begin(), grey.bytes.end(), std::byte{90});
  edges.compute(grey.view());
  EXPECT_EQ(edges.distance(EdgeKind::kUpright, {20, 20}), PictureEdges::kFar);
  for (const auto& [w, h] : {std::pair(0, 0), std::pair(1, 1), std::pair(3, 2)}) {
    grey.resize(PixelFormat::kMono8, w, h);
    edges.compute(grey.view());
    EXPECT_EQ(edges.distance(EdgeKind::kLevel, {0, 0}), PictureEdges::kFar);
  }
}

}  // namespace
}  // namespace cairn::alignment
