// SPDX-License-Identifier: Apache-2.0
// What a run on a recording says of itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "onboard/app/run.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/notes/notes.hpp"
#include "tests/onboard/app/scan_recording.hpp"
#include "tests/support/map_pairs.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

using ::testing::HasSubstr;

const Vector6 kMountInTheDark = (Vector6() << 0.2, 0, 0.6, 0, 0, 0.1).finished();

/// The robot is carried away in the dark: nothing says how the second place lies to the first.
TEST(RunNotes, NameAMapThatWasSplit) {
  const support::TemporaryFolder folder;
  ScanRecording recording(folder / "two_places", kMountInTheDark);
  support::Vlp16 lidar(SE3::from_xyz_rpy(kMountInTheDark), 0.02, 1);
  support::World first;
  first.box({-4, -3, 0}, {6, 4, 3}).box({2, 2, 0}, {3, 3, 1.5}).box({-2, -2.5, 0}, {-1, -1.5, 1});
  const support::Scene second = support::corridor();
  const SE3 here, there = support::pose_on(second.ride, 0);
  constexpr int kFirst = 6, kSecond = 24;
  for (int i = 0; i < kFirst + kSecond; ++i) {
    const bool carried = i >= kFirst;
    const Scan scan = lidar.scan(
        carried ? second.world : first, [&](double) { return carried ? there : here; }, 0.1 * i + (carried ? 8 : 0));
    recording.add(scan);
  }
  recording.close();
  RunOptions o;
  o.recording = folder / "two_places";
  o.out = folder / "split";
  o.pace = Pace::kMaximum;
  const auto result = run(o);
  ASSERT_TRUE(result) << to_string(result.error());
  const report::RunReport& report = (*result)->report;
  ASSERT_EQ(report.earlier_maps.size(), 1U);
  EXPECT_TRUE(mapping::load_map(folder / "split" / report.earlier_maps[0]));
  EXPECT_GT(report.odometry.lost_s, 0.1);
  std::string notes;
  for (const report::Note& note : report::notes_of(report)) notes += note.text;
  EXPECT_THAT(notes, HasSubstr("The map was split into 2 parts"));
  EXPECT_THAT(notes, HasSubstr("Odometry was lost for"));
}

}  // namespace
}  // namespace cairn::app
