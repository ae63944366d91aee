// SPDX-License-Identifier: Apache-2.0
#include "tools/team/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/tools/team/shell.hpp"

namespace cairn::team_run {
namespace {

using ::testing::HasSubstr;

int code_of(Process& process) {
  EXPECT_TRUE(becomes_true([&] { return process.ended().has_value(); }));
  return process.ended().value_or(-1);
}

bool runs(pid_t id) { return ::kill(id, 0) == 0; }

TEST(Process, EndsWithItsCodeAndLeavesItsWordsInTheLog) {
  const support::TemporaryFolder folder;
  auto process = Process::start(shell("echo said; echo complained >&2; pwd; exit 3", folder.path()));
  ASSERT_TRUE(process);
  EXPECT_EQ(code_of(*process), 3);
  EXPECT_EQ(text_of(folder / "log"), "said\ncomplained\n" + folder.path().string() + "\n");
}

TEST(Process, ASignalIsACode) {
  const support::TemporaryFolder folder;
  auto process = Process::start(shell("kill -9 $$", folder.path()));
  ASSERT_TRUE(process);
  EXPECT_EQ(code_of(*process), 128 + 9);
}

TEST(Process, AProgramThatIsNotThereSaysSo) {
  const support::TemporaryFolder folder;
  auto process = Process::start({{"/no/such/program"}, folder.path(), folder / "log"});
  ASSERT_TRUE(process);
  EXPECT_EQ(code_of(*process), 127);
  EXPECT_THAT(text_of(folder / "log"), HasSubstr("/no/such/program: cannot be started: No such file"));
}

/// Between fork() and exec() it would be the parent's handler that hears of it.
TEST(Process, ASignalRightAfterTheStartReachesTheProgram) {
  const support::TemporaryFolder folder;
  const auto before = std::signal(SIGTERM, [](int) {});
  for (int i = 0; i < 20; ++i) {
    auto process = Process::start(shell("exec tail -f /dev/null", folder.path()));
    ASSERT_TRUE(process);
    process->signal(SIGTERM);
    EXPECT_EQ(code_of(*process), 128 + SIGTERM);
  }
  (void)std::signal(SIGTERM, before);
}

TEST(Process, DoesNotOutliveItsObject) {
  const support::TemporaryFolder folder;
  pid_t id = 0;
  {
    auto process = Process::start(shell("exec tail -f /dev/null", folder.path()));
    ASSERT_TRUE(process);
    id = process->id();
    EXPECT_TRUE(runs(id));
    EXPECT_FALSE(process->ended());
  }
  EXPECT_FALSE(runs(id));
}

/// The process that a program started that was killed: gone, too.
TEST(Process, DiesWithTheProgramThatStartedIt) {
  const support::TemporaryFolder folder;
  const pid_t program = ::fork();
  if (program == 0) {
    auto process = Process::start(shell("echo $$ > id.new; mv id.new id; exec tail -f /dev/null", folder.path()));
    for (;;) ::pause();
  }
  ASSERT_TRUE(becomes_true([&] { return std::filesystem::exists(folder / "id"); }));
  const auto child = static_cast<pid_t>(std::stol(text_of(folder / "id")));
  EXPECT_TRUE(runs(child));
  ::kill(program, SIGKILL);
  ::waitpid(program, nullptr, 0);
  EXPECT_TRUE(becomes_true([&] { return !runs(child); }));
}

}  // namespace
}  // namespace cairn::team_run
