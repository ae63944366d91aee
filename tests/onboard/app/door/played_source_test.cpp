// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/door/played_source.hpp"

#include <gtest/gtest.h>

#include <deque>

namespace cairn::app {
namespace {

class ListSource final : public Source {
 public:
  explicit ListSource(std::deque<int> arrivals) : arrivals_(std::move(arrivals)) {}
  Result<Poll> next(Packet& packet, Duration) override {
    if (arrivals_.empty()) return Poll::kEnd;
    packet.arrival = Time{std::chrono::seconds(arrivals_.front())};
    arrivals_.pop_front();
    return Poll::kPacket;
  }

 private:
  std::deque<int> arrivals_;
};

TEST(PlayedSource, PacketsArriveAgainAsFarApartAsTheyDid) {
  VirtualClock clock;
  clock.advance_to(Time{std::chrono::seconds(100)});
  PlayedSource source(std::make_unique<ListSource>(std::deque{7, 9}), clock);
  EXPECT_EQ(source.first_arrival(), Time{std::chrono::seconds(7)});
  source.set_shift(std::chrono::seconds(94));
  Packet packet;
  EXPECT_EQ(source.next(packet, {}).value(), Poll::kTimeout) << "due at 101";
  clock.advance_to(Time{std::chrono::seconds(102)});
  EXPECT_EQ(source.next(packet, {}).value(), Poll::kPacket);
  EXPECT_EQ(packet.arrival, Time{std::chrono::seconds(101)});
  EXPECT_EQ(source.next(packet, {}).value(), Poll::kTimeout);
  clock.advance_to(Time{std::chrono::seconds(103)});
  EXPECT_EQ(source.next(packet, {}).value(), Poll::kPacket);
  EXPECT_EQ(packet.arrival, Time{std::chrono::seconds(103)});
  EXPECT_EQ(source.next(packet, {}).value(), Poll::kEnd);
}

TEST(PlayedSource, AnEmptyOneHasNoFirstArrival) {
  const VirtualClock clock;
  PlayedSource source(std::make_unique<ListSource>(std::deque<int>{}), clock);
  EXPECT_EQ(source.first_arrival(), Time::max());
}

}  // namespace
}  // namespace cairn::app
