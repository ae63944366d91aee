// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/saved_scans.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cairn::app {
namespace {

SavedScans some_scans() {
  SavedScans saved{7, {}};
  for (int i = 0; i < 3; ++i) {
    odometry::PlacedScan scan{
        Time{Duration{100 * i}}, SE3::from_xyz_rpy((Vector6() << i, 1, 2, 0.1, 0.2, 0.3 * i).finished()), {}};
    for (int k = 0; k < 4 * i; ++k) scan.points_base.emplace_back(0.1F * static_cast<float>(k), 1.0F, -2.5F);
    saved.scans.push_back(scan);
  }
  return saved;
}

TEST(SavedScans, ReadBackToTheBit) {
  const SavedScans saved = some_scans();
  const auto back = decode_scans(encode(saved));
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(back->epoch, 7U);
  ASSERT_EQ(back->scans.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back->scans[i].stamp, saved.scans[i].stamp);
    EXPECT_EQ(back->scans[i].T_odom_base.matrix(), saved.scans[i].T_odom_base.matrix());
    EXPECT_EQ(back->scans[i].points_base, saved.scans[i].points_base);
  }
}

TEST(SavedScans, AnyDamagedByteAndAnyCutIsAnError) {
  const auto bytes = encode(some_scans());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto damaged = bytes;
    damaged[i] ^= std::byte{0x10};
    EXPECT_FALSE(decode_scans(damaged)) << "byte " << i;
    EXPECT_FALSE(decode_scans(std::span(bytes).first(i))) << "cut at " << i;
  }
}

/// With a checksum that is right: whoever wrote that was wrong, or wanted harm.
TEST(SavedScans, RefusesWhatIsNotFiniteAndTooMany) {
  SavedScans saved = some_scans();
  saved.scans[2].points_base[1].y() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(decode_scans(encode(saved)).error().code, Errc::kMalformed);
  saved = some_scans();
  saved.scans.resize(odometry::RecentScans::kScans + 1);
  EXPECT_EQ(decode_scans(encode(saved)).error().code, Errc::kLimit);
}

}  // namespace
}  // namespace cairn::app
