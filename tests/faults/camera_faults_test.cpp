// SPDX-License-Identifier: Apache-2.0
// One camera of two is wrong. The other one finds the people, and geometry goes on as if nothing were.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/faults/eyes_rig.hpp"

namespace cairn::faults {
namespace {

constexpr double kTwoDegrees = 0.0349;

/// Odometry does not look at pictures.
bool same_track(const EyesOutcome& a, const EyesOutcome& b) {
  return a.ran && b.ran && a.track.size() > 30 &&
         std::ranges::equal(a.track, b.track, [](const TrackPoint& x, const TrackPoint& y) {
           return x.stamp == y.stamp && x.T_odom_base.mean.matrix() == y.T_odom_base.mean.matrix();
         });
}

class CameraFaults : public testing::Test {
 protected:
  static void SetUpTestSuite() { well_ = new EyesOutcome(drive_with(Ill::kNot, Ill::kNot)); }
  static void TearDownTestSuite() { delete std::exchange(well_, nullptr); }

  static EyesOutcome hold(Ill colour, Ill thermal) {
    EyesOutcome out = drive_with(colour, thermal);
    EXPECT_TRUE(same_track(out, *well_));
    EXPECT_EQ(out.decision.mode, safety::Mode::kNormal);
    EXPECT_EQ(out.people, 4U);
    EXPECT_EQ(out.body_voxels, 0U);
    return out;
  }
  static inline const EyesOutcome* well_ = nullptr;
};

TEST_F(CameraFaults, TwoEyesThatAreWellLeavePeopleOutOfTheMap) {
  EXPECT_TRUE(well_->ran);
  EXPECT_EQ(well_->people, 4U);
  EXPECT_EQ(well_->body_voxels, 0U);
  EXPECT_GT(well_->colour_looked, 15U);
  EXPECT_GT(well_->thermal_looked, 15U);
  EXPECT_TRUE(well_->events.empty()) << well_->events.front().what;
}

TEST_F(CameraFaults, WithoutEyesPeopleAreFurniture) {
  const EyesOutcome out = drive_with(Ill::kSilent, Ill::kSilent);
  EXPECT_TRUE(same_track(out, *well_));
  EXPECT_EQ(out.people, 0U);
  EXPECT_GT(out.body_voxels, 10U);
}

TEST_F(CameraFaults, ASilentColourCamera) {
  EXPECT_TRUE(hold(Ill::kSilent, Ill::kNot).decision.active.has(safety::Fault::kCameraSilent));
}

TEST_F(CameraFaults, ASilentThermalCamera) {
  EXPECT_TRUE(hold(Ill::kNot, Ill::kSilent).decision.active.has(safety::Fault::kThermalSilent));
}

TEST_F(CameraFaults, AFrozenColourCameraIsNoEvidence) {
  const EyesOutcome out = hold(Ill::kFrozen, Ill::kNot);
  EXPECT_EQ(out.colour_looked, 1U) << "the first picture was new";
  EXPECT_TRUE(out.has_event("the same picture again"));
  EXPECT_TRUE(out.decision.active.has(safety::Fault::kCameraSilent));
}

TEST_F(CameraFaults, AFrozenThermalCameraIsNoEvidence) {
  const EyesOutcome out = hold(Ill::kNot, Ill::kFrozen);
  EXPECT_EQ(out.thermal_looked, 1U);
  EXPECT_TRUE(out.has_event("the same picture again"));
}

TEST_F(CameraFaults, AnOverexposedColourCamera) {
  const EyesOutcome out = hold(Ill::kOverexposed, Ill::kNot);
  EXPECT_EQ(out.colour_looked, 0U);
  EXPECT_TRUE(out.has_event("overexposed"));
}

TEST_F(CameraFaults, AnOverexposedThermalCamera) {
  const EyesOutcome out = hold(Ill::kNot, Ill::kOverexposed);
  EXPECT_EQ(out.thermal_looked, 0U);
  EXPECT_TRUE(out.has_event("overexposed"));
}

TEST_F(CameraFaults, AThermalCameraInFlatFieldCorrectionIsNoFault) {
  const EyesOutcome out = hold(Ill::kNot, Ill::kCorrecting);
  EXPECT_EQ(out.thermal_looked, 0U);
  EXPECT_TRUE(out.events.empty()) << out.events.front().what;
}

TEST_F(CameraFaults, AColourCameraThatIsTurnedByTwoDegrees) {
  const EyesOutcome out = hold(Ill::kTurned, Ill::kNot);
  EXPECT_NEAR(out.colour_offset.value_or(0), kTwoDegrees, 0.01);
  EXPECT_TRUE(out.has_event("camera_moved: boxes of the colour camera"));
}

TEST_F(CameraFaults, AThermalCameraThatIsTurnedByTwoDegrees) {
  const EyesOutcome out = hold(Ill::kNot, Ill::kTurned);
  EXPECT_NEAR(out.thermal_offset.value_or(0), kTwoDegrees, 0.01);
  EXPECT_TRUE(out.has_event("camera_moved: boxes of the thermal camera"));
}

}  // namespace
}  // namespace cairn::faults
