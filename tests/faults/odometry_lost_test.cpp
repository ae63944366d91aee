// SPDX-License-Identifier: Apache-2.0
// A fault that only the whole program shows: from the scans through odometry to the mode.
#include <gtest/gtest.h>

#include <algorithm>

#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "onboard/app/run.hpp"
#include "tests/faults/campaign.hpp"
#include "tests/support/box_world.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::faults {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr int kScans = 20, kFirstStrange = 8, kStrange = 3;

support::World room() {
  support::World world;
  world.box({-4, -3, 0}, {6, 4, 3}).box({2, 2, 0}, {3, 3, 1.5}).box({-2, -2.5, 0}, {-1, -1.5, 1});
  return world;
}

/// What a covered sensor sees: walls within arm's reach.
support::World crate() {
  support::World world;
  world.box({-1.1, -0.9, -0.2}, {1.3, 1, 1.5});
  return world;
}

SE3 path(double t) { return SE3::from_xyz_rpy((Vector6() << 0.4 * t, 0, 0, 0, 0, 0.05 * t).finished()); }

/// Arrivals of the scans.
std::vector<Time> record(const fs::path& folder) {
  recording::Recording index;
  index.robot = "husky_1";
  const Vector6 mount = (Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished();
  index.sources.push_back({"lidar", recording::kScans, "data.csv", "lidar", "VLP-16", mount});
  auto writer = recording::RecordingWriter::create(folder / "recording", index).value();
  support::Vlp16 lidar(SE3::from_xyz_rpy(mount), 0.02, 1);
  const support::World here = room(), there = crate();
  std::vector<Time> arrivals;
  for (int i = 0; i < kScans; ++i) {
    const bool strange = i >= kFirstStrange && i < kFirstStrange + kStrange;
    const Scan scan = lidar.scan(strange ? there : here, path, 0.1 * i);
    Packet packet;
    packet.channel = static_cast<std::uint16_t>(recording::ScanLayout::kXyziOffset);
    packet.arrival = scan.valid.end;
    packet.bytes = recording::encode_scan(scan.cloud, true);
    arrivals.push_back(packet.arrival);
    if (!writer.write(packet)) return {};
  }
  if (!writer.close()) return {};
  return arrivals;
}

Result<std::unique_ptr<app::RunResult>> replay(const fs::path& folder, app::Pace pace) {
  app::RunOptions options;
  options.recording = folder / "recording";
  options.out = folder / "out";
  options.pace = pace;
  return app::run(options);
}

const Event* find(const Monitor& monitor, std::string_view what) {
  const auto& events = monitor.events();
  const auto it = std::find_if(events.begin(), events.end(), [&](const Event& e) { return e.what == what; });
  return it != events.end() ? &*it : nullptr;
}

Measured covered() {
  const support::TemporaryFolder folder;
  const auto arrivals = record(folder.path());
  const auto result = replay(folder.path(), app::Pace::kMaximum);
  Measured m;
  if (!result || arrivals.empty()) return m.held = false, m;
  const Monitor& monitor = (*result)->monitor;
  const Event *lost = find(monitor, "fault: odometry_lost"), *ended = find(monitor, "ended: odometry_lost");
  if (find(monitor, "mode: degraded") != nullptr) m.worst = safety::Mode::kDegraded;
  if (find(monitor, "mode: hold") != nullptr) m.worst = safety::Mode::kHold;
  if (lost != nullptr) m.detect = lost->first - arrivals[kFirstStrange];
  if (ended != nullptr) m.recover = ended->last - arrivals[kFirstStrange + kStrange];
  m.held = lost != nullptr && lost->count == 1 && (*result)->report.mode == "normal" &&
           (*result)->report.odometry.lost_scans == kStrange;
  return m;
}

/// What the safety task said, and when.
std::vector<std::pair<Time, std::string>> said(const Monitor& monitor) {
  std::vector<std::pair<Time, std::string>> all;
  for (const Event& e : monitor.events())
    if (e.stage == "safety") all.emplace_back(e.first, e.what), all.emplace_back(e.last, e.what);
  return all;
}

TEST(OdometryLost, ReachesTheModeAtTheSameTickOnOneThreadAndOnManyAtRealSpeed) {
  const support::TemporaryFolder folder;
  record(folder.path());
  const auto once = replay(folder.path(), app::Pace::kMaximum), again = replay(folder.path(), app::Pace::kRecorded);
  ASSERT_TRUE(once && again);
  EXPECT_EQ(said((*once)->monitor).size(), 8U) << "lost, degraded, found, normal";
  EXPECT_EQ(said((*again)->monitor), said((*once)->monitor));
}

}  // namespace

std::vector<Row> odometry_rows() {
  return {{"L18", "sensor covered: three scans do not fit",
           "Degraded. The three scans do not go into the map. Normal with the first scan that fits.", 250ms, 250ms,
           safety::Mode::kDegraded, "", covered}};
}

}  // namespace cairn::faults
