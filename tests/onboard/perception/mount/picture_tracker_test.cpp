// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/mount/picture_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/onboard/perception/mount/textured_room.hpp"

namespace cairn::mount {
namespace {

std::optional<Eigen::Vector2d> where_it_was(const Eigen::Vector2d& before) { return before; }

/// The same picture, shifted to the right.
Image shifted(const Image& picture, int by) {
  Image to = picture;
  for (int y = 0; y < picture.height; ++y)
    for (int x = by; x < picture.width; ++x)
      to.bytes[static_cast<std::size_t>(y * picture.width + x)] =
          picture.bytes[static_cast<std::size_t>(y * picture.width + x - by)];
  return to;
}

/// Matches that are within 0.1 pixels of a shift.
std::size_t right_ones(std::span<const Match> matches, double shift) {
  return static_cast<std::size_t>(std::ranges::count_if(
      matches, [&](const Match& m) { return (m.now - m.before - Eigen::Vector2d(shift, 0)).norm() < 0.1; }));
}

class PictureTrackerTest : public ::testing::Test {
 protected:
  const Image picture_ = test::TexturedRoom().see(test::small_camera(), SE3(), Time{});
  PictureTracker tracker_;
};

TEST_F(PictureTrackerTest, FindsCornersAgain) {
  tracker_.refer_to(picture_);
  ASSERT_GT(tracker_.corners(), 20U);
  const auto matches = tracker_.find_in(shifted(picture_, 3), where_it_was);
  ASSERT_GT(matches.size(), tracker_.corners() / 2);
  EXPECT_GT(right_ones(matches, 3), 0.9 * static_cast<double>(matches.size()));
}

TEST_F(PictureTrackerTest, AnExpectationHelpsWhereThePictureMovedFar) {
  tracker_.refer_to(picture_);
  const Image far = shifted(picture_, 45);
  const std::size_t alone = right_ones(tracker_.find_in(far, where_it_was), 45);
  const auto matches = tracker_.find_in(far, [](const Eigen::Vector2d& before) -> std::optional<Eigen::Vector2d> {
    if (before.x() > 100) return {};
    return Eigen::Vector2d(before.x() + 42, before.y() + 2);
  });
  EXPECT_GT(right_ones(matches, 45), 10U);
  EXPECT_GT(right_ones(matches, 45), 2 * alone);
  for (const Match& m : matches) EXPECT_LE(m.before.x(), 100);
}

TEST_F(PictureTrackerTest, WhatIsGoneIsNotFound) {
  tracker_.refer_to(picture_);
  Image grey = picture_;
  std::fill(grey.bytes.begin(), grey.bytes.end(), std::byte{128});
  EXPECT_TRUE(tracker_.find_in(grey, where_it_was).empty());
}

TEST_F(PictureTrackerTest, TheFoundPictureBecomesTheReference) {
  tracker_.refer_to(picture_);
  (void)tracker_.find_in(shifted(picture_, 4), where_it_was);
  tracker_.refer_to_found();
  const auto matches = tracker_.find_in(shifted(picture_, 6), where_it_was);
  ASSERT_FALSE(matches.empty());
  EXPECT_GT(2 * right_ones(matches, 2), matches.size());
}

}  // namespace
}  // namespace cairn::mount
