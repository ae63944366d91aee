// SPDX-License-Identifier: Apache-2.0
// Device time of packets that come late.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "drivers/velodyne/device_time.hpp"

namespace cairn::velodyne {
namespace {

using namespace std::chrono_literals;
using Kind = DeviceTime::Kind;

constexpr Duration kPacketSpan{1'327'104};  // VLP-16, single return

/// An even device, and a host that gets each of its packets with a delay.
struct Delivery {
  std::mt19937_64 random;
  DeviceTime device_time;
  Time truth{1000s};
  std::uint32_t counter_us = 2'000'000'000;
  Time last = Time::min(), arrival{};
  double error_s = 0;  // of the last stamp
  int jumps = 0, begun = 0;
  int since_begun = 0;  // packets; a scan is given out after 75

  void packet(Duration delay) {
    if (++since_begun > 75) device_time.hold_stamps();
    arrival = std::max(arrival, truth + kPacketSpan + delay);  // one after the other, however long the first took
    const auto stamp = device_time.update(counter_us, arrival, kPacketSpan);
    jumps += stamp.kind == Kind::kJump ? 1 : 0;
    if (stamp.kind == Kind::kFirst) last = Time::min(), since_begun = 0, ++begun;
    if (stamp.kind == Kind::kDuplicate || stamp.kind == Kind::kLate || stamp.kind == Kind::kAhead) return;
    ASSERT_GT(stamp.first_firing, last);
    last = stamp.first_firing;
    error_s = to_seconds(stamp.first_firing - truth);
  }
  void next() {
    truth += 1'327us;
    counter_us += 1'327;
  }
};

// The first packets come late, for 20 ms or until after the first scan. No later packet is a jump.
TEST(LatePackets, LateFirstPacketsAreCaughtUpWithoutAJump) {
  for (const Duration late : {Duration(25ms), Duration(100ms), Duration(400ms), Duration(1500ms)}) {
    for (const int packets : {15, 150}) {
      Delivery d;
      double settled_s = -1;
      for (int i = 0; i < 9000; ++i, d.next()) {
        d.packet(i < packets ? late : Duration{});
        if (settled_s < 0 && i >= packets && d.error_s < 0.01) settled_s = to_seconds(d.truth - Time{1000s});
      }
      EXPECT_EQ(d.jumps, 0);
      EXPECT_LT(d.error_s, 0.001);
      EXPECT_LT(settled_s, packets == 15 ? 0.03 + to_seconds(late) : 0.2 + 5 * to_seconds(late) + 2) << late.count();
    }
  }
}

// A queue that filled before the start is read at once: what came out of it is not used.
TEST(LatePackets, AQueueThatDrainsAtTheStartIsNotBelieved) {
  Delivery d;
  for (int i = 0; i < 750; ++i, d.next()) d.packet((750 - i) * 1'327us + Duration{i * 1000});
  EXPECT_LT(d.error_s, 0.004);
  EXPECT_GT(d.begun, 300);
  d.packet({});
  EXPECT_EQ(d.jumps, 0);
}

TEST(LatePackets, AStampOfArrivalThatIsAbsurdChangesNothing) {
  for (const Duration off : {Duration(3s), Duration(2h), Duration(5 * 365 * 24h), Duration(-3s), Duration(-2h)}) {
    Delivery d;
    for (int i = 0; i < 1500; ++i, d.next()) d.packet(Duration{});
    const auto absurd = d.device_time.update(d.counter_us, d.truth + kPacketSpan + off, kPacketSpan);
    EXPECT_NE(absurd.kind, Kind::kJump) << off.count();
    d.next();
    d.packet(Duration{});
    EXPECT_EQ(d.jumps, 0) << off.count();
    EXPECT_NEAR(d.error_s, 0, 1e-4) << off.count();
  }
}

// Stalls whose packets are delivered later, late starts, repeated and overtaken packets, losses: whatever comes, time
// never goes back, nothing is a jump, and stamps are right some seconds after the first packet that came in time.
TEST(LatePackets, RandomDelaysNeverJump) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Delivery d;
    d.random.seed(seed);
    const auto upto = [&](double most) { return std::uniform_real_distribution<double>(0, most)(d.random); };
    Time held_until = upto(1) < 0.5 ? d.truth + from_seconds(upto(1.0)) : d.truth;
    bool drops = false;
    Time in_time = Time::max();
    for (int i = 0; i < 15'000; ++i, d.next()) {
      if (upto(1) < 5e-4) held_until = d.truth + from_seconds(std::pow(10.0, -3 + upto(3.3))), drops = upto(1) < 0.3;
      if (drops && d.truth < held_until && upto(1) < 0.5) continue;
      const Duration delay = std::max(held_until - d.truth, Duration{}) + from_seconds(upto(1e-4));
      d.packet(delay);
      if (upto(1) < 0.01) d.packet(delay + 1us);  // once more
      if (delay < 1ms) in_time = std::min(in_time, d.truth);
      if (d.truth - 8s > in_time) {
        ASSERT_NEAR(d.error_s, 0, 2e-3) << seed << " at packet " << i;
      }
    }
    EXPECT_EQ(d.jumps, 0) << seed;
  }
}

}  // namespace
}  // namespace cairn::velodyne
