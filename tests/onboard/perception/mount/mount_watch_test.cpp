// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/mount/mount_watch.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/onboard/perception/mount/textured_room.hpp"

namespace cairn::mount {
namespace {

using test::kDegree;

/// Pictures of one drive, five a second.
class MountWatchTest : public ::testing::Test {
 protected:
  static constexpr std::size_t kPictures = 110;
  static void SetUpTestSuite() {
    const test::TexturedRoom room;
    for (std::size_t i = 0; i < kPictures; ++i) {
      poses_.push_back(test::driven(0.2 * static_cast<double>(i)));
      pictures_.push_back(room.see(test::small_camera(), poses_.back(), Time(i * std::chrono::milliseconds(200))));
    }
  }
  static void TearDownTestSuite() {
    pictures_.clear();
    poses_.clear();
  }
  static MountWatch watch(const Eigen::Vector3d& turn_deg) {
    return {test::small_camera(), test::wrong_mount(turn_deg), {}};
  }
  static inline std::vector<Image> pictures_;
  static inline std::vector<SE3> poses_;
};

TEST_F(MountWatchTest, SaysNothingOfACameraThatLooksWhereItShould) {
  MountWatch w = watch({0, 0, 0});
  for (std::size_t i = 0; i < kPictures; ++i) ASSERT_TRUE(w.look(pictures_[i], poses_[i], 0));
  ASSERT_TRUE(w.estimate());
  EXPECT_LT(w.estimate()->turn_rad.cwiseAbs().maxCoeff(), 0.25 * kDegree) << w.estimate()->turn_rad / kDegree;
  EXPECT_FALSE(w.moved());
  EXPECT_GT(w.pairs(), 60U);
}

TEST_F(MountWatchTest, NoticesOneDegreeAboutAnyAxisWithinTwentySeconds) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d turn = Eigen::Vector3d::Unit(axis);
    MountWatch w = watch(turn);
    for (std::size_t i = 0; i < kPictures; ++i) w.look(pictures_[i], poses_[i], 0);
    EXPECT_TRUE(w.moved()) << axis;
    ASSERT_TRUE(w.estimate());
    EXPECT_LT((w.estimate()->turn_rad / kDegree - turn).cwiseAbs().maxCoeff(), 0.3)
        << (w.estimate()->turn_rad / kDegree).transpose();
  }
}

/// As if the mount had been right before: poses tell where the camera was, not how it was mounted.
TEST_F(MountWatchTest, NoticesAKnockDuringTheDrive) {
  const SE3 knock = SE3::exp((Vector6() << 0, 0, 0, 0, 1.2 * kDegree, 0).finished());
  const SE3 X = (test::true_mount() * knock * test::true_mount().inverse()).inverse();
  MountWatch w = watch({0, 0, 0});
  for (std::size_t i = 0; i < 40; ++i) w.look(pictures_[i], poses_[i], 0);
  EXPECT_FALSE(w.moved());
  for (std::size_t i = 40; i < kPictures; ++i) w.look(pictures_[i], poses_[i] * X, 1);
  EXPECT_TRUE(w.moved());
}

TEST_F(MountWatchTest, PosesOfTwoEpochsAreNotCompared) {
  MountWatch w = watch({0, 0, 0});
  for (std::size_t i = 0; i < 20; ++i) w.look(pictures_[i], poses_[i], static_cast<std::uint32_t>(i));
  EXPECT_EQ(w.pairs(), 0U);
}

TEST_F(MountWatchTest, ARobotThatStandsIsNotJudged) {
  MountWatch w = watch({0, 3, 0});
  for (std::size_t i = 0; i < kPictures; ++i) {
    Image same = pictures_[0];
    same.stamp = pictures_[i].stamp;
    w.look(same, poses_[0], 0);
  }
  EXPECT_EQ(w.pairs(), 0U);
  EXPECT_FALSE(w.estimate());
  EXPECT_FALSE(w.moved());
}

TEST_F(MountWatchTest, APictureOfAnotherSizeIsRefused) {
  MountWatch w = watch({0, 0, 0});
  Image small;
  small.resize(PixelFormat::kMono8, 80, 60);
  EXPECT_FALSE(w.look(small, SE3(), 0));
}

TEST_F(MountWatchTest, SameInSameOut) {
  MountWatch a = watch({1, 0, 0}), b = watch({1, 0, 0});
  for (std::size_t i = 0; i < kPictures; ++i) {
    a.look(pictures_[i], poses_[i], 0);
    b.look(pictures_[i], poses_[i], 0);
  }
  EXPECT_EQ(a.estimate()->turn_rad, b.estimate()->turn_rad);
}

}  // namespace
}  // namespace cairn::mount
