// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/box_lifter.hpp"

#include <gtest/gtest.h>

#include "hal/semantic_class.hpp"

namespace cairn::people {
namespace {

constexpr int kWidth = 672, kHeight = 376;
constexpr double kFocal = 350, kCameraHeight = 0.5;

cameras::CameraModel camera() {
  return cameras::CameraModel::create({.width = kWidth,
                                       .height = kHeight,
                                       .fx = kFocal,
                                       .fy = kFocal,
                                       .cx = 335.5,
                                       .cy = 187.5,
                                       .distortion = {}})
      .value();
}

Cluster cluster_at(float x, float y) {
  return {.centre = {x, y}, .ground = 0, .top = 1.7F, .extent = 0.5F, .points = 40};
}

/// The box of a person of this height, by hand.
Detection box_at(double x, double y, double height = 1.72, float score = 0.9F) {
  const double u = 336 - kFocal * y / x, top = 188 - kFocal * (height - kCameraHeight) / x;
  const double bottom = 188 + kFocal * kCameraHeight / x, width = kFocal * 0.5 / x;
  Detection box{.class_id = kPersonClass, .score = score};
  box.x = static_cast<float>(std::max(0.0, u - width / 2));
  box.y = static_cast<float>(std::max(0.0, top));
  box.width = static_cast<float>(std::min(double{kWidth}, u + width / 2)) - box.x;
  box.height = static_cast<float>(std::min(double{kHeight}, bottom)) - box.y;
  return box;
}

class BoxLifterTest : public ::testing::Test {
 protected:
  std::vector<Verdict> judge(const std::vector<Detection>& found, const std::vector<Cluster>& clusters,
                             const SE3& T_odom_base = {}) {
    const Detections boxes{.source = {}, .stamp = {}, .width = kWidth, .height = kHeight, .found = found};
    const auto answers = lifter_.judge(boxes, clusters, T_odom_base);
    std::vector<Verdict> verdicts;
    for (const Answer& answer : answers) verdicts.push_back(answer.verdict);
    return verdicts;
  }
  BoxLifter lifter_{camera(), SE3::from_xyz_rpy((Vector6() << 0, 0, kCameraHeight, 0, 0, 0).finished()), 15};
};

using enum Verdict;

TEST_F(BoxLifterTest, EachBoxFindsItsCluster) {
  EXPECT_EQ(judge({box_at(8, -2), box_at(5, 1)}, {cluster_at(5, 1), cluster_at(8, -2), cluster_at(6, 4)}),
            (std::vector{kPerson, kPerson, kSilence}));
}

/// Somebody stands behind a lamp post.
TEST_F(BoxLifterTest, NoBoxIsOfWhatLetsRaysPass) {
  Cluster post = cluster_at(5.0F, 0.05F);
  post.passed = 0.75F;
  EXPECT_EQ(judge({box_at(5.3, 0.1)}, {post, cluster_at(5.3F, 0.1F)}), (std::vector{kSilence, kPerson}));
}

TEST_F(BoxLifterTest, SilenceAboutLegsMeansNothing) {
  Cluster legs = cluster_at(5, 1);
  legs.low = true;
  EXPECT_EQ(judge({}, {legs, cluster_at(5, -1)}), (std::vector{kNothing, kSilence}));
  EXPECT_EQ(judge({box_at(5, 1)}, {legs}), std::vector{kPerson}) << "the camera may see over a desk";
}

TEST_F(BoxLifterTest, ScoresComeWithTheVerdicts) {
  const Detections boxes{.source = {},
                         .stamp = {},
                         .width = kWidth,
                         .height = kHeight,
                         .found = {box_at(8, -2, 1.72, 0.6F), box_at(4, 2, 1.72, 0.7F)}};
  const std::vector<Cluster> clusters{cluster_at(5, 1), cluster_at(8, -2)};
  const auto answers = lifter_.judge(boxes, clusters, {});
  EXPECT_EQ(answers[0].score, 0);
  EXPECT_EQ(answers[1].score, 0.6F);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 10; ++i) points.emplace_back(4, 2, 0.3F + 0.1F * static_cast<float>(i));
  const auto lifted = lifter_.lift(points);
  ASSERT_EQ(lifted.size(), 1U);
  EXPECT_EQ(lifted[0].score, 0.7F);
}

TEST_F(BoxLifterTest, WhoStandsCloseFillsThePicture) {
  EXPECT_EQ(judge({box_at(1.5, 0)}, {cluster_at(1.5F, 0)}), std::vector{kPerson});
}

TEST_F(BoxLifterTest, TheDepthIsThatOfWhoeverFitsTheHeight) {
  EXPECT_EQ(judge({box_at(4, 0)}, {cluster_at(12, 0.2F), cluster_at(4, 0)}), (std::vector{kNothing, kPerson}))
      << "the one behind is hidden: of it the picture says nothing";
  EXPECT_EQ(judge({box_at(12, 0)}, {cluster_at(3, 0.1F)}), std::vector{kSilence})
      << "a far person is not this near pole";
}

TEST_F(BoxLifterTest, OutOfViewAndFarAwaySilenceMeansNothing) {
  EXPECT_EQ(judge({}, {cluster_at(-5, 0), cluster_at(2, 6), cluster_at(18, 0)}),
            (std::vector{kNothing, kNothing, kNothing}));
}

TEST_F(BoxLifterTest, BoxesOfOtherClassesAreNobody) {
  Detection car = box_at(5, 0);
  car.class_id = 13;
  EXPECT_EQ(judge({car}, {cluster_at(5, 0)}), std::vector{kSilence});
}

TEST_F(BoxLifterTest, OneBoxIsOnePerson) {
  const auto verdicts = judge({box_at(6, 0)}, {cluster_at(6, 0.1F), cluster_at(6, -0.2F)});
  EXPECT_EQ(std::ranges::count(verdicts, kPerson), 1);
  EXPECT_EQ(verdicts[0], kPerson) << "the nearer one to its middle";
}

TEST_F(BoxLifterTest, TheRobotTurnsAndTheBoxTurnsWithIt) {
  const SE3 turned = SE3::from_xyz_rpy((Vector6() << 1, 2, 0, 0, 0, M_PI / 2).finished());
  EXPECT_EQ(judge({box_at(5, 0)}, {cluster_at(1, 7), cluster_at(6, 2)}, turned), (std::vector{kPerson, kNothing}));
}

TEST_F(BoxLifterTest, PicturesOfAnotherSizeAreScaled) {
  Detection box = box_at(5, 1);
  box.x /= 2, box.y /= 2, box.width /= 2, box.height /= 2;
  const Detections half{.source = {}, .stamp = {}, .width = kWidth / 2, .height = kHeight / 2, .found = {box}};
  EXPECT_EQ(lifter_.judge(half, std::vector{cluster_at(5, 1)}, {})[0].verdict, kPerson);
  EXPECT_EQ(lifter_.judge({}, std::vector{cluster_at(5, 1)}, {})[0].verdict, kNothing) << "a picture without a size";
}

TEST_F(BoxLifterTest, BoxesThatAreNoneChangeNothing) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  Detection bad = box_at(5, 0), flat = bad;
  bad.x = kNan;
  flat.height = 0;
  EXPECT_EQ(judge({bad, flat}, {cluster_at(5, 0)}), std::vector{kSilence});
}

TEST_F(BoxLifterTest, ABoxWithoutAClusterFindsThePointsOfItsHeight) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 20; ++i) {
    const float z = 0.3F + 0.06F * static_cast<float>(i);
    points.emplace_back(3, 0, z);     // too near for so small a box
    points.emplace_back(6, 0.1F, z);  // the body
    points.emplace_back(6, 1.5F, z);  // beside it
    points.emplace_back(7, 0, z);     // what is behind
  }
  judge({box_at(6, 0)}, {cluster_at(6, 4)});
  const auto lifted = lifter_.lift(points);
  ASSERT_EQ(lifted.size(), 1U);
  EXPECT_LT((lifted[0].position - Eigen::Vector2d(6, 0.1)).norm(), 0.05);
  judge({box_at(6, 4)}, {cluster_at(6, 4)});
  EXPECT_TRUE(lifter_.lift(points).empty()) << "that box has its cluster";
  judge({box_at(6, 0)}, {});
  EXPECT_TRUE(lifter_.lift(std::span(points).first(8)).empty()) << "two points are nobody";
}

}  // namespace
}  // namespace cairn::people
