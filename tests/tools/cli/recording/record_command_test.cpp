// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/recording/record_command.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "drivers/recording/formats/recording.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "tests/support/own_address.hpp"
#include "tests/tools/cli/run_command.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

Outcome record(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "record");
  return run(add_record_command, std::move(arguments));
}

constexpr int kDataPort = 22368, kPositionPort = 28308;

/// A profile that listens where nobody sends.
std::string quiet_profile(const TemporaryFolder& folder) {
  std::ofstream(folder / "robot.yaml") << "name: husky_7\nlidar:\n  model: HDL-32E\n  bind_address: "
                                       << support::own_address() << "\n  data_port: " << kDataPort
                                       << "\n  position_port: " << kPositionPort
                                       << "\n  T_base_lidar: [0.1, 0, 0.7, 0, 0, 1.5]\n";
  return folder / "robot.yaml";
}

TEST(RecordCommand, SilenceIsAFailureThatNamesItsRemedy) {
  const TemporaryFolder folder;
  const Outcome o = record({"--config", quiet_profile(folder), "--out", folder / "r", "--seconds", "0.1", "--json"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("check cable"));
  EXPECT_EQ(o.json()["packets"], 0);
  const auto r = recording::load_recording(folder / "r");
  ASSERT_TRUE(r) << to_string(r.error());
  EXPECT_EQ(r->robot, "husky_7");
  EXPECT_EQ(r->profile, "robot.yaml");
  EXPECT_EQ(r->sources[0].model, "HDL-32E");
  EXPECT_EQ(r->sources[0].data_port, kDataPort);
  EXPECT_EQ(r->sources[0].position_port, kPositionPort);
  EXPECT_EQ((*r->sources[0].base_sensor_xyz_rpy)[5], 1.5);
  EXPECT_GT(r->start_utc_ns, 1'700'000'000'000'000'000);
  EXPECT_THAT(r->notes, HasSubstr("kernel_drops"));
  const auto profile = app::load_profile(folder / "r/profile.yaml");
  ASSERT_TRUE(profile) << to_string(profile.error());
  EXPECT_EQ(profile->lidar.driver.model, "HDL-32E");
}

TEST(RecordCommand, SaysInATableWhatCameInAndKeepsAnOldRecording) {
  const TemporaryFolder folder;
  const std::vector<std::string> arguments{"--config",   quiet_profile(folder), "--out",
                                           folder / "r", "--seconds",           "0.05"};
  const std::string table = record(arguments).out;
  EXPECT_THAT(table, HasSubstr("  sensor        packets         MB    dropped"));
  EXPECT_THAT(table, HasSubstr("  lidar               0        0.0          0"));
  EXPECT_THAT(record(arguments).err, HasSubstr("there is a recording already"));
}

TEST(RecordCommand, OverwritingWithASilentSensorLeavesNoOldBytes) {
  const TemporaryFolder folder;
  const std::vector<std::string> arguments{"--config", quiet_profile(folder), "--out", folder / "r", "--seconds",
                                           "0.05",     "--overwrite"};
  (void)record(arguments);
  std::ofstream(folder / "r/lidar.pcap", std::ios::app) << std::string(2000, 'x');
  std::ofstream(folder / "r/schedule.log") << "of the old one";
  EXPECT_EQ(record(arguments).exit_code, app::kFailed);
  EXPECT_LT(std::filesystem::file_size(folder / "r/lidar.pcap"), 100U) << "a header alone";
  EXPECT_FALSE(std::filesystem::exists(folder / "r/schedule.log"));
  EXPECT_FALSE(std::filesystem::exists(folder / "r.unfinished"));
}

TEST(RecordCommand, ABoardNeedsACamera) {
  const TemporaryFolder folder;
  const Outcome o = record({"--config", quiet_profile(folder), "--out", folder / "r", "--board", "9x6"});
  EXPECT_EQ(o.exit_code, app::kWrongArguments);
  EXPECT_THAT(o.err, HasSubstr("camera.capture.device"));
  EXPECT_FALSE(std::filesystem::exists(folder / "r"));
  const Outcome bare = record({"--config", quiet_profile(folder), "--out", folder / "r", "--inverted"});
  EXPECT_EQ(bare.exit_code, app::kWrongArguments);
  EXPECT_THAT(bare.err, HasSubstr("--board"));
}

TEST(RecordCommand, AFaultyProfileIsAWrongArgument) {
  const TemporaryFolder folder;
  std::ofstream(folder / "robot.yaml") << "lidar: {modle: VLP-16}\n";
  const Outcome o = record({"--config", folder / "robot.yaml", "--out", folder / "r", "--seconds", "0.1"});
  EXPECT_EQ(o.exit_code, app::kWrongArguments);
  EXPECT_THAT(o.err, HasSubstr("lidar.modle"));
  EXPECT_FALSE(std::filesystem::exists(folder / "r"));
}

}  // namespace
}  // namespace cairn::cli
