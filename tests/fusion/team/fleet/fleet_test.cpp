// SPDX-License-Identifier: Apache-2.0
// Eight robots, a link that loses, delays, reorders, repeats and replays, a partition of ten minutes, a crash: soon
// after it is over everybody knows the same and holds the same map, to the byte. CAIRN_FLEET_SEEDS runs more than the
// usual few.
#include "tests/fusion/team/fleet/fleet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

namespace cairn::fleet {
namespace {

using std::chrono::seconds;

unsigned seeds(unsigned usual) {
  const char* wanted = std::getenv("CAIRN_FLEET_SEEDS");
  return wanted != nullptr ? static_cast<unsigned>(std::strtoul(wanted, nullptr, 10)) : usual;
}
unsigned first_seed() {
  const char* wanted = std::getenv("CAIRN_FLEET_FIRST");
  return wanted != nullptr ? static_cast<unsigned>(std::strtoul(wanted, nullptr, 10)) : 0;
}

constexpr LinkQuality kBad{0.3, 0.05, 0.01, std::chrono::milliseconds(20), std::chrono::milliseconds(500)};
constexpr std::size_t kBytesPerSecond = 16000;  // 128 kbit/s

/// Seconds until all agree, at most `most`.
double time_to_agree(Fleet& fleet, Duration most) {
  const Time from = fleet.now();
  while (!fleet.agrees() && fleet.now() < from + most) fleet.step();
  return to_seconds(fleet.now() - from);
}

/// Observations by everyone each second.
void explore(Fleet& fleet, unsigned robots, Duration length, std::mt19937& random) {
  for (const Time end = fleet.now() + length; fleet.now() < end;) {
    for (RobotId id = 1; id <= robots; ++id)
      fleet.observe(id, random() % 3 == 0 ? 1 + static_cast<int>(random() % 3) : 0);
    fleet.run_until(fleet.now() + seconds(1));
  }
}

/// Adds how many submaps were found to have drifted.
double healed_after(unsigned seed, std::ptrdiff_t& drifted) {
  constexpr unsigned kRobots = 8;
  std::mt19937 random(seed);
  Fleet fleet(kRobots, kBytesPerSecond, kBad, seed);
  explore(fleet, kRobots, seconds(20 + random() % 20), random);
  for (RobotId id = 1; id <= kRobots; ++id) fleet.network.put(id, static_cast<int>(random() % 3));
  const RobotId victim = 1 + random() % kRobots;
  explore(fleet, kRobots, seconds(random() % 300), random);
  fleet.crash(victim);
  explore(fleet, kRobots, seconds(5 + random() % 60), random);
  fleet.start(victim, random() % 3 == 0 ? 1 : 2);  // now and then it has forgotten how often it began
  explore(fleet, kRobots, seconds(240), random);
  for (RobotId id = 1; id <= kRobots; ++id) fleet.network.put(id, 0);
  fleet.set_slice(100, Fleet::kTick);
  const double after = time_to_agree(fleet, seconds(60));
  EXPECT_EQ(fleet.team(1).poses().T_team_odom.size(), kRobots) << "seed " << seed;
  EXPECT_EQ(fleet.maps().size(), 1U) << "seed " << seed;
  EXPECT_GT(fleet.team(1).poses().submaps.size(), kRobots + 5) << "seed " << seed;
  const auto& submaps = fleet.team(1).poses().submaps;
  drifted += std::ranges::count_if(submaps, [&](const auto& submap) {
    return submap.second.matrix() != submaps.at({submap.first.robot, 0}).matrix();
  });
  return after;
}

void expect_agreement_soon(unsigned first, unsigned count) {
  double longest = 0, sum = 0;
  std::ptrdiff_t drifted = 0;
  for (unsigned seed = first; seed < first + count; ++seed) {
    const double after = healed_after(seed, drifted);
    EXPECT_LE(after, 30) << "seed " << seed;
    longest = std::max(longest, after);
    sum += after;
  }
  EXPECT_GT(drifted, 0);
  testing::Test::RecordProperty("longest_s", std::to_string(longest));
  std::cout << count << " seeds: mean " << sum / count << " s, longest " << longest << " s\n";
}

TEST(Fleet, AgreesSoonAfterAPartitionAndACrash) { expect_agreement_soon(1, 1); }
TEST(FullFleet, AgreesSoonAfterAPartitionAndACrash) { expect_agreement_soon(first_seed(), seeds(10)); }

TEST(Fleet, SameSeedSameBytes) {
  const auto run = [] {
    Fleet fleet(3, kBytesPerSecond, kBad, 4);
    std::mt19937 random(4);
    explore(fleet, 3, seconds(30), random);
    return std::pair(fleet.network.sent(), fleet.robot(1).layers().at(2).holding.known());
  };
  EXPECT_EQ(run(), run());
}

TEST(Fleet, ARobotInTheMiddleTellsTheOthers) {
  Fleet fleet(3, kBytesPerSecond, {}, 1);
  fleet.set_slice(100, Fleet::kTick);
  fleet.network.cut(1, 3);
  std::mt19937 random(1);
  explore(fleet, 3, seconds(20), random);
  EXPECT_LE(time_to_agree(fleet, seconds(30)), 10);
  EXPECT_FALSE(fleet.robot(1).hears(3, fleet.now()));
}

TEST(Fleet, NothingIsRefused) {
  Fleet fleet(3, kBytesPerSecond, kBad, 2);
  std::mt19937 random(1);
  explore(fleet, 3, seconds(60), random);
  EXPECT_EQ(fleet.refused(), 0U);
}

TEST(Fleet, ALateJoinerGetsEverything) {
  Fleet fleet(4, kBytesPerSecond, kBad, 3);
  fleet.crash(4);
  std::mt19937 random(1);
  explore(fleet, 3, seconds(60), random);
  fleet.start(4, 1);
  fleet.set_slice(100, Fleet::kTick);
  EXPECT_LE(time_to_agree(fleet, seconds(60)), 20);
}

}  // namespace
}  // namespace cairn::fleet
