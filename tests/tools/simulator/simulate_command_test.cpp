// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/simulate/simulate_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/cli/run_command.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

Outcome simulate(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "simulate");
  return run(add_simulate_command, std::move(arguments));
}

TEST(SimulateCommand, WrongScenesAreRefusedWithTheListOfScenes) {
  const Outcome outcome = simulate({"--scene", "moon", "--out", "/nowhere"});
  EXPECT_EQ(outcome.exit_code, app::kWrongArguments);
  for (const char* scene : {"corridor", "lobby", "office", "carpark", "forest"})
    EXPECT_THAT(outcome.err, ::testing::HasSubstr(scene));
}

TEST(SimulateCommand, WrongNumbersAndMissingOptionsAreRefused) {
  EXPECT_EQ(simulate({"--scene", "office"}).exit_code, app::kWrongArguments);
  for (const char* option :
       {"--robots=0", "--robots=17", "--seconds=0", "--seconds=x", "--threads=0", "--people=-3", "--motion=wild"})
    EXPECT_EQ(simulate({"--scene=office", "--out=/nowhere", option}).exit_code, app::kWrongArguments) << option;
}

Outcome with(const std::string& option, std::vector<std::string> more) {
  more.insert(more.begin(), {"--scene=corridor", "--seconds=0.1", "--out=/proc/nowhere", option});
  return simulate(std::move(more));
}

TEST(SimulateCommand, OptionsOfSensorsThatAreNotSimulatedAreRefused) {
  struct Row {
    const char* option;
    const char* sensors;  // those that the refusal names
    const char* with;     // with this one it goes
  };
  for (const auto& [option, sensors, one] :
       {Row{"--range-noise=0.1", "lidar", "lidar"}, Row{"--dropout=0.1", "lidar", "lidar"},
        Row{"--pps", "lidar", "lidar"}, Row{"--camera-rate=5", "camera or gpio", "camera"},
        Row{"--camera-rate=5", "camera or gpio", "gpio"}, Row{"--separate-eyes", "camera", "camera"},
        Row{"--camera-noise=2", "camera", "camera"}, Row{"--exposure=1", "camera", "camera"},
        Row{"--exposure-error=1", "camera", "camera"}, Row{"--line-time=1e-5", "camera", "camera"},
        Row{"--thermal-rate=5", "thermal", "thermal"}, Row{"--night", "camera or thermal", "camera"},
        Row{"--night", "camera or thermal", "thermal"}}) {
    const Outcome refused = with(option, {"--sensors=depth,drive"});
    EXPECT_EQ(refused.exit_code, app::kWrongArguments) << option;
    EXPECT_THAT(refused.err, HasSubstr("add " + std::string(sensors) + " to --sensors")) << option;
    const Outcome taken = with(option, {"--sensors=" + std::string(one)});
    EXPECT_THAT(taken.err, HasSubstr("/proc/nowhere")) << option << " fails later, at its folder";
    EXPECT_EQ(taken.exit_code, app::kFailed) << option;
  }
  EXPECT_THAT(with("--satellites=3", {"--pps", "--sensors=camera"}).err, HasSubstr("lidar"));
  EXPECT_EQ(with("--camera-rate=5", {}).exit_code, app::kWrongArguments) << "the default is the LiDAR alone";
}

TEST(SimulateCommand, OptionsOfPeopleAndHuskiesNeedThem) {
  EXPECT_THAT(with("--people-pause=3", {}).err, HasSubstr("--people"));
  EXPECT_EQ(with("--people-pause=3", {}).exit_code, app::kWrongArguments);
  EXPECT_EQ(with("--people-pause=3", {"--people=2"}).exit_code, app::kFailed);
  EXPECT_EQ(with("--motion=brisk", {}).exit_code, app::kFailed);
  for (const char* option : {"--motion=brisk", "--dropout=0.1", "--thermal-rate=5"}) {
    const Outcome refused = with(option, {"--profile=uav"});
    EXPECT_EQ(refused.exit_code, app::kWrongArguments) << option;
    EXPECT_THAT(refused.err, HasSubstr("leave the option out")) << option;
  }
  EXPECT_EQ(with("--camera-rate=5", {"--profile=uav", "--night"}).exit_code, app::kFailed);
}

TEST(SimulateCommand, PrintsOneJsonObject) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  const Outcome outcome = simulate({"--scene=corridor", "--seconds=0.2", "--out", out, "--json"});
  ASSERT_EQ(outcome.exit_code, app::kDone) << outcome.err;
  const auto object = outcome.json();
  EXPECT_EQ(object["scene"], "corridor");
  ASSERT_EQ(object["robots"].size(), 1u);
  EXPECT_EQ(object["robots"][0]["recording"], out + "/robot_1");
  EXPECT_GT(object["robots"][0]["returns"], 10000);
  EXPECT_EQ(simulate({"--scene=corridor", "--seconds=0.2", "--out", out}).exit_code, app::kFailed);
}

}  // namespace
}  // namespace cairn::cli
