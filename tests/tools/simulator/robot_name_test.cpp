// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "drivers/recording/formats/recording.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/simulate.hpp"

namespace cairn::simulator {
namespace {

TEST(RobotName, IsWhatTheUserSays) {
  const support::TemporaryFolder folder;
  SimulationConfig c;
  c.scene = "corridor";
  c.seconds = 0.3;
  c.out = folder / "named";
  c.name = "uav";
  const auto robots = simulate(c);
  ASSERT_TRUE(robots) << to_string(robots.error());
  EXPECT_EQ(robots->front().name, "uav_1");
  const auto kept = recording::load_recording(c.out / "uav_1");
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->robot, "uav_1");
}

TEST(RobotName, ThatIsNoFolderIsRefused) {
  const support::TemporaryFolder folder;
  SimulationConfig c;
  c.out = folder / "refused";
  for (const char* name : {"", "a b", "../x", ".", "ä"}) {
    c.name = name;
    EXPECT_EQ(simulate(c).error().code, Errc::kInvalidConfig) << name;
  }
}

}  // namespace
}  // namespace cairn::simulator
