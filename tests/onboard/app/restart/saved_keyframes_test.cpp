// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/saved_keyframes.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cairn::app {
namespace {

SavedKeyframes some_keyframes() {
  SavedKeyframes saved{7, {}};
  for (int i = 0; i < 3; ++i) {
    visual_odometry::Keyframe keyframe;
    keyframe.stamp = Time{Duration{100 * i}};
    keyframe.T_odom_base = SE3::from_xyz_rpy((Vector6() << i, 1, 2, 0.1, 0.2, 0.3 * i).finished());
    for (int k = 0; k < 2 * i; ++k) {
      visual_odometry::Landmark landmark;
      landmark.p_odom = {0.1 * k, 1.0 / 3, -2.5};
      landmark.covariance << 0.04, 0.01, 0, 0.01, 0.05, -0.02, 0, -0.02, 0.06;
      keyframe.landmarks.push_back(landmark);
      keyframe.descriptors.push_back({1, 2, static_cast<std::uint64_t>(k), ~std::uint64_t{0}});
    }
    saved.keyframes.push_back(keyframe);
  }
  return saved;
}

TEST(SavedKeyframes, ReadBackToTheBit) {
  const SavedKeyframes saved = some_keyframes();
  const auto back = decode_keyframes(encode(saved));
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(back->epoch, 7U);
  ASSERT_EQ(back->keyframes.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const visual_odometry::Keyframe &in = saved.keyframes[i], &out = back->keyframes[i];
    EXPECT_EQ(out.stamp, in.stamp);
    EXPECT_EQ(out.T_odom_base.matrix(), in.T_odom_base.matrix());
    EXPECT_EQ(out.descriptors, in.descriptors);
    ASSERT_EQ(out.landmarks.size(), in.landmarks.size());
    for (std::size_t k = 0; k < in.landmarks.size(); ++k) {
      EXPECT_EQ(out.landmarks[k].p_odom, in.landmarks[k].p_odom);
      EXPECT_EQ(out.landmarks[k].covariance, in.landmarks[k].covariance);
    }
  }
}

TEST(SavedKeyframes, AnyDamagedByteAndAnyCutIsAnError) {
  const auto bytes = encode(some_keyframes());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto damaged = bytes;
    damaged[i] ^= std::byte{0x10};
    EXPECT_FALSE(decode_keyframes(damaged)) << "byte " << i;
    EXPECT_FALSE(decode_keyframes(std::span(bytes).first(i))) << "cut at " << i;
  }
}

/// With a checksum that is right: whoever wrote that was wrong, or wanted harm.
TEST(SavedKeyframes, RefusesWhatCannotBeAndTooMany) {
  SavedKeyframes saved = some_keyframes();
  saved.keyframes[2].landmarks[1].p_odom.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(decode_keyframes(encode(saved)).error().code, Errc::kMalformed);
  saved = some_keyframes();
  saved.keyframes[2].landmarks[1].covariance(0, 0) = -1;
  EXPECT_EQ(decode_keyframes(encode(saved)).error().code, Errc::kMalformed);
  saved = some_keyframes();
  saved.keyframes.resize(visual_odometry::PlaceMemory::kPlaces + 1);
  EXPECT_EQ(decode_keyframes(encode(saved)).error().code, Errc::kLimit);
}

}  // namespace
}  // namespace cairn::app
