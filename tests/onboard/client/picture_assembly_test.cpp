// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/picture_assembly.hpp"

#include <gtest/gtest.h>

namespace cairn::client {
namespace {

clients::PicturePart picture_part(std::uint8_t camera, std::int64_t stamp, std::uint32_t first, std::size_t count) {
  return {.stamp = Time{Duration{stamp}},
          .camera = camera,
          .total = 5,
          .first = first,
          .bytes = std::vector<std::byte>(count, std::byte{7})};
}

TEST(PictureAssembly, PartsOfTwoCamerasMayAlternate) {
  PictureAssembly pictures;
  EXPECT_FALSE(pictures.take(picture_part(0, 1, 0, 2)));
  EXPECT_FALSE(pictures.take(picture_part(1, 2, 0, 4)));
  const auto first = pictures.take(picture_part(0, 1, 2, 3));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->camera, 0);
  EXPECT_EQ(first->stamp, Time{Duration{1}});
  EXPECT_EQ(first->bytes.size(), 5U);
  EXPECT_TRUE(pictures.take(picture_part(1, 2, 4, 1)));
}

TEST(PictureAssembly, APictureThatLacksAPartIsLeftOut) {
  PictureAssembly pictures;
  EXPECT_FALSE(pictures.take(picture_part(0, 1, 0, 2)));
  EXPECT_FALSE(pictures.take(picture_part(0, 1, 3, 2)));
  EXPECT_FALSE(pictures.take(picture_part(0, 1, 0, 2)));
  EXPECT_FALSE(pictures.take(picture_part(0, 2, 2, 3)));
  EXPECT_TRUE(pictures.take(picture_part(0, 3, 0, 5)));
  EXPECT_FALSE(pictures.take(picture_part(clients::CameraMessage::kMost, 3, 0, 5)));
}

}  // namespace
}  // namespace cairn::client
