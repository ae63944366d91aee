// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/door/live_sources.hpp"

#include <gtest/gtest.h>

#include <deque>

namespace cairn::app {
namespace {

using namespace std::chrono_literals;

/// Gives what it is told to, in order; then time-outs that take their time on the virtual clock.
class Scripted final : public Source {
 public:
  Scripted(VirtualClock& clock, int id, int packets) : clock_(clock), id_(id), packets_(packets) {}
  Result<Poll> next(Packet& packet, Duration timeout) override {
    ++asked;
    if (failing) {
      failing = false;
      return Error{Errc::kLinkDown, "unplugged", {}, {}, {}};
    }
    if (packets_ == 0) {
      clock_.advance_to(clock_.now() + timeout);
      return ended ? Poll::kEnd : Poll::kTimeout;
    }
    --packets_;
    packet.source = static_cast<SourceId>(id_);
    return Poll::kPacket;
  }
  int asked = 0;
  bool failing = false, ended = false;

 private:
  VirtualClock& clock_;
  int id_, packets_;
};

struct LiveSourcesTest : testing::Test {
  VirtualClock clock;
  Packet packet;
};

TEST_F(LiveSourcesTest, NoDeviceStarvesAnother) {
  Scripted a(clock, 0, 1000), b(clock, 1, 1000), c(clock, 2, 1000);
  LiveSources all({&a, &b, &c}, clock);
  std::array<int, 3> got{};
  for (int i = 0; i < 300; ++i) {
    ASSERT_EQ(all.next(packet, 1s).value(), Poll::kPacket);
    ++got.at(static_cast<std::size_t>(packet.source));
  }
  EXPECT_EQ(got, (std::array{100, 100, 100}));
}

TEST_F(LiveSourcesTest, SilenceTakesTheTimeThatIsAskedFor) {
  Scripted a(clock, 0, 0), b(clock, 1, 0);
  LiveSources all({&a, &b}, clock);
  const Time start = clock.now();
  EXPECT_EQ(all.next(packet, 50ms).value(), Poll::kTimeout);
  EXPECT_GE(clock.now() - start, 50ms);
  EXPECT_LE(clock.now() - start, 50ms + LiveSources::kGlance);
  EXPECT_LE(a.asked, 60) << "it waits instead of asking without end";
}

TEST_F(LiveSourcesTest, AnErrorIsHandedOnOnceAndTheOthersGoOn) {
  Scripted a(clock, 0, 0), b(clock, 1, 2);
  a.failing = true;
  LiveSources all({&a, &b}, clock);
  EXPECT_FALSE(all.next(packet, 1s));
  EXPECT_EQ(all.next(packet, 1s).value(), Poll::kPacket);
  EXPECT_EQ(all.next(packet, 1s).value(), Poll::kPacket);
  EXPECT_EQ(all.next(packet, 10ms).value(), Poll::kTimeout);
}

TEST_F(LiveSourcesTest, ItEndsWhenAllHaveEnded) {
  Scripted a(clock, 0, 1), b(clock, 1, 1);
  a.ended = b.ended = true;
  LiveSources all({&a, &b}, clock);
  EXPECT_EQ(all.next(packet, 1s).value(), Poll::kPacket);
  EXPECT_EQ(all.next(packet, 1s).value(), Poll::kPacket);
  EXPECT_EQ(all.next(packet, 1s).value(), Poll::kEnd);
  EXPECT_EQ(LiveSources({}, clock).next(packet, 1s).value(), Poll::kEnd);
}

}  // namespace
}  // namespace cairn::app
