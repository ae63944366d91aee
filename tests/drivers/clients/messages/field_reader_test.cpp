// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/field_reader.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cairn::clients {
namespace {

TEST(FieldReader, AfterTheFirstFaultEverythingIsZero) {
  std::vector<std::byte> body;
  append_le(body, std::uint8_t{9});
  append_le(body, 1.5);
  FieldReader in(body);
  EXPECT_EQ(in.up_to(std::uint8_t{8}), 0);
  EXPECT_EQ(in.real(), 0);
  EXPECT_FALSE(in.complete());
  EXPECT_EQ(in.error("why").code, Errc::kMalformed);
}

TEST(FieldReader, RefusesNumbersThatAreNotFiniteOrTooLarge) {
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 11.0}) {
    std::vector<std::byte> body;
    append_le(body, wrong);
    FieldReader in(body);
    EXPECT_EQ(in.real(10), 0);
    EXPECT_FALSE(in.good());
  }
}

TEST(FieldReader, RefusesAQuaternionThatIsNoRotation) {
  std::vector<std::byte> body;
  append_pose(body, SE3());
  FieldReader right(body);
  EXPECT_EQ(right.pose().log().norm(), 0);
  EXPECT_TRUE(right.complete());
  const double two = 2;
  std::memcpy(body.data() + 6 * sizeof two, &two, sizeof two);
  FieldReader wrong(body);
  (void)wrong.pose();
  EXPECT_FALSE(wrong.good());
}

TEST(FieldReader, TextIsCutBetweenCharacters) {
  std::vector<std::byte> body;
  append_text(body, "aä", 2);
  FieldReader in(body);
  EXPECT_EQ(in.text(2), "a");
  EXPECT_TRUE(in.complete());
  body.clear();
  append_text(body, "aä", 3);
  FieldReader whole(body);
  EXPECT_EQ(whole.text(3), "aä");
  FieldReader too_long(body);
  EXPECT_EQ(too_long.text(2), "");
  EXPECT_FALSE(too_long.good());
}

}  // namespace
}  // namespace cairn::clients
