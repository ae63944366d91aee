// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/files/map_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "hal/files/file.hpp"
#include "tests/onboard/mapping/random_maps.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::mapping {
namespace {

namespace fs = std::filesystem;

class MapFile : public testing::Test {
 protected:
  support::TemporaryFolder folder;
  std::unique_ptr<SemanticOcTree> tree = random_map<SemanticOcTree>(2, 500);
};

TEST_F(MapFile, TheContentDecidesNotTheName) {
  ASSERT_TRUE(save_cairn(*tree, folder / "a.bt", "x"));
  ASSERT_TRUE(save_ot(*tree, folder / "b.cairn"));
  ASSERT_TRUE(save_bt(*tree, folder / "c"));
  for (const char* name : {"a.bt", "b.cairn"}) {
    const auto back = load_map(folder / name);
    ASSERT_TRUE(back) << to_string(back.error());
    EXPECT_EQ(differing_nodes(**back, *tree), 0U) << name;
  }
  const auto likely = load_map(folder / "c");
  ASSERT_TRUE(likely) << to_string(likely.error());
  EXPECT_EQ(encode_bt(**likely), encode_bt(*tree));
}

TEST_F(MapFile, ErrorsNameTheFile) {
  const auto missing = load_map(folder / "missing.cairn");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::kNotFound);
  std::ofstream(folder / "text.ot") << "hello";
  const auto text = load_map(folder / "text.ot");
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, Errc::kUnsupported);
  EXPECT_EQ(text.error().where, (folder / "text.ot").string());
  MapLimits limits;
  limits.max_file_bytes = 3;
  EXPECT_EQ(load_map(folder / "text.ot", limits).error().code, Errc::kLimit);
}

TEST_F(MapFile, AFailedSaveKeepsTheOldMap) {
  ASSERT_TRUE(save_cairn(*tree, folder / "map.cairn"));
  fs::create_directory(folder / "map.cairn.tmp");  // the temporary file cannot be made
  tree->updateNode(octomap::OcTreeKey(1, 1, 1), true);
  EXPECT_FALSE(save_cairn(*tree, folder / "map.cairn"));
  const auto old = load_map(folder / "map.cairn");
  ASSERT_TRUE(old);
  EXPECT_EQ(differing_nodes(**old, *random_map<SemanticOcTree>(2, 500)), 0U);
}

TEST_F(MapFile, PointFilesHoldTheOccupiedVoxels) {
  ASSERT_TRUE(save_ply(*tree, folder / "map.ply"));
  ASSERT_TRUE(save_pcd(*tree, folder / "map.pcd"));
  EXPECT_EQ(read_file(folder / "map.ply", 1U << 24).value(), encode_ply(occupied_voxel_centres(*tree).value()));
  EXPECT_EQ(read_file(folder / "map.pcd", 1U << 24).value(), encode_pcd(occupied_voxel_centres(*tree).value()));
}

}  // namespace
}  // namespace cairn::mapping
