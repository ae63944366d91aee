// SPDX-License-Identifier: Apache-2.0
#include "hal/bytes.hpp"

#include <gtest/gtest.h>

namespace cairn {
namespace {

TEST(Bytes, ReadsBackWhatWasAppended) {
  std::vector<std::byte> bytes;
  append_le<std::uint16_t>(bytes, 0xEEFF);
  append_le<double>(bytes, -1.5);
  EXPECT_EQ(bytes[0], std::byte{0xFF});
  ByteReader reader(bytes);
  EXPECT_EQ(reader.read<std::uint16_t>(), 0xEEFF);
  EXPECT_EQ(reader.read<double>(), -1.5);
  EXPECT_EQ(reader.remaining(), 0U);
}

TEST(Bytes, NeverMovesPastTheEnd) {
  const std::vector<std::byte> bytes(3);
  ByteReader reader(bytes);
  EXPECT_FALSE(reader.read<std::uint32_t>());
  EXPECT_EQ(reader.offset(), 0U);
  EXPECT_FALSE(reader.read_bytes(~0ULL));
  EXPECT_EQ(reader.read_bytes(3)->size(), 3U);
  EXPECT_FALSE(reader.read<std::uint8_t>());
  EXPECT_EQ(reader.read_bytes(0)->size(), 0U);
}

}  // namespace
}  // namespace cairn
