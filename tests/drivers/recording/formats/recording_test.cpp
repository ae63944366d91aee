// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/recording.hpp"

#include <gmock/gmock.h>

#include "tests/drivers/recording/files.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;
using test::spit;
using test::TemporaryFolder;
using ::testing::HasSubstr;

Recording example() {
  Recording r;
  r.robot = "robot_1";
  r.profile = "husky";
  r.start_utc_ns = 1'763'753'489'123'456'789;
  r.realtime_offset_ns = 1'763'000'000'000'000'001;
  r.time_shift_ns = -5;
  r.notes = "two lines:\n\"quoted\" # not a comment, ümlaut\tand a tab";
  SourceEntry lidar{"lidar", kVelodyne, "lidar.pcap", "lidar", "VLP-16"};
  lidar.base_sensor_xyz_rpy = (Vector6() << 0.1, -0.2, 1.0 / 3.0, 0.01, -0.02, 3.0).finished();
  lidar.data_port = 2369;
  r.sources.push_back(lidar);
  SourceEntry scans{"sweeps", kScans, "data.csv", "base_link", ""};
  scans.deskewed = true;
  r.sources.push_back(scans);
  return r;
}

const char* const kMinimal =
    "robot: r\nstart_utc: 2026-01-31T12:00:00Z\nrealtime_offset_ns: 0\n"
    "sources:\n  - {id: lidar, kind: velodyne, file: lidar.pcap, frame: lidar}\n";

TEST(Recording, WrittenAndReadAgainIsTheSame) {
  const std::string text = to_yaml(example());
  const auto again = parse_recording(text, "recording.yaml");
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_EQ(to_yaml(*again), text);
  EXPECT_EQ(again->start_utc_ns, example().start_utc_ns);
  EXPECT_EQ(again->realtime_offset_ns, example().realtime_offset_ns);
  EXPECT_EQ(again->time_shift_ns, example().time_shift_ns);
  EXPECT_EQ(again->notes, example().notes);
  ASSERT_EQ(again->sources.size(), 2U);
  EXPECT_EQ(*again->sources[0].base_sensor_xyz_rpy, *example().sources[0].base_sensor_xyz_rpy);
  EXPECT_EQ(again->sources[0].data_port, 2369);
  EXPECT_TRUE(again->sources[1].deskewed);
}

TEST(Recording, UtcIsTimePlusOffset) { EXPECT_EQ(example().utc_ns(Time(Duration(9))), 1'763'000'000'000'000'010); }

TEST(Recording, KeysMayBeLeftOut) {
  const auto r = parse_recording(kMinimal, "f");
  ASSERT_TRUE(r) << to_string(r.error());
  EXPECT_EQ(r->sources[0].data_port, 2368);
  EXPECT_EQ(r->sources[0].position_port, 8308);
  EXPECT_FALSE(r->sources[0].base_sensor_xyz_rpy);
  EXPECT_EQ(r->sources[0].T_base_sensor().log().norm(), 0.0);
}

TEST(Recording, AllFaultsAreReportedWithFileAndLine) {
  const auto r = parse_recording(
      "robot: ../etc\n"
      "start_utc: yesterday\n"
      "realtime_offset_ns: 1.5\n"
      "colour: red\n"
      "robot: twice\n"
      "sources:\n"
      "  - id: a\n"
      "    kind: sonar\n"
      "    file: ../../etc/passwd\n"
      "    frame: lidar\n"
      "  - id: a\n"
      "    kind: scans\n"
      "    file: /etc/passwd\n"
      "    T_base_sensor: [1, 2, 3]\n"
      "    data_port: 0\n",
      "f");
  ASSERT_FALSE(r);
  EXPECT_EQ(r.error().code, Errc::kMalformed);
  for (const char* fault :
       {"f:1: robot: only letters", "f:2: start_utc: must be a time", "f:3: realtime_offset_ns: must be a whole",
        "f:4: colour: unknown key", "f:5: robot: this key appears twice",
        "f:8: sources[0].kind: must be velodyne, scans, camera, thermal, depth, drive, gpio, peers or commands",
        "f:9: sources[0].file: a file name must not hold `.` or `..`",
        "f:13: sources[1].file: a file must be named relative", "f:14: sources[1].T_base_sensor: must be [x,",
        "f:15: sources[1].data_port: must be a whole number 1 … 65535", "f:11: sources[1].frame: is missing",
        "f:11: sources[1].id: is taken"})
    EXPECT_THAT(r.error().detail, HasSubstr(fault));
}

TEST(Recording, BrokenYamlIsAFaultWithItsLine) {
  for (const char* text :
       {"", "- a list", "robot: [", "robot: r\n\tsources: x", "---\na: 1\n---\nb: 2\n", "&a [*a]", "{{}: 1}"}) {
    const auto r = parse_recording(text, "f");
    ASSERT_FALSE(r) << text;
    EXPECT_THAT(r.error().detail, HasSubstr("f:")) << text;
  }
}

TEST(Recording, CutOrDamagedAtEveryByteIsAnErrorOrARecording) {
  const std::string text = to_yaml(example());
  for (std::size_t n = 0; n < text.size(); ++n) {
    static_cast<void>(parse_recording(text.substr(0, n), "f"));
    std::string flipped = text;
    flipped[n] = static_cast<char>(flipped[n] ^ 0x15);
    const auto r = parse_recording(flipped, "f");
    if (r) {
      EXPECT_TRUE(parse_recording(to_yaml(*r), "g")) << n;
    }
  }
}

TEST(Recording, MissingFilesComeWithAllOtherFaults) {
  const TemporaryFolder folder;
  spit(folder / "recording.yaml", std::string(kMinimal) + "colour: red\n");
  const auto r = load_recording(folder.path());
  ASSERT_FALSE(r);
  EXPECT_THAT(r.error().detail, HasSubstr("recording.yaml:5: sources[0].file: " + (folder / "lidar.pcap").string()));
  EXPECT_THAT(r.error().detail, HasSubstr("recording.yaml:6: colour: unknown key"));
}

TEST(Recording, AFileBehindALinkOutOfTheFolderIsRefused) {
  const TemporaryFolder folder;
  spit(folder / "secret", "x");
  spit(folder / "rec/recording.yaml", kMinimal);
  fs::create_symlink(folder / "secret", folder / "rec/lidar.pcap");
  const auto outside = load_recording(folder / "rec");
  ASSERT_FALSE(outside);
  EXPECT_THAT(outside.error().detail, HasSubstr("lies outside"));
  fs::remove(folder / "rec/lidar.pcap");
  fs::create_directory(folder / "rec/lidar.pcap");
  EXPECT_FALSE(load_recording(folder / "rec"));
  fs::remove(folder / "rec/lidar.pcap");
  spit(folder / "rec/lidar.pcap", "");
  EXPECT_TRUE(load_recording(folder / "rec"));
}

TEST(Recording, NoFolderIsSaid) {
  const auto r = load_recording("/nonexistent/folder");
  ASSERT_FALSE(r);
  EXPECT_EQ(to_string(r.error()), "/nonexistent/folder: there is no such recording");
  EXPECT_EQ(r.error().code, Errc::kNotFound);
}

TEST(Recording, AFolderOfSomethingElseIsNamedAsItWasGiven) {
  const TemporaryFolder folder;
  const auto r = load_recording(folder.path());
  ASSERT_FALSE(r);
  EXPECT_EQ(r.error().where, folder.path());
  EXPECT_THAT(to_string(r.error()), HasSubstr("there is no recording.yaml: `cairn inspect "));
}

TEST(Recording, ACaptureIsNoRecordingButMakesOne) {
  const TemporaryFolder folder;
  std::ofstream(folder / "drive.pcap") << "x";
  std::ofstream(folder / "drive.log") << "x";
  EXPECT_THAT(to_string(load_recording(folder / "drive.pcap").error()), HasSubstr("cairn import velodyne-pcap"));
  EXPECT_THAT(to_string(load_recording(folder / "drive.log").error()), HasSubstr("a recording is a folder"));
}

TEST(Recording, WhatCouldNotBeReadIsNotWritten) {
  const TemporaryFolder folder;
  ASSERT_TRUE(save_recording(folder.path(), example()));
  Recording bad = example();
  bad.sources[1].file = "../data.csv";
  EXPECT_FALSE(save_recording(folder.path(), bad));
  bad = example();
  bad.start_utc_ns = -1;
  EXPECT_FALSE(save_recording(folder.path(), bad));
  EXPECT_EQ(test::slurp(folder / "recording.yaml"), to_yaml(example()));
}

TEST(Recording, PathsThatMayLeaveTheFolderAreFaults) {
  for (const char* good : {"lidar.pcap", "scans/000001.bin", "a/b/c", "..."})
    EXPECT_EQ(path_fault(good), nullptr) << good;
  for (const char* bad : {"", "/a", "..", "../a", "a/../b", "a/..", "./a", "a/./b", "a//", "a/", "a\nb", "a\\b", "a,b"})
    EXPECT_NE(path_fault(bad), nullptr) << bad;
}

}  // namespace
}  // namespace cairn::recording
