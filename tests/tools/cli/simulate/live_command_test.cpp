// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "tests/support/own_address.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/simulate/simulate_command.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

Outcome live(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"simulate", "--live", "--scene=corridor"});
  return run(add_simulate_command, std::move(arguments));
}

TEST(LiveCommand, OptionsOfRecordingsAreRefusedWithARemedy) {
  for (const char* option : {"--out=x", "--robots=2", "--people=1", "--night", "--profile=uav", "--motion=brisk",
                             "--sensors=all", "--threads=2", "--name=uav"}) {
    const Outcome outcome = live({option});
    EXPECT_EQ(outcome.exit_code, app::kWrongArguments) << option;
    EXPECT_THAT(outcome.err, HasSubstr("does not go with --live")) << option;
  }
}

TEST(LiveCommand, ItsOwnOptionsNeedIt) {
  for (const char* option :
       {"--to=1.2.3.4", "--can=vcan0", "--estop=x", "--start=1,2,0", "--truth=x", "--profile-out=x"}) {
    const Outcome outcome = run(add_simulate_command, {"simulate", "--scene=corridor", "--out=/nowhere", option});
    EXPECT_EQ(outcome.exit_code, app::kWrongArguments) << option;
    EXPECT_THAT(outcome.err, HasSubstr("add --live")) << option;
  }
}

TEST(LiveCommand, SenselessValuesAreRefused) {
  for (const char* option :
       {"--to=127.0.0.1:", "--to=127.0.0.1:99999", "--to=robot:2368", "--start=1,2", "--start=a,b,c", "--start=1,2,90",
        "--start=nan,0,0", "--start=-900,0,0", "--can=unix:", "--seconds=0"}) {
    const Outcome outcome = live({option, "--seconds=0.01"});
    EXPECT_EQ(outcome.exit_code, app::kWrongArguments) << option << ": " << outcome.err;
    EXPECT_FALSE(outcome.err.empty()) << option;
  }
}

TEST(LiveCommand, PlaysForItsSecondsAndSaysWhatItDid) {
  const TemporaryFolder folder;
  const Outcome outcome =
      live({"--seconds=0.1", "--json", "--to=" + support::own_address() + ":22468",
            "--can=unix:" + (folder / "can").string(), "--estop=" + (folder / "estop").string(),
            "--truth=" + (folder / "truth.tum").string(), "--profile-out=" + (folder / "robot.yaml").string()});
  ASSERT_EQ(outcome.exit_code, app::kDone) << outcome.err;
  const auto object = outcome.json();
  EXPECT_EQ(object["scene"], "corridor");
  EXPECT_GE(object["seconds"], 0.1);
  EXPECT_EQ(object["contacts"], 0);
  EXPECT_GT(object["data_packets"].get<int>() + object["left_out_packets"].get<int>(), 60);
  EXPECT_GE(recording::read_tum(folder / "truth.tum").value().size(), 10U);
  EXPECT_TRUE(std::filesystem::exists(folder / "robot.yaml"));
}

}  // namespace
}  // namespace cairn::cli
