// SPDX-License-Identifier: Apache-2.0
// The kernel's part is tested with the sockets, in udp_source_test.cpp.
#include "drivers/velodyne/transport/udp_filter.hpp"

#include <gtest/gtest.h>

namespace cairn::velodyne {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kSensor = 0xC0A801C9;

TEST(SenderLearner, KnowsWhoSentEnoughValidPackets) {
  SenderLearner learner;
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(learner.note(1, false, Time{}));
  for (int i = 1; i < SenderLearner::kEnough; ++i) EXPECT_FALSE(learner.note(kSensor, true, Time{}));
  EXPECT_EQ(learner.note(kSensor, true, Time{}), kSensor);
  EXPECT_EQ(learner.address(), kSensor);
  EXPECT_FALSE(learner.note(2, true, Time{})) << "said once";
}

TEST(SenderLearner, ACrowdOfSendersKeepsTheSensorNotOut) {
  SenderLearner learner;
  std::uint32_t stranger = 1;
  for (int i = 0; i < 1000 && !learner.address(); ++i) {
    for (int k = 0; k < 3; ++k) (void)learner.note(stranger++, true, Time{});
    for (int k = 0; k < 4; ++k) (void)learner.note(kSensor, true, Time{});
  }
  EXPECT_EQ(learner.address(), kSensor);
}

TEST(SenderLearner, ForgetsASensorThatWentSilent) {
  SenderLearner learner;
  for (int i = 0; i < SenderLearner::kEnough; ++i) (void)learner.note(kSensor, true, Time{1s});
  (void)learner.note(kSensor, true, Time{5s});
  (void)learner.note(7, true, Time{9s});
  EXPECT_FALSE(learner.forget_silent(Time{5s} + SenderLearner::kSilent - 1ns));
  EXPECT_TRUE(learner.forget_silent(Time{5s} + SenderLearner::kSilent));
  EXPECT_FALSE(learner.address());
  EXPECT_FALSE(learner.forget_silent(Time{20s}));
}

}  // namespace
}  // namespace cairn::velodyne
