// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/cli/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

namespace cairn::app {
namespace {

using ::testing::HasSubstr;

/// The refusal of a command line of a toolbox with `run --recording`, `map info FILE`.
std::string refused(std::vector<std::string> words) {
  CLI::App app("", "tool");
  app.require_subcommand(1);
  std::string text;
  double seconds = 1;
  CLI::App* run = app.add_subcommand("run", "");
  run->add_option("--recording", text, "");
  run->add_option("--hidden-thing", text, "")->group("");
  run->add_option("--seconds", seconds, "")->check(CLI::PositiveNumber);
  CLI::App* map = app.add_subcommand("map", "");
  map->require_subcommand(1);
  map->add_subcommand("info", "")->add_option("file", text, "")->required();
  std::reverse(words.begin(), words.end());
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    return refusal_of(app, error);
  }
  return "accepted";
}

TEST(Refusal, NamesTheNearestCommand) {
  EXPECT_EQ(refused({"rnu", "--recording", "x"}),
            "`tool` has no command \"rnu\"; did you mean \"run\"? `tool --help` lists what there is.");
  EXPECT_EQ(refused({"calibrate"}), "`tool` has no command \"calibrate\". `tool --help` lists what there is.");
  EXPECT_THAT(refused({"map", "inof", "m.cairn"}),
              HasSubstr("`tool map` has no command \"inof\"; did you mean \"info\"?"));
}

TEST(Refusal, NamesTheNearestOption) {
  EXPECT_THAT(refused({"run", "--recordng", "x"}), HasSubstr("`tool run` has no option \"--recordng\"; did you mean "
                                                             "\"--recording\"? `tool run --help`"));
  EXPECT_THAT(refused({"run", "--recordng=x"}), HasSubstr("\"--recordng\"; did you mean"));
  EXPECT_THAT(refused({"map", "info", "--jsn"}), HasSubstr("`tool map info` has no option \"--jsn\""));
  EXPECT_THAT(refused({"run", "--hidden-thin", "x"}), ::testing::Not(HasSubstr("did you mean")));
}

TEST(Refusal, AWordTooManyAndAWrongValueAreSaidWithTheHelpThatExplainsThem) {
  EXPECT_THAT(refused({"run", "recording"}), HasSubstr("`tool run` takes no further argument, and got \"recording\"."));
  EXPECT_THAT(refused({"run", "--seconds", "-3"}),
              ::testing::AllOf(HasSubstr("--seconds"), HasSubstr("-3"), HasSubstr("`tool run --help` explains it.")));
  EXPECT_THAT(refused({"map", "info"}), HasSubstr("file is required. `tool map info --help`"));
  EXPECT_THAT(refused({}), HasSubstr("subcommand is required. `tool --help`"));
}

}  // namespace
}  // namespace cairn::app
