// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <mutex>

#include "tests/faults/core_rig.hpp"
#include "tests/faults/forbidden_calls.hpp"

namespace cairn::faults {
namespace {

TEST(ForbiddenCalls, AreSeen) {
  const long before = calls_seen();
  const auto memory = std::make_unique<int>(1);
  EXPECT_GT(calls_seen(), before);
  std::mutex mutex;
  const long allocated = calls_seen();
  const std::lock_guard lock(mutex);
  EXPECT_GT(calls_seen(), allocated);
}

TEST(ForbiddenCallsDeathTest, EndTheProgramAndAreNamed) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_DEATH(
      {
        forbid_calls();
        const std::unique_ptr<int> memory(new int(2));
        allow_calls();
      },
      "forbidden call: malloc");
}

/// 1000 s of driving in virtual time, with an e-stop pressed and armed again now and then.
TEST(MillionTicks, OfSafetyAndDriveNeitherAllocateNorLock) {
  CoreRig rig({forbid_calls, allow_calls});
  ASSERT_TRUE(rig.drives());
  for (int minute = 0; minute < 17; ++minute) {
    const Measured m = rig.run([](CoreRig& r) { r.line.move(false, r.bus.now); },
                               [](CoreRig& r) { r.line.move(true, r.bus.now); }, std::chrono::seconds(58));
    EXPECT_TRUE(m.held) << "minute " << minute;
    EXPECT_EQ(m.worst, safety::Mode::kStop);
  }
  EXPECT_GE(rig.ticks(), 1'000'000U);
  EXPECT_TRUE(rig.drives());
}

}  // namespace
}  // namespace cairn::faults
