// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/recording/import_command.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "drivers/recording/formats/recording.hpp"
#include "tests/tools/cli/run_command.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

Outcome import(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "import");
  return run(add_import_command, std::move(arguments));
}

void write_cloud(const std::string& path) {
  std::ofstream(path) << "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n";
}

TEST(ImportCommand, SaysWhatItImported) {
  const TemporaryFolder folder;
  write_cloud(folder / "a.pcd");
  write_cloud(folder / "b.pcd");
  const Outcome text = import({"pcd-folder", folder.path(), "--out", folder / "r", "--robot", "uav"});
  EXPECT_EQ(text.exit_code, app::kDone) << text.err;
  EXPECT_THAT(text.out, HasSubstr("2 sweeps"));
  const auto recording = recording::load_recording(folder / "r");
  ASSERT_TRUE(recording);
  EXPECT_EQ(recording->robot, "uav");
}

TEST(ImportCommand, JsonIsOneObject) {
  const TemporaryFolder folder;
  write_cloud(folder / "a.pcd");
  std::ofstream(folder / "b.pcd") << "broken";
  const Outcome o = import({"pcd-folder", folder.path(), "--out", folder / "r", "--json", "--deskewed", "true"});
  EXPECT_EQ(o.exit_code, app::kDone);
  EXPECT_EQ(o.json()["items"], 1);
  EXPECT_EQ(o.json()["damaged"], 1);
  EXPECT_THAT(o.json()["damage"][0].get<std::string>(), HasSubstr("b.pcd"));
  EXPECT_TRUE(recording::load_recording(folder / "r")->sources[0].deskewed);
}

TEST(ImportCommand, ASecondImportMustBeToldToOverwrite) {
  const TemporaryFolder folder;
  write_cloud(folder / "a.pcd");
  const std::vector<std::string> arguments{"pcd-folder", folder.path(), "--out", folder / "r"};
  EXPECT_EQ(import(arguments).exit_code, app::kDone);
  const Outcome again = import(arguments);
  EXPECT_EQ(again.exit_code, app::kFailed);
  EXPECT_THAT(again.err, HasSubstr("there is a recording already"));
  auto told = arguments;
  told.emplace_back("--overwrite");
  EXPECT_EQ(import(told).exit_code, app::kDone);
}

TEST(ImportCommand, WhatCannotBeImportedLeavesTheOldRecordingAndNothingElse) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "in");
  write_cloud(folder / "in/a.pcd");
  ASSERT_EQ(import({"pcd-folder", folder / "in", "--out", folder / "r"}).exit_code, app::kDone);
  std::ofstream(folder / "in/a.pcd") << "broken";
  const Outcome o = import({"pcd-folder", folder / "in", "--out", folder / "r", "--overwrite"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_TRUE(recording::load_recording(folder / "r")) << "the old one";
  EXPECT_FALSE(std::filesystem::exists(folder / "r.unfinished"));
  EXPECT_EQ(import({"pcd-folder", folder / "in", "--out", folder / "new"}).exit_code, app::kFailed);
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));
}

TEST(ImportCommand, OptionsOfOtherKindsAreRefused) {
  const TemporaryFolder folder;
  write_cloud(folder / "a.pcd");
  for (const char* kind : {"pcd-folder", "kitti-raw", "kitti-odometry"})
    for (const char* option : {"--data-port=2368", "--position-port=8308"}) {
      const Outcome o = import({kind, folder.path(), "--out", folder / "r", option});
      EXPECT_EQ(o.exit_code, app::kWrongArguments) << kind << option;
      EXPECT_THAT(o.err, HasSubstr("would change nothing")) << kind << option;
    }
  for (const char* option : {"--rate=5", "--deskewed=true"}) {
    const Outcome capture = import({"velodyne-pcap", folder / "a.pcd", "--out", folder / "r", option});
    EXPECT_EQ(capture.exit_code, app::kWrongArguments) << option;
    EXPECT_THAT(capture.err, HasSubstr("leave the option out")) << option;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "r"));
  EXPECT_EQ(import({"pcd-folder", folder.path(), "--out", folder / "r", "--rate=5"}).exit_code, app::kDone);
}

TEST(ImportCommand, WrongArguments) {
  const TemporaryFolder folder;
  EXPECT_EQ(import({"tapes", folder.path(), "--out", folder / "r"}).exit_code, app::kWrongArguments);
  EXPECT_EQ(import({"pcd-folder", folder / "nothing", "--out", folder / "r"}).exit_code, app::kWrongArguments);
  EXPECT_EQ(import({"pcd-folder", folder.path(), "--out", folder / "r"}).exit_code, app::kFailed) << "no files";
}

}  // namespace
}  // namespace cairn::cli
