// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/simulate/simulate_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/cli/run_command.hpp"

namespace cairn::cli {
namespace {

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
