// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/saved_bytes.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace cairn::app {
namespace {

TEST(SavedBytes, APoseReadsBackToTheBitAndANumberThatIsNoneDoesNot) {
  std::vector<std::byte> bytes;
  const SE3 T = SE3::from_xyz_rpy((Vector6() << 1, 2, 3, 0.1, 0.2, 0.3).finished());
  append_pose(bytes, T);
  ByteReader in(bytes);
  EXPECT_EQ(read_pose(in).value().matrix(), T.matrix());
  EXPECT_FALSE(read_pose(in)) << "nothing is left";
  for (const double wrong : {2.0, std::numeric_limits<double>::quiet_NaN()}) {
    auto damaged = bytes;
    std::memcpy(damaged.data() + damaged.size() - sizeof(double), &wrong, sizeof(double));  // w of the quaternion
    ByteReader from(damaged);
    EXPECT_FALSE(read_pose(from)) << wrong;
  }
}

TEST(SavedBytes, AHeaderReadsBackAndACutOneDoesNot) {
  std::vector<std::byte> bytes;
  append_header(bytes, {{'A', 'B', 'C', 'D', 'E', 'F', 'G', 'H'}, 2, 3, 4});
  const std::span<const std::byte> all(bytes);
  ByteReader whole(all), cut(all.first(all.size() - 1));
  const auto header = read_header(whole);
  ASSERT_TRUE(header);
  EXPECT_EQ(header->magic[7], 'H');
  EXPECT_EQ(header->version, 2U);
  EXPECT_EQ(header->epoch, 3U);
  EXPECT_EQ(header->count, 4U);
  EXPECT_FALSE(read_header(cut));
}

TEST(SavedBytes, TheSealHoldsTheBytesTogether) {
  std::vector<std::byte> bytes(5, std::byte{9});
  seal(bytes);
  ASSERT_TRUE(unseal(bytes));
  EXPECT_EQ(unseal(bytes)->size(), 5U);
  bytes[2] ^= std::byte{1};
  EXPECT_FALSE(unseal(bytes));
  EXPECT_FALSE(unseal(std::span(bytes).first(7)));
}

}  // namespace
}  // namespace cairn::app
