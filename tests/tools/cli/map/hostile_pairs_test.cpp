// SPDX-License-Identifier: Apache-2.0
// Valid maps of a few nodes that no memory holds voxel by voxel, matched and merged: a result or a refusal, soon.
#include <gmock/gmock.h>

#include "onboard/mapping/files/map_file.hpp"
#include "tests/support/hostile_maps.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/map/match_command.hpp"
#include "tools/cli/map/merge_command.hpp"

namespace cairn::cli {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

std::vector<std::string> write_hostile_maps(const TemporaryFolder& folder) {
  std::vector<std::string> paths;
  for (const auto& [name, map] : support::hostile_maps()) {
    paths.push_back(folder / (std::to_string(paths.size()) + ".cairn"));
    EXPECT_TRUE(mapping::save_cairn(*map, paths.back()));
  }
  return paths;
}

TEST(HostilePairs, AreMergedOrRefused) {
  const TemporaryFolder folder;
  const auto paths = write_hostile_maps(folder);
  for (const std::string& a : paths)
    for (const std::string& b : paths)
      for (const char* pose : {"--pose=0,0,0,0,0,0", "--pose=1,2,3,0.1,0.2,0.7"}) {
        const Outcome outcome = run(add_merge_command, {"merge", a, b, pose, "--out", folder / "out.cairn"});
        if (outcome.exit_code == app::kDone)
          EXPECT_TRUE(mapping::load_map(folder / "out.cairn")) << a << b << pose;
        else
          EXPECT_THAT(outcome.err,
                      AnyOf(HasSubstr("too large for what came in"), HasSubstr("outside of what a map can hold")))
              << a << b << pose;
      }
}

TEST(HostilePairs, AreMatchedOrRefused) {
  const TemporaryFolder folder;
  const auto paths = write_hostile_maps(folder);
  for (const std::string& b : paths) {
    const Outcome outcome = run(add_match_command, {"match", paths[2], b});
    EXPECT_THAT(outcome.exit_code, AnyOf(app::kDone, app::kFailed)) << b;
    if (outcome.err.empty()) continue;  // a result: accepted or refused
    EXPECT_THAT(outcome.err, HasSubstr("too many occupied voxels")) << b;
  }
}

}  // namespace
}  // namespace cairn::cli
