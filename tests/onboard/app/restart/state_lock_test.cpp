// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/state_lock.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <optional>

#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

TEST(StateLock, OneCoreAtATimeHasAFolder) {
  const support::TemporaryFolder folder;
  auto first = std::optional(StateLock::take(folder / "state"));
  ASSERT_TRUE(*first) << to_string(first->error());
  const auto second = StateLock::take(folder / "state");
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kLimit);
  EXPECT_THAT(to_string(second.error()), ::testing::HasSubstr("another core uses this state folder"));
  EXPECT_TRUE(StateLock::take(folder / "other"));
  first.reset();
  EXPECT_TRUE(StateLock::take(folder / "state")) << "the first is gone";
}

TEST(StateLock, AFolderThatCannotBeMadeIsAnErrorOfItsOwn) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  const auto lock = StateLock::take(folder / "file" / "state");
  ASSERT_FALSE(lock);
  EXPECT_EQ(lock.error().code, Errc::kIo);
}

}  // namespace
}  // namespace cairn::app
