// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/scan_assembler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace cairn::velodyne {
namespace {

using namespace std::chrono_literals;

constexpr Duration kPeriod = 100ms;
constexpr Duration kStep{55'296};
constexpr Duration kLaser{34'560};

/// Feeds firings; one point each, whose intensity is the azimuth.
struct Turntable {
  explicit Turntable(double cut_deg) : assembler({SourceId{1}, cut_deg, 1.5, 0}) {}

  void fire(double azimuth_deg) {
    assembler.begin_packet();
    assembler.begin_firing(time, azimuth_deg, kLaser, kPeriod);
    assembler.cloud().push_back({1, 0, 0}, static_cast<float>(azimuth_deg),
                                static_cast<std::uint32_t>((time - assembler.start()).count()), 0, ReturnType::kLast);
    keep(assembler.finished());
    time += kStep;
  }
  /// Turns on from the last azimuth.
  void turn(double degrees, double step_deg = 0.199) {
    for (double done = 0; done < degrees; done += step_deg) {
      fire(azimuth);
      azimuth = std::fmod(azimuth + step_deg, 360.0);
    }
  }
  void keep(const Scan* scan) {
    if (scan != nullptr) scans.push_back(*scan);
  }

  ScanAssembler assembler;
  Time time{1s};
  double azimuth = 0;
  std::vector<Scan> scans;
};

class CutAngle : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(ScanAssembler, CutAngle, testing::Values(0.0, 359.99, 360.0, 180.0, 90.05, 0.01));

// Wherever the cut is and wherever the sensor starts: every firing is in one scan, no scan reaches over the cut, and
// the whole turns are complete.
TEST_P(CutAngle, CutsEveryTurnThere) {
  for (double start = 0; start < 360; start += 41.3) {
    Turntable t(GetParam());
    t.azimuth = start;
    t.turn(5 * 360.0);
    t.keep(t.assembler.flush());
    std::size_t firings = 0;
    for (std::size_t k = 0; k < t.scans.size(); ++k) {
      const Scan& scan = t.scans[k];
      firings += scan.cloud.size();
      double last = -1;
      for (const float azimuth : scan.cloud.intensity) {
        const double since_cut = std::fmod(azimuth - GetParam() + 720.0, 360.0);
        ASSERT_GT(since_cut, last - 1e-4);
        last = since_cut;
      }
      EXPECT_EQ(scan.cloud.offset_ns.front(), 0U);
      EXPECT_EQ(scan.valid.end - scan.valid.start, Duration{scan.cloud.offset_ns.back()} + kLaser);
      const bool whole = k > 0 && k + 1 < t.scans.size();
      if (!whole) continue;
      EXPECT_FALSE(scan.incomplete);
      EXPECT_NEAR(static_cast<double>(scan.cloud.size()), 360 / 0.199, 1.0);
    }
    EXPECT_GE(t.scans.size(), 5U);
    EXPECT_LE(t.scans.size(), 7U);
    EXPECT_TRUE(t.scans.back().incomplete);
    EXPECT_GE(t.assembler.revolutions() + 1, t.scans.size());
    EXPECT_EQ(firings, static_cast<std::size_t>(std::ceil(5 * 360.0 / 0.199)));
  }
}

TEST(ScanAssembler, FirstScanBeginsAnywhereAndIsIncomplete) {
  Turntable t(0);
  t.azimuth = 350;
  t.turn(400);
  ASSERT_EQ(t.scans.size(), 2U);
  EXPECT_TRUE(t.scans[0].incomplete);
  EXPECT_FALSE(t.scans[1].incomplete);
  EXPECT_EQ(t.scans[0].source, SourceId{1});
}

// A limited field of view: 90° on either side of the cut angle, or all of it away from the cut.
// Whatever is missing, and wherever: less than half of the turn is a part, more is not, and a whole one never is.
TEST(ScanAssembler, AScanOfLessThanHalfATurnIsPartial) {
  for (const double seen : {10.0, 100.0, 178.0, 182.0, 300.0, 350.0}) {
    Turntable t(0);
    t.turn(360);
    t.turn(seen / 2);
    t.azimuth += 360 - seen;  // a gap in the middle
    t.time += from_seconds(to_seconds(kPeriod) * (360 - seen) / 360);
    t.assembler.add_lost(1);
    t.turn(seen / 2);
    t.azimuth = 0;
    t.turn(360);
    t.turn(1);
    ASSERT_EQ(t.scans.size(), 3U);
    EXPECT_EQ(t.scans[1].partial, seen < 180) << seen;
    EXPECT_TRUE(t.scans[1].incomplete);
    EXPECT_FALSE(t.scans[0].partial || t.scans[2].partial) << seen;
  }
  Turntable standing(0);
  for (int i = 0; i < 10'000; ++i) standing.fire(77);
  ASSERT_FALSE(standing.scans.empty());
  for (const Scan& scan : standing.scans) EXPECT_TRUE(scan.partial) << "many points, but of one direction";
}

TEST(ScanAssembler, LimitedFieldOfViewIsCutWithoutEverShowingTheAngle) {
  for (const double cut : {0.0, 180.0, 60.0}) {
    Turntable t(cut);
    for (int turn = 0; turn < 5; ++turn) {
      t.azimuth = 300;
      t.turn(120);
      t.time += 66ms;
    }
    EXPECT_EQ(t.assembler.revolutions(), t.scans.size());
    EXPECT_GE(t.scans.size(), 4U) << cut;
    for (std::size_t k = 1; k < t.scans.size(); ++k) {
      EXPECT_FALSE(t.scans[k].incomplete) << cut;
      EXPECT_NEAR(static_cast<double>(t.scans[k].cloud.size()), 120 / 0.199, 2);
    }
  }
}

TEST(ScanAssembler, StandingMotorGivesIncompleteScansByTimeOut) {
  Turntable t(0);
  for (int i = 0; i < 10'000; ++i) t.fire(123.4);  // 0.55 s
  EXPECT_EQ(t.scans.size(), 3U);
  EXPECT_EQ(t.assembler.revolutions(), 0U);
  for (const Scan& scan : t.scans) {
    EXPECT_TRUE(scan.incomplete);
    EXPECT_LE(scan.valid.end - scan.valid.start, 151ms);
  }
}

TEST(ScanAssembler, JitterAtTheCutDoesNotCutTwice) {
  Turntable t(0);
  t.turn(3 * 360.0);
  const std::size_t before = t.scans.size();
  for (int i = 0; i < 20; ++i) t.fire(i % 2 == 0 ? 359.99 : 0.0);
  EXPECT_LE(t.scans.size(), before + 1);
}

TEST(ScanAssembler, LossesMakeAScanIncompleteAndAreCounted) {
  Turntable t(0);
  t.turn(360 + 100);
  t.assembler.add_lost(3);
  t.assembler.add_lost(0xFFFFFFFFFFULL);  // does not wrap
  t.turn(360);
  t.turn(360);
  ASSERT_EQ(t.scans.size(), 3U);
  EXPECT_EQ(t.scans[1].lost_packets, 0xFFFFFFFFU);
  EXPECT_TRUE(t.scans[1].incomplete);
  EXPECT_EQ(t.scans[2].lost_packets, 0U);
  EXPECT_FALSE(t.scans[2].incomplete);
}

TEST(ScanAssembler, DiscardForgetsTheRunningScan) {
  Turntable t(0);
  EXPECT_FALSE(t.assembler.discard());
  t.turn(360 + 100);
  EXPECT_TRUE(t.assembler.discard());
  t.turn(300);
  ASSERT_EQ(t.scans.size(), 2U);
  EXPECT_TRUE(t.scans[1].incomplete) << "began in the middle of a turn";
  EXPECT_GT(t.scans[1].cloud.intensity.front(), 90);
}

TEST(ScanAssembler, ExpireClosesOnlyWhatIsOld) {
  Turntable t(0);
  EXPECT_EQ(t.assembler.expire(t.time + 10s, kPeriod), nullptr);
  EXPECT_EQ(t.assembler.flush(), nullptr);
  t.turn(90);
  const Time start = t.assembler.start();
  EXPECT_EQ(t.assembler.expire(start + 150ms, kPeriod), nullptr);
  const Scan* scan = t.assembler.expire(start + 151ms, kPeriod);
  ASSERT_NE(scan, nullptr);
  EXPECT_TRUE(scan->incomplete);
  EXPECT_EQ(scan->valid.start, start);
  EXPECT_EQ(t.assembler.flush(), nullptr);
}

TEST(ScanAssembler, AtMostOneScanPerPacket) {
  ScanAssembler assembler({SourceId{}, 0, 1.5, 0});
  Time time{1s};
  for (int packet = 0; packet < 100; ++packet) {
    assembler.begin_packet();
    const std::uint64_t before = assembler.revolutions();
    for (const double azimuth : {10.0, 350.0, 5.0, 340.0, 1.0})
      assembler.begin_firing(time += 1ms, azimuth, kLaser, kPeriod);
    EXPECT_LE(assembler.revolutions(), before + 1);
  }
}

}  // namespace
}  // namespace cairn::velodyne
