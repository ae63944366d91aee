// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/missions/mission.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/files/file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/protocol/missions/mission_report.hpp"
#include "tools/protocol/missions/told_states.hpp"

namespace cairn::protocol {
namespace {

using testing::HasSubstr;
using testing::Not;

Mission night() {
  Mission m{.light = "night",
            .pipeline = kByBoth,
            .phase = "final",
            .seconds = 45,
            .raw_bytes = 1'200'000'000,
            .map_bytes = 2'000'000,
            .states_bytes = 22'000,
            .T_world_a = SE3::from_xyz_rpy((Vector6() << 1, 2, 3, 0, 0, 0.5).finished()),
            .world = "recordings/night/robot_1/world.ot"};
  return m;
}

/// All lights, phases and approaches; `ours` is Cairn's RMS, and everybody else's is 0.4 m.
std::vector<MissionOutcome> outcomes(double ours) {
  std::vector<MissionOutcome> all;
  for (const char* light : kLights)
    for (const char* phase : kPhases)
      for (std::size_t k = 0; k < kApproaches.size(); ++k) {
        Mission mission = night();
        mission.light = light;
        mission.phase = phase;
        mission.pipeline = kApproaches.at(k).pipeline;
        MethodRun run{kApproaches.at(k).method, 0, {}, {}};
        run.attempts.push_back({kExactStart, {}, {0.01, 0.1}, 0.1, 10, true, k + 1 == kApproaches.size() ? ours : 0.4});
        all.push_back({mission, k, run, MergedFigures{1000, 10 * (3 - k), 0.1}});
      }
  return all;
}

TEST(Mission, TheFileKeepsEverything) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(save_mission(night(), folder.path() / "mission.json"));
  const auto loaded = load_mission(folder.path() / "mission.json");
  ASSERT_TRUE(loaded) << to_string(loaded.error());
  EXPECT_EQ(name_of(*loaded), "night_both_final");
  EXPECT_EQ(loaded->raw_bytes, 1'200'000'000U);
  EXPECT_EQ(loaded->map_bytes, 2'000'000U);
  EXPECT_EQ(loaded->states_bytes, 22'000U);
  EXPECT_EQ(loaded->seconds, 45);
  EXPECT_EQ(loaded->world, night().world);
  EXPECT_TRUE(loaded->T_world_a.matrix().isApprox(night().T_world_a.matrix(), 1e-12));
}

TEST(Mission, AnotherFileIsRefusedByName) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomic(folder.path() / "mission.json", std::string("[1, 2")));
  const auto loaded = load_mission(folder.path() / "mission.json");
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, Errc::kMalformed);
  EXPECT_THAT(to_string(loaded.error()), HasSubstr("mission.json"));
}

TEST(Mission, ClaimsHoldOnlyWhereCairnIsAsGoodAsJessup) {
  for (const Claim& claim : mission_claims(outcomes(0.35))) EXPECT_TRUE(claim.holds) << claim.claim;
  for (const Claim& claim : mission_claims(outcomes(0.40))) EXPECT_TRUE(claim.holds) << claim.claim;
  int broken = 0;
  for (const Claim& claim : mission_claims(outcomes(0.41))) broken += claim.holds ? 0 : 1;
  EXPECT_EQ(broken, 6);
}

TEST(Mission, TheTablesHaveARowForEachTime) {
  const auto all = outcomes(0.35);
  for (const Table& table : {people_rms_table(all), merged_table(all), bytes_table(all)}) {
    EXPECT_EQ(table.rows.size(), kLights.size() * kPhases.size()) << table.title;
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size()) << table.title;
  }
  EXPECT_THAT(to_text(people_rms_table(all)), HasSubstr("night, final"));
  EXPECT_THAT(to_text(bytes_table(all)), HasSubstr("1200.0"));
}

TEST(Mission, WhatDidNotRunIsADash) {
  auto all = outcomes(0.35);
  all.front().run.reset();
  all.front().merged.reset();
  EXPECT_EQ(people_rms_table(all).rows.front().at(1), "–");
  EXPECT_EQ(merged_table(all).rows.front().at(1), "–");
  EXPECT_TRUE(missions_json(all, 7).at("missions")[0].at("rms_m").is_null());
  EXPECT_EQ(missions_json(all, 7).at("missions")[1].at("ghosts"), 20);
}

TEST(Mission, ThePageStandsAlone) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomic(folder.path() / "1 day.png", std::string("picture")));
  const std::string page = missions_page(outcomes(0.35), 7, folder.path());
  EXPECT_THAT(page, HasSubstr("Seed 7."));
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,cGljdHVyZQ=="));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(missions_page(outcomes(0.35), 7, {}), Not(HasSubstr("<img")));
}

/// A run of two seconds at 10 Hz, with `people` in each row's scan.
void write_run(const support::TemporaryFolder& folder, int people) {
  std::string poses, rows = "t,id,x,y,vx,vy,sigma_m,sightings\n";
  for (int i = 0; i <= 20; ++i) {
    poses += std::to_string(10 + 0.1 * i) + " 0 0 0 0 0 0 1\n";
    for (int id = 1; id <= people; ++id)
      rows += std::to_string(10 + 0.1 * i) + ',' + std::to_string(id) + ",3.5,-1.25,1.1,0.2,0.08,2\n";
  }
  ASSERT_TRUE(write_file_atomic(folder.path() / "trajectory.tum", poses));
  ASSERT_TRUE(write_file_atomic(folder.path() / "people.csv", rows));
}

TEST(ToldStates, CountsAMessageEveryHalfSecond) {
  const support::TemporaryFolder folder;
  write_run(folder, 0);
  const auto alone = told_state_bytes(folder.path());
  ASSERT_TRUE(alone) << to_string(alone.error());
  EXPECT_GT(*alone, 5 * 100U);  // the overhead of five messages
  EXPECT_LT(*alone, 5 * 150U);
  write_run(folder, 8);
  const auto crowded = told_state_bytes(folder.path());
  ASSERT_TRUE(crowded);
  EXPECT_GT(*crowded, *alone + std::uint64_t{5 * 8 * 8});
  EXPECT_LT(*crowded, *alone + std::uint64_t{5 * 8 * 20});
}

TEST(ToldStates, WithoutTheFileNobodyWasFollowed) {
  const support::TemporaryFolder folder;
  write_run(folder, 0);
  const auto none = told_state_bytes(folder.path());
  std::filesystem::remove(folder.path() / "people.csv");
  const auto missing = told_state_bytes(folder.path());
  ASSERT_TRUE(none);
  ASSERT_TRUE(missing) << to_string(missing.error());
  EXPECT_EQ(*missing, *none);
}

TEST(ToldStates, ADamagedRowIsNamed) {
  const support::TemporaryFolder folder;
  write_run(folder, 1);
  ASSERT_TRUE(write_file_atomic(folder.path() / "people.csv", std::string("t,id\n10.0,1,x\n")));
  const auto bytes = told_state_bytes(folder.path());
  ASSERT_FALSE(bytes);
  EXPECT_THAT(to_string(bytes.error()), HasSubstr("line 2"));
}

}  // namespace
}  // namespace cairn::protocol
