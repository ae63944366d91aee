// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/device_time.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "drivers/velodyne/packet.hpp"

namespace cairn::velodyne {
namespace {

using namespace std::chrono_literals;
using Kind = DeviceTime::Kind;

constexpr Duration kSpan{1'327'104};  // VLP-16, single return
constexpr std::int64_t kHour = kMicrosecondsPerHour;

bool not_used(Kind kind) { return kind == Kind::kDuplicate || kind == Kind::kLate || kind == Kind::kAhead; }

/// A device whose counter starts anywhere, and a host; both advance packet by packet.
struct World {
  DeviceTime device_time;
  std::int64_t counter_us = 0;
  Time host{1000s};  // the next packet's first firing
  Time last{Time::min()};

  DeviceTime::Stamp packet(Duration delay = {}) {
    const auto stamp = device_time.update(static_cast<std::uint32_t>(counter_us), host + kSpan + delay, kSpan);
    return stamp;
  }
  void advance(Duration by = kSpan) {
    device_ns += by.count();
    counter_us += device_ns / 1000;
    device_ns %= 1000;
    host += by;
  }
  /// Runs evenly and expects nothing to happen.
  void run(Duration duration, std::int64_t modulus = kHour) {
    for (const Time end = host + duration; host < end; advance()) {
      counter_us %= modulus;
      const auto stamp = packet();
      ASSERT_TRUE(stamp.kind == Kind::kNext || last == Time::min()) << counter_us;
      ASSERT_GT(stamp.first_firing, last);
      last = stamp.first_firing;
    }
  }
  std::int64_t device_ns = 0;
};

// ---- the hour

struct HourCase {
  const char* what;
  std::int64_t counter_us, reference_utc_us, expected_utc_us;
};

class Hour : public testing::TestWithParam<HourCase> {};
TEST_P(Hour, IsResolvedToHalfAnHour) {
  const HourCase& c = GetParam();
  EXPECT_EQ(resolve_utc_us(static_cast<std::uint32_t>(c.counter_us), c.reference_utc_us), c.expected_utc_us);
}
constexpr std::int64_t kTop = 400'000 * kHour;  // the top of some hour in 2015
constexpr std::int64_t kMinute = 60'000'000;
INSTANTIATE_TEST_SUITE_P(
    DeviceTime, Hour,
    testing::Values(HourCase{"plain", 10 * kMinute, kTop + 10 * kMinute + 5, kTop + 10 * kMinute},
                    HourCase{"before the top, host after it", kHour - 1, kTop + 3, kTop - 1},
                    HourCase{"after the top, host before it", 3, kTop - 1, kTop + 3},
                    HourCase{"at the top", 0, kTop, kTop},
                    HourCase{"29 min 59 s ahead stays", 59 * kMinute + 59'000'000, kTop + 30 * kMinute,
                             kTop + 59 * kMinute + 59'000'000},
                    HourCase{"exactly 30 min ahead stays", 40 * kMinute, kTop + 10 * kMinute, kTop + 40 * kMinute},
                    HourCase{"just over 30 min ahead", 40 * kMinute + 1, kTop + 10 * kMinute, kTop - 20 * kMinute + 1},
                    HourCase{"exactly 30 min behind stays", 10 * kMinute, kTop + 40 * kMinute, kTop + 10 * kMinute},
                    HourCase{"just over 30 min behind", 10 * kMinute - 1, kTop + 40 * kMinute, kTop + 70 * kMinute - 1},
                    HourCase{"beyond 3600 s", kHour + 5'000'000, kTop + kHour + 5'000'100, kTop + kHour + 5'000'000},
                    HourCase{"the largest counter", 0xFFFFFFFFLL, kTop + 11 * kMinute, kTop + 0xFFFFFFFFLL - kHour},
                    HourCase{"before 1970", 5, -kHour + 7, -kHour + 5}),
    [](const auto& test) {
      std::string name;
      for (const char c : std::string(test.param.what))
        name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
      return name;
    });

// ---- one device time after the other

TEST(DeviceTime, FirstFiringIsArrivalLessTheSpan) {
  World w;
  w.counter_us = 1'700'000'000;  // 28 min past some hour that nobody set: 17 to 30 min off were seen in the field
  const auto stamp = w.packet();
  EXPECT_EQ(stamp.kind, Kind::kFirst);
  EXPECT_EQ(stamp.first_firing, w.host);
}

TEST(DeviceTime, RolloverAtTheHourIsExact) {
  for (std::int64_t before = 0; before <= 1327; before += 1) {
    World w;
    w.counter_us = kHour - before;
    w.packet();
    w.advance();
    const std::int64_t step = 1327;
    w.counter_us = (kHour - before + step) % kHour;
    const auto stamp = w.packet();
    ASSERT_EQ(stamp.kind, Kind::kNext) << before;
    ASSERT_EQ(stamp.step, std::chrono::microseconds(step)) << before;
  }
}

TEST(DeviceTime, CountersBeyondTheHourGoOnAndWrapWhereTheyDo) {
  World w;
  w.counter_us = kHour - 2'000'000;
  w.run(10s, std::int64_t{1} << 32);  // past 3600 s without a wrap
  EXPECT_GT(w.counter_us, kHour);
  w.counter_us -= kHour;  // and wraps late
  EXPECT_EQ(w.packet().kind, Kind::kNext);
  World wraps_at_u32;
  wraps_at_u32.counter_us = (std::int64_t{1} << 32) - 2'000'000;
  wraps_at_u32.run(10s, std::int64_t{1} << 32);
  EXPECT_LT(wraps_at_u32.counter_us, 9'000'000);
}

TEST(DeviceTime, SilenceIsNoJump) {
  for (const Duration silence : {Duration(2s), Duration(40min), Duration(5h + 7s)}) {
    World w;
    w.counter_us = 3'000'000'000;
    w.run(2s);
    w.advance(silence);
    w.counter_us %= kHour;
    const auto stamp = w.packet();
    EXPECT_EQ(stamp.kind, Kind::kNext) << silence.count();
    EXPECT_NEAR(to_seconds(stamp.step), to_seconds(silence), 0.002);
  }
}

TEST(DeviceTime, DuplicatesAndLatePacketsAreTold) {
  World w;
  w.run(1s);
  const auto counter = w.counter_us;
  w.packet();
  EXPECT_EQ(w.packet().kind, Kind::kDuplicate);
  w.counter_us = counter - 1327;
  EXPECT_EQ(w.packet().kind, Kind::kLate);
  w.counter_us = counter + 600;  // overlaps the previous packet
  EXPECT_EQ(w.packet().kind, Kind::kLate);
  w.counter_us = counter;
  w.advance();
  EXPECT_EQ(w.packet().kind, Kind::kNext);
}

struct JumpCase {
  const char* what;
  std::int64_t by_us;
};
class Jump : public testing::TestWithParam<JumpCase> {};
INSTANTIATE_TEST_SUITE_P(DeviceTime, Jump,
                         testing::Values(JumpCase{"lock_17_min", 17 * kMinute},
                                         JumpCase{"lock_back_30_min", -30 * kMinute}, JumpCase{"ahead_25_ms", 25'000},
                                         JumpCase{"back_60_ms", -60'000}, JumpCase{"back_20_ms", -20'000},
                                         JumpCase{"ahead_half_an_hour", kHour / 2}, JumpCase{"ahead_3_s", 3'000'000},
                                         JumpCase{"back_1_s", -1'000'000}),
                         [](const auto& test) { return test.param.what; });

// PPS is found or lost: one jump, and within 2 s the stamps are right again. They never go back.
TEST_P(Jump, IsToldOnceAndRelocks) {
  World w;
  w.counter_us = 1'800'000'000;
  w.run(3s);
  w.counter_us += GetParam().by_us;
  int jumps = 0;
  double worst_after_2s = 0;
  for (const Time end = w.host + 4s, settled = w.host + 2s; w.host < end; w.advance()) {
    const auto stamp = w.packet();
    if (not_used(stamp.kind)) continue;
    jumps += stamp.kind == Kind::kJump ? 1 : 0;
    ASSERT_GT(stamp.first_firing, w.last);
    w.last = stamp.first_firing;
    if (w.host >= settled) worst_after_2s = std::max(worst_after_2s, std::abs(to_seconds(stamp.first_firing - w.host)));
  }
  EXPECT_EQ(jumps, 1);
  EXPECT_LT(worst_after_2s, 1e-4);
}

TEST(DeviceTime, CounterThatStandsStillDoesNotStopTime) {
  World w;
  w.run(1s);
  int used = 0;
  const auto counter = w.counter_us;
  for (int i = 0; i < 900; ++i, w.advance()) {
    w.counter_us = counter;
    const auto stamp = w.packet();
    if (stamp.kind == Kind::kDuplicate) continue;
    ASSERT_GT(stamp.first_firing, w.last);
    w.last = stamp.first_firing;
    ++used;
  }
  EXPECT_EQ(used, 1 + 899 / 9) << "every ninth says kJump";
}

TEST(DeviceTime, BrokenRecordingThatGoesBackInTimeIsOneJump) {
  World w;
  w.run(3s);
  w.host -= 2h;  // two captures, glued together in the wrong order
  int jumps = 0;
  for (int i = 0; i < 3000; ++i, w.advance()) {
    const auto stamp = w.packet();
    if (not_used(stamp.kind)) continue;
    jumps += stamp.kind == Kind::kJump ? 1 : 0;
    ASSERT_GT(stamp.first_firing, w.last);
    w.last = stamp.first_firing;
  }
  EXPECT_EQ(jumps, 1);
}

TEST(DeviceTime, StallOfTheHostDoesNotBendTime) {
  World w;
  w.run(3s);
  for (int i = 0; i < 300; ++i, w.advance()) {
    const Duration delay = i < 150 ? (150 - i) * kSpan : Duration{};  // 200 ms of packets, read at once
    const auto stamp = w.packet(delay);
    ASSERT_EQ(stamp.kind, Kind::kNext);
    ASSERT_LT(std::abs(to_seconds(stamp.first_firing - w.host)), 1e-4);
  }
}

TEST(DeviceTime, ExactTimeIsUsedWhileItAgreesWithArrival) {
  for (const auto& [error, used] : {std::pair<Duration, bool>{-2ms, true}, {500ms, false}, {-1h, false}}) {
    DeviceTime device_time;
    Time host{1000s};
    DeviceTime::Stamp stamp;
    for (std::uint32_t us = 0; us < 5'000'000; us += 1327, host += 1327us)
      stamp = device_time.update(us, host + kSpan, kSpan, host + error);
    EXPECT_NEAR(to_seconds(stamp.first_firing - (host - 1327us)), used ? to_seconds(error) : 0.0, 1e-5);
  }
}

TEST(DeviceTime, OnePacketThatContradictsIsSetAside) {
  const std::int64_t steps_us[] = {-60'000, 25'000, 3'000'000, -kHour / 2};
  for (const std::int64_t by_us : steps_us) {
    World w;
    w.counter_us = 1'800'000'000;
    w.run(2s);
    w.counter_us += by_us;
    EXPECT_NE(w.packet().kind, Kind::kJump) << by_us;
    w.counter_us -= by_us;
    w.advance();
    EXPECT_EQ(w.packet().kind, Kind::kNext) << by_us;
  }
}

// A day with a drifting crystal, jittering arrival, stalls and losses: time never goes back, never bends by more than
// the slew, and stays within the jitter's floor of the truth.
TEST(DeviceTime, DayOfVirtualTime) {
  for (const double drift : {-50e-6, 50e-6}) {
    std::mt19937_64 random(3);
    std::exponential_distribution<double> jitter(1 / 300e-6);
    std::uniform_int_distribution<int> chance(0, 9999);
    DeviceTime device_time;
    constexpr Duration kStep = 32 * kSpan;  // every 32nd packet is enough
    const Time start{500s};
    Time last = Time::min(), last_truth = start;
    Time stalled_until = Time::min();
    double worst = 0;
    std::int64_t steps = 0, hours = 0;
    std::uint32_t last_counter = 0;
    for (std::int64_t i = 0; to_seconds(i * kStep) < 86'400; ++i) {
      if (chance(random) == 0) i += chance(random) / 100;  // some are lost
      const Time truth = start + i * kStep;
      const auto device_us = static_cast<std::int64_t>((1'234.5 + to_seconds(i * kStep) * (1 + drift)) * 1e6);
      const auto counter = static_cast<std::uint32_t>(device_us % kHour);
      hours += counter < last_counter ? 1 : 0;
      last_counter = counter;
      Time arrival = truth + kSpan + from_seconds(100e-6 + jitter(random));
      if (chance(random) == 0) stalled_until = arrival + 30ms;
      arrival = std::max(arrival, stalled_until);
      const auto stamp = device_time.update(counter, arrival, kSpan);
      ASSERT_EQ(stamp.kind, i == 0 ? Kind::kFirst : Kind::kNext) << i;
      if (steps++ > 0) {
        const double ratio = to_seconds(stamp.first_firing - last) / to_seconds(truth - last_truth);
        ASSERT_NEAR(ratio, 1, to_seconds(truth - start) < 2 ? 0.012 : 0.0008);
      }
      last = stamp.first_firing;
      last_truth = truth;
      if (to_seconds(truth - start) > 3) worst = std::max(worst, std::abs(to_seconds(stamp.first_firing - truth)));
    }
    EXPECT_EQ(hours, 24);
    EXPECT_LT(worst, 0.7e-3) << "0.1 ms of it is the network's shortest delay";
  }
}

}  // namespace
}  // namespace cairn::velodyne
