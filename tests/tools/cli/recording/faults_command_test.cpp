// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/recording/faults_command.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "drivers/recording/recording_reader.hpp"
#include "tests/tools/cli/run_command.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

Outcome faults(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "faults");
  return run(add_faults_command, std::move(arguments));
}

/// A bus with 1000 frames and a line with one edge.
void write_recording(const std::string& dir) {
  std::filesystem::create_directories(dir);
  std::ofstream(dir + "/recording.yaml")
      << "robot: husky\nprofile: \"\"\nstart_utc: 1970-01-01T00:00:01.000000000Z\nrealtime_offset_ns: 0\nnotes: "
         "\"\"\nsources:\n"
         "  - {id: drive, kind: drive, file: drive.log, frame: base_link, model: cia402}\n"
         "  - {id: gpio, kind: gpio, file: gpio.csv, frame: base_link, model: \"\"}\n";
  std::ofstream drive(dir + "/drive.log");
  for (int i = 0; i < 1000; ++i) drive << "(" << 1 + i / 100 << "." << 100000 + i % 100 * 1000 << ") can0 181#0102\n";
  std::ofstream(dir + "/gpio.csv") << "stamp_ns,line,level\n5000000000,estop,0\n";
  std::ofstream(dir + "/ground_truth.tum") << "0 0 0 0 0 0 0 1\n";
  std::ofstream(dir + "/profile.yaml") << "drive: {interface: can0}\n";
}

std::uint64_t packets_in(const std::string& dir) {
  auto reader = recording::RecordingReader::open(dir).value();
  Packet packet;
  std::uint64_t packets = 0;
  for (auto poll = reader->next(packet, {}); !poll || *poll != Poll::kEnd; poll = reader->next(packet, {}))
    packets += poll && *poll == Poll::kPacket ? 1 : 0;
  return packets;
}

TEST(FaultsCommand, LeavesARecordingWithTheFaultsThatWereAskedFor) {
  const TemporaryFolder folder;
  write_recording(folder / "good");
  const Outcome o = faults({folder / "good", "--out", folder / "bad", "--source", "drive", "--drop", "0.5", "--json"});
  ASSERT_EQ(o.exit_code, app::kDone) << o.err;
  const auto json = o.json();
  EXPECT_EQ(json["packets"], 1001);
  EXPECT_NEAR(json["dropped"].get<double>(), 500, 60);
  EXPECT_EQ(packets_in(folder / "bad"), json["written"].get<std::uint64_t>());
  EXPECT_EQ(json["written"].get<int>() + json["dropped"].get<int>(), 1001);
  EXPECT_TRUE(std::filesystem::exists(folder / "bad/ground_truth.tum"));
  EXPECT_TRUE(std::filesystem::exists(folder / "bad/profile.yaml"));
}

TEST(FaultsCommand, WithoutFaultsItCopies) {
  const TemporaryFolder folder;
  write_recording(folder / "good");
  ASSERT_EQ(faults({folder / "good", "--out", folder / "copy"}).exit_code, app::kDone);
  EXPECT_EQ(packets_in(folder / "copy"), 1001U);
}

TEST(FaultsCommand, WrongSourcesAndFoldersAreNamed) {
  const TemporaryFolder folder;
  write_recording(folder / "good");
  const Outcome o = faults({folder / "good", "--out", folder / "bad", "--source", "lidar", "--drop", "0.5"});
  EXPECT_EQ(o.exit_code, app::kWrongArguments);
  EXPECT_THAT(o.err, HasSubstr("it has drive, gpio"));
  EXPECT_EQ(faults({folder / "nothing", "--out", folder / "bad"}).exit_code, app::kFailed);
  ASSERT_EQ(faults({folder / "good", "--out", folder / "bad"}).exit_code, app::kDone);
  EXPECT_EQ(faults({folder / "good", "--out", folder / "bad"}).exit_code, app::kFailed) << "an old recording is kept";
}

TEST(FaultsCommand, AnOutputThatWouldReplaceItsInputIsRefused) {
  const TemporaryFolder folder;
  write_recording(folder / "good");
  std::filesystem::create_directory_symlink(folder / "good", folder / "link");
  for (const std::string out :
       {folder / "good", folder / "good/", folder / "link", folder / "good/inner", folder.path()}) {
    const Outcome o = faults({folder / "good", "--out", out, "--overwrite"});
    EXPECT_EQ(o.exit_code, app::kWrongArguments) << out;
    EXPECT_THAT(o.err, HasSubstr("would replace its own input"));
  }
  EXPECT_EQ(packets_in(folder / "good"), 1001U);
  EXPECT_TRUE(std::filesystem::exists(folder / "good/ground_truth.tum"));
}

TEST(FaultsCommand, AClosedCopyOfAnUnfinishedRecording) {
  const TemporaryFolder folder;
  write_recording(folder / "good.unfinished");
  std::ofstream(folder / "good.unfinished/recording.yaml", std::ios::app) << "unfinished: true\n";
  ASSERT_EQ(faults({folder / "good.unfinished", "--out", folder / "good"}).exit_code, app::kDone);
  EXPECT_FALSE(recording::load_recording(folder / "good")->unfinished);
  EXPECT_EQ(packets_in(folder / "good.unfinished"), 1001U) << "the source stays, whatever its name";
}

TEST(FaultsCommand, ListsWhatCountsAsAFault) {
  const Outcome o = faults({"list"});
  EXPECT_EQ(o.exit_code, app::kDone);
  EXPECT_THAT(o.out, HasSubstr("lidar_silent"));
  const auto json = faults({"list", "--json"}).json();
  EXPECT_EQ(json["faults"].size(), 27U);
  EXPECT_EQ(json["faults"][16]["least"], "stop");
}

TEST(FaultsCommand, OptionsThatWouldChangeNothingAreRefused) {
  const TemporaryFolder folder;
  write_recording(folder / "good");
  struct Row {
    std::string option, value, needed;
    const char* that;
  };
  for (const Row& row : {Row{"--spell", "stuck", "--freeze", "1"}, Row{"--period", "3", "--freeze", "1"},
                         Row{"--delay-by", "0.1", "--delay", "0.5"}, Row{"--shift-after", "1", "--shift", "2"},
                         Row{"--source", "drive", "--drop", "0.5"}, Row{"--seed", "2", "--flip", "0.5"}}) {
    const Outcome alone = faults({folder / "good", "--out", folder / "bad", row.option, row.value});
    EXPECT_EQ(alone.exit_code, app::kWrongArguments) << row.option;
    EXPECT_THAT(alone.err, HasSubstr(row.option));
    const Outcome with =
        faults({folder / "good", "--out", folder / "bad", "--overwrite", row.option, row.value, row.needed, row.that});
    EXPECT_EQ(with.exit_code, app::kDone) << row.option << ": " << with.err;
  }
}

TEST(FaultsCommand, TheListTakesNoOptionOfARecording) {
  for (const std::vector<std::string>& option :
       {std::vector<std::string>{"--drop", "0.1"}, {"--out", "x"}, {"--overwrite"}, {"--seed", "3"}}) {
    std::vector<std::string> arguments{"list"};
    arguments.insert(arguments.end(), option.begin(), option.end());
    const Outcome o = faults(arguments);
    EXPECT_EQ(o.exit_code, app::kWrongArguments) << option[0];
    EXPECT_THAT(o.err, HasSubstr(option[0] + ": would change nothing"));
  }
}

TEST(FaultsCommand, WithoutAPlaceForTheResultItSaysSo) {
  EXPECT_EQ(faults({"somewhere"}).exit_code, app::kWrongArguments);
}

}  // namespace
}  // namespace cairn::cli
