// SPDX-License-Identifier: Apache-2.0
// A small recording: a robot that drives through a room of which every range is known.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "onboard/app/run.hpp"
#include "tests/onboard/app/scan_recording.hpp"
#include "tests/support/box_world.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app::test {

namespace fs = std::filesystem;

inline constexpr int kScans = 8;
inline const Vector6 kMount = (Vector6() << 0.2, 0, 0.6, 0, 0, 0.1).finished();

inline SE3 path(double t) {
  const double yaw = 0.1 * t;
  return SE3::from_xyz_rpy((Vector6() << 0.8 * t, 0.1 * std::sin(t), 0, 0, 0, yaw).finished());
}

inline support::World room() {
  support::World world;
  world.box({-4, -3, 0}, {6, 4, 3}).box({2, 2, 0}, {3, 3, 1.5}).box({-2, -2.5, 0}, {-1, -1.5, 1});
  return world;
}

/// Sweeps of a robot that drives through the room, and with GPIO lines of which none ever changes.
inline void record_room(const fs::path& folder, bool with_gpio = false, const support::World& world = room(),
                        int scans = kScans) {
  ScanRecording recording(folder, kMount, with_gpio);
  support::Vlp16 lidar(SE3::from_xyz_rpy(kMount), 0.02, 1);
  for (int i = 0; i < scans; ++i) {
    recording.add(lidar.scan(world, path, 0.1 * i));
  }
  recording.close();
}

/// Runs on that recording. The folder is one for all tests of a suite.
class RoomRun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_.emplace();
    record_room(*folder_ / "recording");
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static RunOptions options(const std::string& out) {
    RunOptions o;
    o.recording = *folder_ / "recording";
    o.out = *folder_ / out;
    o.pace = Pace::kMaximum;
    return o;
  }
  static fs::path write(const std::string& name, const std::string& text) {
    std::ofstream(*folder_ / name) << text;
    return *folder_ / name;
  }
  static inline std::optional<support::TemporaryFolder> folder_;
};

}  // namespace cairn::app::test
