// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/second_look.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "onboard/odometry/motion_prior.hpp"
#include "tests/onboard/odometry/room_points.hpp"

namespace cairn::odometry {
namespace {

constexpr double kStep_s = 0.1;
constexpr int kAmple = std::numeric_limits<int>::max();

Fit fit_of(int telling, int inliers) {
  Fit out;
  out.equations.telling = telling;
  out.equations.telling_inliers = inliers;
  return out;
}

TEST(SecondLook, IsNeededIfFewerPointsFitThanUsual) {
  SecondLook look({}, {});
  for (int i = 0; i < 200; ++i) look.learn(fit_of(1000, i % 2 == 0 ? 780 : 820));
  EXPECT_FALSE(look.needed(fit_of(1000, 760), kStep_s));
  EXPECT_TRUE(look.needed(fit_of(1000, 730), kStep_s));
  EXPECT_TRUE(look.needed(fit_of(0, 0), kStep_s)) << "nothing fits";
  EXPECT_TRUE(look.needed(fit_of(1000, 990), 0.5)) << "after half a second the prediction says little";
}

/// The prediction is known to a centimetre.
TEST(SecondLook, APieceMisleadsThatTheSettledMapsPredictionMakesUnlikely) {
  MotionFilter predicted;
  MotionFilter::Uncertainty sure;
  sure.local = 1e-4 * Matrix12::Identity();
  predicted.reset({}, sure);
  SecondLook look({}, {});
  for (int i = 0; i < 200; ++i) look.learn(fit_of(1000, 900));
  const auto misled = [&](double off_m, bool settled, int inliers = 900) {
    Fit piece = fit_of(1000, inliers);
    piece.state.T_odom_base = SE3::from_xyz_rpy((Vector6() << 0, off_m, 0, 0, 0, 0).finished());
    return look.misled(piece, predicted, settled);
  };
  EXPECT_FALSE(misled(0.03, true));
  EXPECT_TRUE(misled(0.04, true));
  EXPECT_FALSE(misled(0.04, false)) << "a young map's prediction says little";
  EXPECT_TRUE(misled(0, true, 100)) << "it does not fit";
}

TEST(SecondLook, IsNeededEarlierWhereAllScansFitAlike) {
  SecondLook look({}, {});
  for (int i = 0; i < 200; ++i) look.learn(fit_of(1000, i % 2 == 0 ? 965 : 975));
  EXPECT_TRUE(look.needed(fit_of(1000, 920), kStep_s));
  look.reset();
  for (int i = 0; i < 200; ++i) look.learn(fit_of(1000, i % 2 == 0 ? 940 : 990));
  EXPECT_FALSE(look.needed(fit_of(1000, 920), kStep_s));
  for (int i = 0; i < 200; ++i) look.learn(fit_of(1000, 970));
  EXPECT_FALSE(look.needed(fit_of(1000, 960), kStep_s)) << "a hundredth less is never unusual";
  look.learn(fit_of(1000, 500));
  EXPECT_TRUE(look.needed(fit_of(1000, 920), kStep_s)) << "one odd scan does not make others usual";
}

TEST(SecondLook, OnAnOpenFieldTheFloorIsAllThatCanFit) {
  SecondLook look({}, {});
  Fit floor;
  floor.equations.matched = 2000;
  floor.equations.inliers = 1900;
  EXPECT_FALSE(look.needed(floor, kStep_s));
  EXPECT_FALSE(look.blurred(floor)) << "or the map would never grow";
}

Fit fit_with_level(int level) {
  Fit out = fit_of(1600, 1500);
  out.equations.matched = 2000;
  out.equations.inliers = 1500 + level;
  return out;
}

TEST(SecondLook, IsNeededIfTheFloorIsNotWhereItShouldBe) {
  SecondLook look({}, {});
  for (int i = 0; i < 100; ++i) look.learn(fit_with_level(300));
  EXPECT_FALSE(look.needed(fit_with_level(240), kStep_s));
  EXPECT_TRUE(look.needed(fit_with_level(200), kStep_s)) << "the tilt or the height is wrong";
  look.reset();
  for (int i = 0; i < 100; ++i) look.learn(fit_with_level(80));
  EXPECT_FALSE(look.needed(fit_with_level(10), kStep_s)) << "where there is hardly any, it says nothing";
}

TEST(SecondLook, AWrongFitDoesNotBecomeUsualAtOnce) {
  SecondLook look({}, {});
  for (int i = 0; i < 10; ++i) look.learn(fit_of(1000, 500));
  EXPECT_TRUE(look.needed(fit_of(1000, 500), kStep_s));
  look.reset();
  EXPECT_FALSE(look.needed(fit_of(1000, 940), kStep_s));
}

TEST(SecondLook, AScanThatFitsFarWorseWouldBlurTheMap) {
  SecondLook look({}, {});
  EXPECT_FALSE(look.blurred(fit_of(1000, 710)));
  EXPECT_TRUE(look.blurred(fit_of(1000, 690)));
}

/// A room that is mapped, and a robot that stood in it until something turned it.
class SecondLookInARoom : public ::testing::Test {
 protected:
  void SetUp() override {
    map_.insert(Room(1).points(30000, 0.01), Room::sensor(), 0, workers_);
    Vector12 sigma = Vector12::Constant(0.01);
    MotionFilter::Uncertainty uncertainty;
    uncertainty.local = uncertainty.total = sigma.cwiseAbs2().asDiagonal();
    narrow_.reset({}, uncertainty);
    wide_ = narrow_;
    narrow_.predict(kStep_s, MotionPrior({}).usual(true));
    wide_.predict(kStep_s, MotionPrior({}).anything(kStep_s));
  }
  Selection scan_from(const SE3& truth) { return scan_of(Room(3).points(2000, 0.01), truth); }
  Selection scan_of(const std::vector<Eigen::Vector3d>& points, const SE3& truth) {
    keypoints_.clear();
    for (const Eigen::Vector3d& p : points) keypoints_.push_back({(truth.inverse() * p).cast<float>(), 0});
    return {.for_map = {}, .keypoints = keypoints_, .duration_s = 0};
  }
  Fit first(const Selection& scan) {
    Budget budget = Budget::steps(kAmple);
    return registration_.align(scan, map_, narrow_, narrow_.state(), budget);
  }
  std::optional<Fit> second(const Selection& scan, const Fit& before, int steps = kAmple) {
    Budget budget = Budget::steps(steps);
    return look_.find(scan, map_, wide_, before, kStep_s, registration_, budget, possible_);
  }

  SecondLook::Possible possible_ = [](const MotionState&) { return true; };
  Workers workers_{1};
  PatchMap map_{{.finest_block_m = 0.5, .max_blocks = 1 << 14, .max_points_per_block = 400, .criteria = {}}};
  MotionFilter narrow_, wide_;
  Registration registration_{{}, {}, workers_};
  SecondLook look_{{}, {}};
  std::vector<Keypoint> keypoints_;
};

TEST_F(SecondLookInARoom, FindsWhatTheFirstHasMissed) {
  for (const double yaw : {-0.5, 0.35, 0.5}) {
    const SE3 truth = SE3::from_xyz_rpy((Vector6() << 0.2, -0.15, 0.02, 0.05, -0.05, yaw).finished());
    const Selection scan = scan_from(truth);
    const Fit missed = first(scan);
    ASSERT_GT(rotation_angle(missed.state.T_odom_base.inverse() * truth), 0.05)
        << "the test needs a jerk that is too much";
    EXPECT_TRUE(look_.needed(missed, kStep_s));
    const auto found = second(scan, missed);
    ASSERT_TRUE(found) << yaw;
    EXPECT_LT((found->state.T_odom_base.inverse() * truth).log().norm(), 0.01) << yaw;
    EXPECT_EQ(registration_.uses().size(), scan.keypoints.size());
  }
}

/// Rough ground with slim trunks, as far as a scan reaches.
std::vector<Eigen::Vector3d> forest(unsigned seed, std::size_t n) {
  std::mt19937 random(seed), places(7);
  std::uniform_real_distribution<double> far(-20, 20), high(-1, 2);
  std::normal_distribution<double> bark(0, 0.02), ground(-1, 0.1);
  std::vector<Eigen::Vector3d> trunks, out;
  for (int i = 0; i < 200; ++i) trunks.emplace_back(far(places), far(places), 0);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d& trunk = trunks[i / 3 % trunks.size()];
    if (i % 3 == 0)
      out.emplace_back(trunk + Eigen::Vector3d(bark(random), bark(random), high(random)));
    else
      out.emplace_back(far(random), far(random), ground(random));
  }
  return out;
}

TEST_F(SecondLookInARoom, FindsTheTiltOfANodInAForest) {
  map_.clear();
  map_.insert(forest(1, 60000), Room::sensor(), 0, workers_);
  for (int i = 0; i < 100; ++i) look_.learn(fit_with_level(1000));
  int found = 0;
  for (const double roll : {0.0, 0.06, -0.05, 0.03}) {
    for (const double pitch : {-0.12, -0.1, -0.08, 0.08, 0.12}) {
      const SE3 truth = SE3::from_xyz_rpy((Vector6() << 0.1, 0.02, 0.02, roll, pitch, 0.02).finished());
      const Selection scan = scan_of(forest(2, 2000), truth);
      const MotionFilter prediction = wide_;
      const auto fit = second(scan, first(scan));
      wide_ = prediction;
      found += fit && (fit->state.T_odom_base.inverse() * truth).log().norm() < 0.1 ? 1 : 0;
    }
  }
  EXPECT_GE(found, 18) << "of 20; without a search for the tilt 13";
}

TEST_F(SecondLookInARoom, LeavesAGoodFitAlone) {
  const Selection scan = scan_from(SE3::exp(0.01 * Vector6::Ones()));
  const Fit good = first(scan);
  EXPECT_FALSE(look_.needed(good, kStep_s));
  EXPECT_FALSE(second(scan, good));
}

TEST_F(SecondLookInARoom, FindsTheFloorAgainThoughTheWallsFitAsWell) {
  const Selection scan = scan_from(SE3::exp(0.01 * Vector6::Ones()));
  const Fit good = first(scan);
  for (int i = 0; i < 100; ++i) look_.learn(good);
  Fit tilted = good;
  tilted.equations.inliers = good.equations.telling_inliers;
  EXPECT_TRUE(look_.needed(tilted, kStep_s));
  EXPECT_TRUE(second(scan, tilted));
}

TEST_F(SecondLookInARoom, DoesNotFindWhatIsNotPossible) {
  const SE3 truth = SE3::from_xyz_rpy((Vector6() << 0.2, -0.15, 0.02, 0.05, -0.05, 0.5).finished());
  const Selection scan = scan_from(truth);
  const Fit missed = first(scan);
  ASSERT_TRUE(second(scan, missed));
  possible_ = [](const MotionState&) { return false; };
  EXPECT_FALSE(second(scan, missed));
}

TEST_F(SecondLookInARoom, WithoutTimeOrPointsNothingIsFound) {
  const SE3 truth = SE3::from_xyz_rpy((Vector6() << 0, 0, 0, 0, 0, 0.5).finished());
  const Selection scan = scan_from(truth);
  Budget spent = Budget::steps(1);
  EXPECT_TRUE(spent.one_more());
  EXPECT_FALSE(look_.find(scan, map_, wide_, first(scan), kStep_s, registration_, spent, possible_));
  keypoints_.clear();
  EXPECT_FALSE(second({.for_map = {}, .keypoints = keypoints_, .duration_s = 0}, {}));
}

}  // namespace
}  // namespace cairn::odometry
