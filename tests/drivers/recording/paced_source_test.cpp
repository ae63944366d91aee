// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/paced_source.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace cairn::recording {
namespace {

using std::chrono::milliseconds;

class TwoMillisecondsApart final : public Source {
 public:
  Result<Poll> next(Packet& packet, Duration) override {
    if (count_ == 3) return Error{Errc::kMalformed, "damaged"};
    packet.arrival = Time(milliseconds(1000 + 2 * count_));
    packet.sequence = static_cast<std::uint64_t>(count_++);
    return Poll::kPacket;
  }

 private:
  int count_ = 0;
};

/// A clock that runs only while someone waits.
struct Fixture {
  VirtualClock clock;
  std::vector<Duration> waits;
  TwoMillisecondsApart recorded;
  Waiter waiter = [this](Duration span) {
    waits.push_back(span);
    clock.advance_to(clock.now() + span);
  };
  Fixture() { clock.advance_to(Time(milliseconds(77))); }
};

TEST(PacedSource, PacketsComeWhenTheyCame) {
  Fixture f;
  PacedSource paced(f.recorded, f.clock, f.waiter);
  Packet packet;
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(*paced.next(packet, milliseconds(50)), Poll::kPacket);
    EXPECT_EQ(f.clock.now(), Time(milliseconds(77 + 2 * i)));
    EXPECT_EQ(packet.arrival, Time(milliseconds(1000 + 2 * i)));
  }
  EXPECT_FALSE(paced.next(packet, milliseconds(50)));
  EXPECT_EQ(f.waits, (std::vector<Duration>{milliseconds(2), milliseconds(2)}));
}

TEST(PacedSource, TwiceAsFast) {
  Fixture f;
  PacedSource paced(f.recorded, f.clock, f.waiter, 2.0);
  Packet packet;
  for (int i = 0; i < 3; ++i) ASSERT_EQ(*paced.next(packet, milliseconds(50)), Poll::kPacket);
  EXPECT_EQ(f.clock.now(), Time(milliseconds(79)));
}

TEST(PacedSource, NeverWaitsLongerThanTold) {
  Fixture f;
  PacedSource paced(f.recorded, f.clock, f.waiter);
  Packet packet;
  ASSERT_EQ(*paced.next(packet, milliseconds(1)), Poll::kPacket);
  ASSERT_EQ(*paced.next(packet, milliseconds(1)), Poll::kTimeout);
  ASSERT_EQ(*paced.next(packet, milliseconds(1)), Poll::kPacket);
  EXPECT_EQ(packet.sequence, 1U) << "nothing is lost by a time-out";
  EXPECT_EQ(f.clock.now(), Time(milliseconds(79)));
}

TEST(PacedSource, CatchesUpWithoutWaiting) {
  Fixture f;
  PacedSource paced(f.recorded, f.clock, f.waiter);
  Packet packet;
  ASSERT_EQ(*paced.next(packet, milliseconds(1)), Poll::kPacket);
  f.clock.advance_to(Time(milliseconds(500)));
  for (int i = 0; i < 2; ++i) ASSERT_EQ(*paced.next(packet, milliseconds(1)), Poll::kPacket);
  EXPECT_TRUE(f.waits.empty());
}

TEST(PacedSource, TheLiveWaiterReturns) {
  const LiveClock clock;
  const Time before = clock.now();
  live_waiter()(milliseconds(2));
  live_waiter()(milliseconds(-2));
  EXPECT_GE(clock.now() - before, milliseconds(2));
}

}  // namespace
}  // namespace cairn::recording
