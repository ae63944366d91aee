// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/door/fitted.hpp"

#include <gtest/gtest.h>

namespace cairn::app {
namespace {

safety::Fitted with(recording::SensorKind kind, const RobotProfile& profile = {}) {
  std::vector<recording::SourceEntry> sources(1);
  sources[0].kind = kind;
  return fitted_with(sources, profile);
}

RobotProfile driven() {
  RobotProfile profile;
  profile.drive.driver.interface = "can0";
  return profile;
}

bool watches(const safety::Fitted& fitted, safety::Watched what) {
  return fitted.watched[static_cast<std::size_t>(what)];
}

TEST(Fitted, EverySensorIsWatchedForSilence) {
  EXPECT_TRUE(watches(with(recording::kVelodyne), safety::Watched::kLidar));
  EXPECT_TRUE(watches(with(recording::kScans), safety::Watched::kLidar));
  EXPECT_TRUE(watches(with(recording::kCamera), safety::Watched::kCamera));
  EXPECT_TRUE(watches(with(recording::kThermal), safety::Watched::kThermal));
  EXPECT_TRUE(watches(with(recording::kDepth), safety::Watched::kDepth));
  EXPECT_TRUE(watches(with(recording::kDrive, driven()), safety::Watched::kFeedback));
  EXPECT_FALSE(watches(with(recording::kCamera), safety::Watched::kLidar));
}

TEST(Fitted, ADriveIsOneThatCanBeStopped) {
  EXPECT_TRUE(with(recording::kDrive, driven()).drive);
  EXPECT_FALSE(with(recording::kDrive).drive) << "of a recording whose profile is not known";
  EXPECT_FALSE(watches(with(recording::kDrive), safety::Watched::kFeedback));
  EXPECT_FALSE(with(recording::kVelodyne).drive);
}

TEST(Fitted, AnEStopCountsWhenTheProfileNamesItsLine) {
  EXPECT_FALSE(with(recording::kGpio).estop) << "the chip may serve the camera trigger alone";
  RobotProfile profile;
  profile.gpio.driver.estop_line = "estop";
  EXPECT_TRUE(with(recording::kGpio, profile).estop);
  EXPECT_FALSE(with(recording::kVelodyne, profile).estop);
}

}  // namespace
}  // namespace cairn::app
