// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/recorded/label_picture.hpp"

#include <gmock/gmock.h>

#include "tests/onboard/perception/networks/sample_labels.hpp"

namespace cairn::networks {
namespace {

using ::testing::HasSubstr;

TEST(LabelPicture, WhatIsWrittenComesBack) {
  const LabelImage labels = test::sample_labels(37, 5);
  std::vector<std::byte> file;
  ASSERT_TRUE(encode_label_picture(labels, file));
  LabelImage again;
  ASSERT_TRUE(decode_label_picture(file, again));
  EXPECT_EQ(again.width, 37);
  EXPECT_EQ(again.height, 5);
  EXPECT_EQ(again.classes, labels.classes);
  EXPECT_EQ(again.probabilities, labels.probabilities);
}

TEST(LabelPicture, EightBitsAreClassesThatAreCertain) {
  LabelImage labels;
  ASSERT_TRUE(decode_label_picture(test::eight_bit_png(), labels));
  EXPECT_EQ(labels.width, 2);
  EXPECT_EQ(labels.classes, (std::vector<std::uint8_t>{11, 255}));
  EXPECT_EQ(labels.probabilities, (std::vector<std::uint8_t>{255, 255}));
}

TEST(LabelPicture, AClassThatDoesNotExistIsRefused) {
  LabelImage labels = test::sample_labels(3, 3), again;
  labels.classes[4] = 19;
  std::vector<std::byte> file;
  ASSERT_TRUE(encode_label_picture(labels, file));
  const auto decoded = decode_label_picture(file, again);
  ASSERT_FALSE(decoded);
  EXPECT_THAT(decoded.error().detail, HasSubstr("19"));
}

TEST(LabelPicture, WhatIsCutOffOrDamagedIsAnError) {
  std::vector<std::byte> file;
  ASSERT_TRUE(encode_label_picture(test::sample_labels(20, 20), file));
  LabelImage labels;
  for (std::size_t size = 0; size + 12 < file.size(); size += 7)
    EXPECT_FALSE(decode_label_picture(std::span(file).first(size), labels)) << size;
}

TEST(LabelPicture, APictureThatIsNotGreyOrTooLargeIsRefusedByItsHeader) {
  auto file = test::eight_bit_png();
  LabelImage labels;
  file[25] = std::byte{2};
  EXPECT_EQ(decode_label_picture(file, labels).error().code, Errc::kUnsupported);
  file[25] = std::byte{0};
  file[16] = std::byte{0x7F};
  EXPECT_EQ(decode_label_picture(file, labels).error().code, Errc::kLimit);
  const std::byte jpeg[] = {std::byte{0xFF}, std::byte{0xD8}};
  EXPECT_EQ(decode_label_picture(jpeg, labels).error().code, Errc::kUnsupported);
}

}  // namespace
}  // namespace cairn::networks
