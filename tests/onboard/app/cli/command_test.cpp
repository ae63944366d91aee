// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/cli/command.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace cairn::app {
namespace {

TEST(Command, AFileNameThatIsNotUtf8IsPrintedAsValidJson) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(print({{"out", "/tmp/caf\xE9"}, {"n", 1}}), kDone);
  const auto object = nlohmann::json::parse(testing::internal::GetCapturedStdout());
  EXPECT_EQ(object["out"], "/tmp/caf\uFFFD");
  EXPECT_EQ(object["n"], 1);
}

TEST(Command, ANumberThatHasToBeAboveZeroIsAskedForInASentence) {
  EXPECT_EQ(above_zero("0.5"), "");
  EXPECT_EQ(above_zero("1e9"), "");
  EXPECT_EQ(above_zero("-3"), "must be a number above 0, and is \"-3\"");
  for (const char* wrong : {"0", "", "3s", "nan", "inf", "1e999"}) EXPECT_NE(above_zero(wrong), "") << wrong;
}

TEST(Command, OnlyAFaultyConfigurationCountsAsWrongArguments) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(fail({Errc::kInvalidConfig, "no such key", "robot.yaml", {}, {}}), kWrongArguments);
  EXPECT_EQ(fail({Errc::kIo, "cannot be read", "map.cairn", {}, {}}), kFailed);
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("robot.yaml"), std::string::npos);
  EXPECT_NE(text.find("map.cairn"), std::string::npos);
}

/// Ends a child that prints its help where nothing can be written.
[[noreturn]] void print_help_to_full_device() {
  if (std::freopen("/dev/full", "w", stdout) == nullptr) std::_Exit(99);
  CLI::App app("", "tool");
  Commands commands{app, {}};
  std::array<char, 5> name{"tool"};
  std::array<char, 7> help{"--help"};
  std::array<char*, 3> words{name.data(), help.data(), nullptr};
  std::_Exit(run_program(commands, 2, words.data()));
}

TEST(Command, WhatStdoutDoesNotTakeIsAFailure) {
  EXPECT_EXIT(print_help_to_full_device(), testing::ExitedWithCode(kFailed), "cairn: standard output: .*No space left");
}

}  // namespace
}  // namespace cairn::app
