// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/files/file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/protocol/unlike/unlike_report.hpp"
#include "tools/protocol/unlike/unlike_tables.hpp"

namespace cairn::protocol {
namespace {

using testing::HasSubstr;
using testing::Not;

MethodRun one_start(const char* method, double rms_m) {
  MethodRun r{method, 0.1, {}, {}};
  r.attempts.push_back({kExactStart, {}, {0.05, 0.2}, 0.2, 10, true, rms_m});
  return r;
}

Entropies entropies(double occupancy, double label) {
  return {.occupied = 100, .labelled = 50, .occupancy = occupancy, .book = occupancy / 2, .label = label};
}

/// Two scenes with three fusions each; `fused`: the entropies of the fused map, those of the robots are 0.4 and 0.3.
std::vector<UnlikeOutcome> two_missions(double fused) {
  std::vector<UnlikeOutcome> all;
  for (const char* scene : {"carpark", "street"})
    for (int fusion = 1; fusion <= 3; ++fusion) {
      UnlikeOutcome o;
      o.outcome.pair.name = std::string(scene) + '_' + std::to_string(fusion);
      o.outcome.pair.scene = scene;
      o.outcome.pair.kind = kUnlike;
      o.outcome.runs = {one_start("oicp", 0.3), one_start("em", 0.25 - 0.01 * fusion), one_start("default", 0.2),
                        one_start("em_book", 0.28)};
      o.outcome.runs[1].correspondences = 4 - fusion;
      o.moment = {fusion, 10.0 * fusion};
      o.attempt = o.outcome.runs[2].attempts[0];
      o.merge_s = 0.05;
      if (fusion == 3) {
        const EntropiesOfThree three{entropies(0.4, 0.3), entropies(0.3, 0.4), entropies(fused, fused)};
        o.entropies = {three, three, three};
        o.pictures.push_back({"carpark, UGV", {std::byte{1}, std::byte{2}}});
      }
      all.push_back(std::move(o));
    }
  return all;
}

int broken(const std::vector<Claim>& claims, const std::string& about) {
  int count = 0;
  for (const Claim& c : claims) count += !c.holds && c.claim.find(about) != std::string::npos ? 1 : 0;
  return count;
}

TEST(Unlike, TheFusedMapMustBeSurerThanEitherRobots) {
  EXPECT_EQ(broken(unlike_claims(two_missions(0.29)), "entropy"), 0);
  EXPECT_EQ(broken(unlike_claims(two_missions(0.30)), "entropy"), 12)
      << "occupancy and label; both of them are at 0.33";
  EXPECT_EQ(broken(unlike_claims(two_missions(0.38)), "entropy"), 18);
}

TEST(Unlike, WhatTheBookSaysIsMeasured) {
  const auto all = two_missions(0.2);
  EXPECT_EQ(broken(unlike_claims(all), "RMS"), 0);
  EXPECT_EQ(broken(unlike_claims(all), "correspondences"), 0);
  EXPECT_EQ(broken(unlike_claims(all), "takes less time"), 0);
  auto worse = all;
  worse[2].outcome.runs[1].attempts[0].rms_m = 0.5;
  worse[2].outcome.runs[1].correspondences = 5;
  worse[1].merge_s = 11;
  EXPECT_EQ(broken(unlike_claims(worse), "RMS"), 2);
  EXPECT_EQ(broken(unlike_claims(worse), "correspondences"), 1);
  EXPECT_EQ(broken(unlike_claims(worse), "takes less time"), 1);
}

TEST(Unlike, TheLabelsOfTheBookNeedAChosenShare) {
  const auto claims = unlike_claims(two_missions(0.2));
  EXPECT_EQ(broken(claims, "with one share chosen"), 0);
  EXPECT_EQ(broken(claims, "with nothing chosen"), 2);
}

TEST(Unlike, RowsAreAsLongAsTheirHeaders) {
  for (const Table& table : unlike_tables(two_missions(0.2))) {
    EXPECT_FALSE(table.rows.empty()) << table.title;
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size()) << table.title;
  }
  EXPECT_THAT(to_text(fused_table(two_missions(0.2))), HasSubstr("0.4000"));
  EXPECT_THAT(to_text(fusions_table(two_missions(0.2))), HasSubstr("street, 3"));
}

TEST(Unlike, AMethodThatDidNotRunIsADash) {
  auto all = two_missions(0.2);
  for (UnlikeOutcome& o : all) o.outcome.runs.erase(o.outcome.runs.begin(), o.outcome.runs.begin() + 2);
  EXPECT_EQ(unlike_rms_table(all).rows.front().at(2), "–");
  EXPECT_EQ(broken(unlike_claims(all), "RMS"), 0);
  EXPECT_THAT(unlike_page(all, 1), HasSubstr("</html>"));
}

TEST(Unlike, WhatNoVoxelHasIsADashAndNoClaim) {
  auto all = two_missions(0.2);
  all[2].entropies->shared = {};
  all[2].entropies->whole.fused.labelled = 0;
  for (MethodRun& r : all[0].outcome.runs) r.attempts[0].rms_m = 0;
  EXPECT_EQ(shared_table(all).rows.front().at(1), "–");
  EXPECT_EQ(fused_table(all).rows.front().at(4), "–");
  EXPECT_EQ(unlike_rms_table(all).rows.front().at(2), "–");
  EXPECT_EQ(unlike_claims(two_missions(0.2)).size() - unlike_claims(all).size(), 5U);
  EXPECT_EQ(broken(unlike_claims(all), "RMS"), 0);
}

TEST(Unlike, OneFusionShowsNoTrend) {
  const auto all = two_missions(0.2);
  const std::vector<UnlikeOutcome> one{all[2]};
  for (const Claim& c : unlike_claims(one)) {
    EXPECT_THAT(c.claim, Not(HasSubstr("falls")));
    EXPECT_THAT(c.claim, Not(HasSubstr("fall as")));
  }
}

TEST(Unlike, ThePageStandsAlone) {
  const std::string page = unlike_page(two_missions(0.5), 72001);
  for (const char* mark : {"<script", "href=", "url(", "nan"}) EXPECT_THAT(page, Not(HasSubstr(mark)));
  for (const char* mark : {"Seed 72001, flights 72002.", "Table 7.5", "Fig. 5.13", "Fig. 5.14", "<svg", "not so here",
                           "data:image/png;base64,AQI="})
    EXPECT_THAT(page, HasSubstr(mark));
}

TEST(Unlike, JsonHasTheFieldsThatScriptsRelyOn) {
  const Json json = unlike_json(two_missions(0.2), 5);
  EXPECT_EQ(json.at("seed"), 5);
  EXPECT_EQ(json.at("fusions").size(), 6U);
  EXPECT_EQ(json["fusions"][0].at("methods")[1].at("correspondences"), 3);
  EXPECT_EQ(json.at("entropies").size(), 2U);
  EXPECT_EQ(json["entropies"][1].at("whole").at("fused").at("occupancy"), 0.2);
  EXPECT_EQ(json.at("labels").size(), 6U);
  EXPECT_FALSE(json.at("claims").empty());
}

TEST(UnlikePairs, AMomentComesBackFromItsFile) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(save_moment({4, 20.5}, folder / "moment.json"));
  const auto back = load_moment(folder / "moment.json");
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(back->fusion, 4);
  EXPECT_EQ(back->seconds, 20.5);
  ASSERT_TRUE(write_file_atomic(folder / "moment.json", std::string_view("{\"fusion\": 4}")));
  EXPECT_FALSE(load_moment(folder / "moment.json"));
}

TEST(UnlikePairs, WithoutRunsTheFolderIsNamed) {
  const support::TemporaryFolder folder;
  const auto made = make_unlike({.recordings = folder.path(), .runs = folder.path(), .out = folder.path()});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, Errc::kNotFound);
  EXPECT_FALSE(load_unlike(folder / "nowhere"));
}

}  // namespace
}  // namespace cairn::protocol
