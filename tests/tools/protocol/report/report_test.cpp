// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/files/file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/protocol/report/claims.hpp"
#include "tools/protocol/report/tables.hpp"

namespace cairn::protocol {
namespace {

using testing::HasSubstr;
using testing::Not;

MethodRun run(const std::string& method, double m, double deg) {
  MethodRun r{method, 0.25, {}, {}};
  for (const int start : chosen_starts(4)) r.attempts.push_back({start, {}, {m, deg}, 0.04, 12, true, {}});
  return r;
}

PairOutcome scene(std::string name, const char* kind, double overlap) {
  PairOutcome p;
  p.pair.name = p.pair.scene = std::move(name);
  p.pair.kind = kind;
  p.pair.overlap = overlap;
  p.pair.voxels_a = 1000;
  p.pair.voxels_b = 2000;
  return p;
}

/// All methods in the corridor, ICP failing; a LiDAR's map in three phases; one step of falling overlap.
Outcome outcome() {
  Outcome all;
  PairOutcome corridor = scene("corridor", kScene, 0.48);
  for (const std::string_view m : table_methods())
    corridor.runs.push_back(m == "icp" ? run("icp", 1.5, 20) : run(std::string(m), 0.01, 0.05));
  corridor.entropies = {{"relative_entropy", 0.3, 0.2, 10}, {"average", 0.4, 0.3, 10}, {"stitch", 0.35, 0.4, 12}};
  all.pairs.push_back(std::move(corridor));
  for (const auto& [overlap, error_m] : {std::pair{0.1, 5.0}, {0.2, 0.7}, {0.3, 0.01}}) {
    PairOutcome cut = scene("lobby", kOverlap, overlap);
    cut.runs = {run("default", error_m, 0.1), run("pmm", 3, 1)};
    cut.runs[1].attempts.pop_back();
    all.pairs.push_back(std::move(cut));
  }
  double correspondences = 3;
  for (const char* phase : {"end", "middle", "start"}) {
    PairOutcome p = scene(std::string("lidar_rgbd_") + phase, kHeterogeneous, 0.5);
    p.runs = {run("oicp", 0.4, 1), run("em", 0.1, 1), run("default", 0.1, 1), run("em_book", 0.2, 1)};
    for (MethodRun& r : p.runs)
      for (Attempt& a : r.attempts) a.rms_m = r.method == "em" ? 0.2 : 0.3;
    p.runs[1].correspondences = correspondences++;
    all.pairs.push_back(std::move(p));
  }
  return all;
}

TEST(Report, JsonHasTheFieldsThatScriptsRelyOn) {
  const Json json = to_json(outcome());
  ASSERT_EQ(json.at("scenes").size(), 1U);
  const Json& s = json["scenes"][0];
  EXPECT_EQ(s.at("name"), "corridor");
  EXPECT_EQ(s.at("voxels_a"), 1000);
  EXPECT_EQ(s.at("voxels_b"), 2000);
  EXPECT_EQ(s.at("overlap"), 0.48);
  std::vector<std::string> methods;
  for (const Json& m : s.at("methods")) {
    methods.push_back(m.at("method"));
    EXPECT_DOUBLE_EQ(m.at("success"), m["method"] == "icp" ? 0 : 1);
    EXPECT_NEAR(m.at("mean_error_m").get<double>(), m["method"] == "icp" ? 1.5 : 0.01, 1e-12);
    EXPECT_NEAR(m.at("mean_error_deg").get<double>(), m["method"] == "icp" ? 20 : 0.05, 1e-12);
    EXPECT_NEAR(m.at("seconds").get<double>(), 0.04, 1e-12);
    EXPECT_DOUBLE_EQ(m.at("iterations"), 12);
  }
  for (const char* name : {"icp", "p2plane", "gicp", "ndt", "oicp", "pmm_level1", "pmm", "em", "default"})
    EXPECT_THAT(methods, testing::Contains(name));
  EXPECT_EQ(json.at("overlaps").size(), 3U);
  EXPECT_EQ(json.at("heterogeneous").size(), 3U);
}

TEST(Report, ClaimsAreMeasuredNotAssumed) {
  const auto claims = claims_of(outcome());
  const auto holds = [&](const std::string& text) {
    for (const Claim& c : claims)
      if (c.claim.find(text) != std::string::npos) return c.holds;
    ADD_FAILURE() << "nothing is said about: " << text;
    return false;
  };
  EXPECT_TRUE(holds("corridor: the default succeeds"));
  EXPECT_TRUE(holds("corridor: fused entropy of relative entropy < average"));
  EXPECT_FALSE(holds("corridor: fused entropy of average < stitch"));  // by one of the two entropies only
  EXPECT_FALSE(holds("fewer iterations than ICP on edges"));
  EXPECT_TRUE(holds("RMS of Cairn's EM"));
  EXPECT_TRUE(holds("correspondences of Cairn's EM fall"));
  EXPECT_FALSE(holds("lobby: the default succeeds from ≥ 90 % of the starts at each overlap"));
}

TEST(Report, TheSeriesOfOverlapsFallsAndSaysFromHowManyStarts) {
  const Outcome all = outcome();
  const auto cut = all.by_falling_overlap();
  ASSERT_EQ(cut.size(), 3U);
  EXPECT_EQ(cut.front()->pair.overlap, 0.3);
  EXPECT_EQ(cut.back()->pair.overlap, 0.1);
  EXPECT_EQ(all.starts_told(kOverlap), "From 4 starts; from 3: PMM. ");
  EXPECT_THAT(claims_of(all).at(2).figures, HasSubstr("100.0 % at 30 %, 0.0 % at 20 %"));
}

TEST(Report, TablesPutTheBooksNumbersBeside) {
  const std::string errors = to_text(errors_table(outcome()));
  EXPECT_THAT(errors, HasSubstr("20.00 1.500 (31.39 1.63)"));
  EXPECT_THAT(errors, HasSubstr("0.05 0.010 (12.06 0.62)"));  // PMM level 1
  EXPECT_THAT(to_text(times_table(outcome())), HasSubstr("0.040 + 0.25 (3.14)"));
  EXPECT_THAT(to_text(entropies_table(outcome())), HasSubstr("0.3000 / 0.2000"));
  EXPECT_THAT(to_text(overlap_table(outcome())), HasSubstr("100 / 0.01"));
  const std::string rms = to_text(rms_table(outcome()));
  EXPECT_THAT(rms, HasSubstr("0.67"));
  EXPECT_LT(rms.find("start"), rms.find("middle"));
  for (const Table& t : all_tables(outcome()))
    for (const auto& row : t.rows) EXPECT_EQ(row.size(), t.header.size()) << t.title;
}

TEST(Report, PageIsSelfContainedAndNeedsNoRun) {
  const std::string page = to_page(outcome());
  for (const char* mark : {"src=", "href=", "<script", "@import", "url("}) EXPECT_THAT(page, Not(HasSubstr(mark)));
  for (const char* mark : {"<svg", "class=\"box", "Fig. 4.11", "Table 5.2", "not so here"})
    EXPECT_THAT(page, HasSubstr(mark));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
  EXPECT_THAT(to_page({}), HasSubstr("</html>"));
}

TEST(Report, RunsComeBackFromTheirFile) {
  const support::TemporaryFolder folder;
  MethodRun em = run("em", 0.125, 2.5);
  em.correspondences = 1.75;
  em.attempts[0].rms_m = 0.3;
  em.attempts[0].T_a_b = SE3::from_xyz_rpy((Vector6() << 1, 2, 3, 0.1, 0.2, 0.3).finished());
  ASSERT_TRUE(save_runs({em, run("icp", 1, 1)}, folder.path() / "runs.json"));
  const auto back = load_runs(folder.path() / "runs.json");
  ASSERT_TRUE(back) << to_string(back.error());
  ASSERT_EQ(back->size(), 2U);
  const Attempt &a = back->front().attempts[0], &b = em.attempts[0];
  EXPECT_EQ(back->front().correspondences, em.correspondences);
  EXPECT_EQ(a.rms_m, b.rms_m);
  EXPECT_EQ(a.error.deg, b.error.deg);
  EXPECT_TRUE(a.accepted);
  EXPECT_LT((a.T_a_b.matrix() - b.T_a_b.matrix()).cwiseAbs().maxCoeff(), 1e-15);
  ASSERT_TRUE(write_file_atomic(folder.path() / "runs.json", std::string_view("[{\"method\": 1}]")));
  EXPECT_FALSE(load_runs(folder.path() / "runs.json"));
}

}  // namespace
}  // namespace cairn::protocol
