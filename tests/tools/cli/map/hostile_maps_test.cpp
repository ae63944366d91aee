// SPDX-License-Identifier: Apache-2.0
// Valid maps of a few nodes that no memory holds voxel by voxel: each command ends soon, with a result or a refusal.
#include <gmock/gmock.h>

#include "onboard/mapping/files/map_file.hpp"
#include "tests/support/hostile_maps.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/map/evaluate_command.hpp"
#include "tools/cli/map/map_command.hpp"

namespace cairn::cli {
namespace {

using testing::HasSubstr;

class HostileMaps : public testing::Test {
 protected:
  HostileMaps() {
    for (const auto& [name, map] : support::hostile_maps()) {
      paths_.push_back(folder_ / ("map" + std::to_string(paths_.size()) + ".cairn"));
      EXPECT_TRUE(mapping::save_cairn(*map, paths_.back()));
    }
  }
  Outcome map(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "map");
    return run(add_map_command, std::move(arguments));
  }

  TemporaryFolder folder_;
  std::vector<std::string> paths_;
};

TEST_F(HostileMaps, AreDescribedDrawnAndCompared) {
  for (const std::string& path : paths_) {
    EXPECT_EQ(map({"info", path}).exit_code, app::kDone) << path;
    EXPECT_EQ(map({"compare", path, paths_.front()}).exit_code, app::kDone) << path;
    const Outcome drawn = map({"render", path, "--out", folder_ / "a.png"});
    EXPECT_EQ(drawn.exit_code, app::kDone) << drawn.err;
  }
}

TEST_F(HostileMaps, AreExportedAsCubesAndNotAsPoints) {
  for (const std::string& path : paths_)
    for (const char* name : {"a.cairn", "a.ot", "a.bt"}) {
      ASSERT_EQ(map({"export", path, "--out", folder_ / name}).exit_code, app::kDone) << path << name;
      EXPECT_EQ(map({"info", folder_ / name}).exit_code, app::kDone) << "Cairn reads what it writes";
    }
  const Outcome refused = map({"export", paths_.front(), "--out", folder_ / "a.ply"});
  EXPECT_EQ(refused.exit_code, app::kFailed);
  EXPECT_THAT(refused.err, HasSubstr("281474976710656 voxels in 1 nodes"));
  EXPECT_THAT(refused.err, HasSubstr("Export it as .cairn, .ot or .bt"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.ply"));
}

TEST_F(HostileMaps, AreRefusedAsEstimateAndAsTruth) {
  const std::string corners = paths_[2];
  const auto evaluate = [](const std::string& estimate, const std::string& truth) {
    return run(add_evaluate_command, {"evaluate", "map", estimate, "--ground-truth", truth});
  };
  EXPECT_EQ(evaluate(corners, corners).exit_code, app::kDone) << "two voxels";
  for (const auto& [estimate, truth] : {std::pair{paths_.front(), corners}, std::pair{corners, paths_.front()}}) {
    const Outcome outcome = evaluate(estimate, truth);
    EXPECT_EQ(outcome.exit_code, app::kFailed);
    EXPECT_THAT(outcome.err, HasSubstr(paths_.front())) << "the file that cannot be compared";
  }
}

}  // namespace
}  // namespace cairn::cli
