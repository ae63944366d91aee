// SPDX-License-Identifier: Apache-2.0
#include "hal/files/standard_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

namespace cairn {
namespace {

using ::testing::HasSubstr;

struct FullDevice : ::testing::Test {
  void SetUp() override {
    if (!out) GTEST_SKIP() << "no /dev/full here";
  }
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> out{std::fopen("/dev/full", "w"), &std::fclose};
};

TEST_F(FullDevice, RefusesWhatWasPrinted) {
  ASSERT_TRUE(flush_output(out.get())) << "nothing was printed";
  std::fputs("{}", out.get());
  const auto flushed = flush_output(out.get());
  ASSERT_FALSE(flushed);
  EXPECT_THAT(to_string(flushed.error()), HasSubstr("standard output: cannot be written: No space left on device"));
}

TEST_F(FullDevice, RefusedAnEarlierPart) {
  std::fputs(std::string(1'000'000, 'x').c_str(), out.get());
  EXPECT_FALSE(flush_output(out.get()));
  EXPECT_FALSE(flush_output(out.get())) << "what is lost stays lost";
}

/// Ends a child whose stdout is this file.
[[noreturn]] void end_with_stdout(const char* file, int code) {
  if (std::freopen(file, "w", stdout) == nullptr) std::_Exit(99);
  std::fputs("text", stdout);
  std::_Exit(end_of_program("cairn", code));
}

TEST_F(FullDevice, OfStdoutMakesAProgramFail) {
  EXPECT_EXIT(end_with_stdout("/dev/full", 0), testing::ExitedWithCode(1), "cairn: standard output: .*No space left");
  EXPECT_EXIT(end_with_stdout("/dev/full", 2), testing::ExitedWithCode(2), "No space left");
  EXPECT_EXIT(end_with_stdout("/dev/null", 0), testing::ExitedWithCode(0), "^$");
}

}  // namespace
}  // namespace cairn
