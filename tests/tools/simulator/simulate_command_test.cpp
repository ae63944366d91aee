// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/simulate_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

namespace cairn::cli {
namespace {

/// What main() does; the message of a refused command line goes to `message`.
int run(std::vector<std::string> arguments, std::string& message) {
  CLI::App app;
  Commands commands{app, {}};
  add_simulate_command(commands);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    message = error.what();
    return error.get_exit_code() == 0 ? kDone : kWrongArguments;
  }
  return commands.job();
}

TEST(SimulateCommand, WrongScenesAreRefusedWithTheListOfScenes) {
  std::string message;
  EXPECT_EQ(run({"simulate", "--scene", "moon", "--out", "/nowhere"}, message), kWrongArguments);
  for (const char* scene : {"corridor", "lobby", "office", "carpark", "forest"}) {
    EXPECT_THAT(message, ::testing::HasSubstr(scene));
  }
}

TEST(SimulateCommand, WrongNumbersAndMissingOptionsAreRefused) {
  std::string message;
  EXPECT_EQ(run({"simulate", "--scene", "office"}, message), kWrongArguments);
  for (const char* option : {"--robots=0", "--robots=17", "--seconds=0", "--seconds=x", "--threads=0", "--people=3"}) {
    EXPECT_EQ(run({"simulate", "--scene=office", "--out=/nowhere", option}, message), kWrongArguments) << option;
  }
}

TEST(SimulateCommand, PrintsOneJsonObject) {
  const auto dir = std::filesystem::path(::testing::TempDir()) / ("simulate_command" + std::to_string(getpid()));
  std::string message;
  ::testing::internal::CaptureStdout();
  const int code = run({"simulate", "--scene=corridor", "--seconds=0.2", "--out=" + dir.string(), "--json"}, message);
  const std::string text = ::testing::internal::GetCapturedStdout();
  ASSERT_EQ(code, kDone) << message;
  const auto object = nlohmann::json::parse(text);
  EXPECT_EQ(object["scene"], "corridor");
  ASSERT_EQ(object["robots"].size(), 1u);
  EXPECT_EQ(object["robots"][0]["recording"], (dir / "robot_1").string());
  EXPECT_GT(object["robots"][0]["returns"], 10000);
  EXPECT_EQ(run({"simulate", "--scene=corridor", "--seconds=0.2", "--out=" + dir.string()}, message), kFailed);
  std::filesystem::remove_all(dir);
}

}  // namespace
}  // namespace cairn::cli
