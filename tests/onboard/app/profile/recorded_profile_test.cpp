// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/profile/recorded_profile.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "drivers/recording/recording_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Vector6 kRecordedMount = (Vector6() << 0.1, 0, 0.5, 0, 0, 0).finished();

struct RecordedProfileTest : ::testing::Test {
  fs::path record(recording::SensorKind kind, const char* file) {
    recording::Recording index;
    index.robot = "husky_1";
    index.sources.push_back({"lidar", kind, file, "lidar", "VLP-16", kRecordedMount});
    auto writer = recording::RecordingWriter::create(folder / "r", index);
    EXPECT_TRUE(writer && writer->close());
    return folder / "r";
  }
  fs::path velodyne() { return record(recording::kVelodyne, "lidar.pcap"); }
  fs::path config(const std::string& yaml) {
    std::ofstream(folder / "config.yaml") << yaml;
    return folder / "config.yaml";
  }
  static ChosenProfile choose(const fs::path& config, const fs::path& recording) {
    auto chosen = choose_profile(config, recording);
    EXPECT_TRUE(chosen) << to_string(chosen.error());
    return chosen ? std::move(*chosen) : ChosenProfile();
  }
  support::TemporaryFolder folder;
};

TEST_F(RecordedProfileTest, ARecordingsOwnProfileIsUsedWithoutAnother) {
  const fs::path recording = velodyne();
  EXPECT_TRUE(choose({}, recording).file.empty()) << "it keeps none yet";
  RobotProfile made_with;
  made_with.mapping.resolution_m = 0.2;
  ASSERT_TRUE(keep_profile(recording, made_with));
  const ChosenProfile chosen = choose({}, recording);
  EXPECT_EQ(chosen.file, recording / "profile.yaml");
  EXPECT_EQ(chosen.profile.mapping.resolution_m, 0.2);
  EXPECT_EQ(chosen.profile.lidar.base_xyz_rpy[2], 0.5) << "as the index says";
  EXPECT_THAT(chosen.notes, IsEmpty());
}

TEST_F(RecordedProfileTest, AGivenProfileWinsAndWhatDiffersIsNamed) {
  const fs::path recording = velodyne();
  RobotProfile made_with;
  made_with.lidar.base_xyz_rpy = {0.1, 0, 0.5, 0, 0, 0};
  made_with.name = "husky_1";
  made_with.threads = 4;
  ASSERT_TRUE(keep_profile(recording, made_with));
  EXPECT_THAT(choose(config("name: other\nthreads: 2\n"), recording).notes, IsEmpty()) << "these change no result";
  const ChosenProfile chosen = choose(config("mapping: {resolution_m: 0.3}\nteam: {submap_m: 50}\n"), recording);
  EXPECT_EQ(chosen.profile.mapping.resolution_m, 0.3);
  EXPECT_THAT(chosen.notes,
              ElementsAre("the recording's own profile has other values of: mapping.resolution_m, team.submap_m"));
}

TEST_F(RecordedProfileTest, TheMountOfAGivenProfileWinsWhereItSaysOne) {
  const fs::path recording = velodyne();
  const ChosenProfile silent = choose(config("name: a\n"), recording);
  EXPECT_EQ(silent.profile.lidar.base_xyz_rpy[2], 0.5);
  EXPECT_THAT(silent.notes, IsEmpty());
  const ChosenProfile said = choose(config("lidar: {T_base_lidar: [0, 0, 0.9, 0, 0, 0]}\n"), recording);
  EXPECT_EQ(said.profile.lidar.base_xyz_rpy[2], 0.9);
  EXPECT_THAT(said.notes, ElementsAre("the recording has other values of: lidar.T_base_lidar"));
}

TEST_F(RecordedProfileTest, WhatTheRecordingKnowsBetterIsNotUsedAndSaid) {
  const fs::path sweeps = record(recording::kScans, "data.csv");
  const ChosenProfile mount = choose(config("lidar: {T_base_lidar: [0, 0, 0.9, 0, 0, 0]}\n"), sweeps);
  EXPECT_EQ(mount.profile.lidar.base_xyz_rpy[2], 0.5);
  EXPECT_THAT(mount.notes,
              ElementsAre("the recording's values replace these settings of the profile: lidar.T_base_lidar"));
  fs::remove_all(sweeps);
  const ChosenProfile model = choose(config("lidar: {model: HDL-32E, data_port: 2370}\n"), velodyne());
  EXPECT_EQ(model.profile.lidar.driver.model, "VLP-16");
  EXPECT_THAT(
      model.notes,
      ElementsAre("the recording's values replace these settings of the profile: lidar.model, lidar.data_port"));
}

TEST_F(RecordedProfileTest, AFaultyOwnProfileNamesItsRemedyAndIsOfNoInterestBesideAnother) {
  const fs::path recording = velodyne();
  std::ofstream(recording / "profile.yaml") << "mapping: {edge_m: 1}\n";
  const auto refused = choose_profile({}, recording);
  ASSERT_FALSE(refused);
  EXPECT_THAT(to_string(refused.error()), HasSubstr("profile.yaml:1: mapping.edge_m"));
  EXPECT_THAT(to_string(refused.error()), HasSubstr("name another with --config"));
  EXPECT_THAT(choose(config("name: a\n"), recording).notes, IsEmpty());
}

TEST_F(RecordedProfileTest, WithoutARecordingItIsTheGivenOneOrTheDefaults) {
  EXPECT_EQ(choose(config("name: a\n"), {}).profile.name, "a");
  EXPECT_EQ(to_yaml(choose({}, {}).profile), to_yaml(RobotProfile()));
  EXPECT_FALSE(choose_profile({}, folder / "nowhere"));
}

TEST(DifferingKeys, AreNamedWithTheirGroups) {
  RobotProfile a, b;
  EXPECT_THAT(differing_keys(a, b), IsEmpty());
  b.name = "b: #";
  b.schedule.mapping.soft_ms = 12;
  b.lidar.base_xyz_rpy[1] = 1;
  EXPECT_THAT(differing_keys(a, b), ElementsAre("name", "lidar.T_base_lidar", "schedule.mapping.soft_ms"));
}

}  // namespace
}  // namespace cairn::app
