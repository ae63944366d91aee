// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/merge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "onboard/mapping/files/cairn_file.hpp"
#include "tests/onboard/mapping/random_maps.hpp"

namespace cairn::merging {
namespace {

using Map = std::shared_ptr<const mapping::SemanticOcTree>;

/// Random log-odds in a box, some of it pruned, overlapping with those of other seeds.
Map random_box(unsigned seed, double resolution = 0.1) {
  auto map = std::make_shared<mapping::SemanticOcTree>(resolution);
  std::mt19937 random(seed);
  const int shift = static_cast<int>(seed % 3) * 5;
  for (int i = 0; i < 6000; ++i) {
    const auto key = [&] {
      return static_cast<octomap::key_type>(32768 - 14 + shift + static_cast<int>(random() % 24));
    };
    const octomap::OcTreeKey at(key(), key(), key());
    map->setNodeValue(at, static_cast<float>(random() % 90) * 0.06F - 2.0F, true);
  }
  mapping::saturate_block(*map, seed % 2 == 0);
  map->canonicalise();
  return map;
}

std::vector<std::byte> bytes(const Contributions& contributions, Policy policy = Policy::kRelativeEntropy) {
  const auto merged = merge(contributions, {.policy = policy});
  EXPECT_TRUE(merged);
  EXPECT_TRUE((*merged)->is_canonical());
  EXPECT_EQ((*merged)->size(), (*merged)->calcNumNodes());
  return mapping::encode_cairn(**merged);
}

SE3 some_pose(double yaw) { return SE3::from_xyz_rpy((Vector6() << 0.31, -0.17, 0.08, 0.02, -0.01, yaw).finished()); }

class MergePolicies : public testing::TestWithParam<std::string_view> {
 protected:
  Policy policy = *policy_from(GetParam());
};

TEST_P(MergePolicies, AMapAloneStaysToTheBit) {
  for (unsigned seed = 1; seed < 5; ++seed) {
    const Map a = random_box(seed);
    EXPECT_EQ(bytes({{7, {1, a, {}}}}, policy), mapping::encode_cairn(*a));
  }
}

TEST_P(MergePolicies, ReceivingTwiceLateOrOutOfOrderChangesNothing) {
  const Map a = random_box(1), a_newer = random_box(4), b = random_box(2), c = random_box(3);
  Contributions forward, shuffled;
  for (const auto& [robot, version, map, yaw] :
       {std::tuple{1, 1, a, 0.0}, {2, 1, b, 0.5}, {3, 1, c, -1.0}, {1, 2, a_newer, 0.2}})
    offer(forward, static_cast<std::uint64_t>(robot), {static_cast<std::uint64_t>(version), map, some_pose(yaw)});
  for (const auto& [robot, version, map, yaw] :
       {std::tuple{1, 2, a_newer, 0.2}, {3, 1, c, -1.0}, {1, 1, a, 0.0}, {2, 1, b, 0.5}, {3, 1, c, -1.0}})
    offer(shuffled, static_cast<std::uint64_t>(robot), {static_cast<std::uint64_t>(version), map, some_pose(yaw)});
  EXPECT_EQ(bytes(forward, policy), bytes(shuffled, policy));
}

TEST_P(MergePolicies, WithdrawingARobotGivesTheEarlierBytes) {
  Contributions team{{1, {1, random_box(1), {}}}, {2, {1, random_box(2), some_pose(0.4)}}};
  const auto before = bytes(team, policy);
  offer(team, 3, {1, random_box(3), some_pose(1.1)});
  EXPECT_NE(bytes(team, policy), before);
  team.erase(3);
  EXPECT_EQ(bytes(team, policy), before);
}

/// The slow way: every voxel of the fused grid on its own.
TEST_P(MergePolicies, EveryVoxelIsTheFoldOfWhatTheMapsHaveThere) {
  const Contributions team{{1, {1, random_box(1), {}}},
                           {2, {1, random_box(2, 0.15), some_pose(0.6)}},
                           {5, {1, random_box(3), some_pose(-2)}}};
  const auto merged = merge(team, {.policy = policy});
  ASSERT_TRUE(merged);
  const mapping::SensorModel model = team.begin()->second.map->sensor_model();
  for (int x = -45; x < 45; ++x)
    for (int y = -45; y < 45; ++y)
      for (int z = -30; z < 30; ++z) {
        const Eigen::Vector3d centre = 0.1 * (Eigen::Vector3d(x, y, z).array() + 0.5);
        std::vector<float> opinions;
        for (const auto& [robot, c] : team) {
          const Eigen::Vector3d at = c.T_fused_map.inverse() * centre;
          const auto* node = c.map->search(at.x(), at.y(), at.z());
          if (node != nullptr) opinions.push_back(node->getLogOdds());
        }
        const auto* node = (*merged)->search(centre.x(), centre.y(), centre.z());
        ASSERT_EQ(node != nullptr, !opinions.empty()) << centre.transpose();
        if (node == nullptr) continue;
        ASSERT_EQ(node->getLogOdds(), fold(policy, opinions, {model.min, model.max, model.occupied}));
      }
}

INSTANTIATE_TEST_SUITE_P(All, MergePolicies, testing::ValuesIn(policy_names()),
                         [](const auto& p) { return std::string(p.param); });

TEST(Merge, EqualMapsOfTwoRobotsAreThatMap) {
  const Map a = random_box(1);
  for (const Policy policy : {Policy::kRelativeEntropy, Policy::kRelativeEntropyWeighted, Policy::kAverage})
    EXPECT_EQ(bytes({{1, {1, a, {}}}, {2, {1, a, {}}}}, policy), mapping::encode_cairn(*a));
}

TEST(Merge, EmptyMapsAndImpossiblePosesAreClear) {
  const auto empty = std::make_shared<mapping::SemanticOcTree>(0.1);
  const auto nothing = merge({{1, {1, empty, {}}}});
  ASSERT_TRUE(nothing);
  EXPECT_EQ((*nothing)->size(), 0U);
  EXPECT_EQ(merge({}).error().code, Errc::kInvalidConfig);
  EXPECT_EQ(merge({{1, {1, nullptr, {}}}}).error().code, Errc::kInvalidConfig);
  const SE3 nan(Eigen::Quaterniond::Identity(), {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  EXPECT_EQ(merge({{1, {1, random_box(1), nan}}}).error().code, Errc::kInvalidConfig);
  const SE3 far(Eigen::Quaterniond::Identity(), {1e12, 0, 0});  // outside of any tree
  const auto lost = merge({{1, {1, random_box(1), far}}});
  ASSERT_TRUE(lost);
  EXPECT_EQ((*lost)->size(), 0U);
}

/// A map at the edge of its own tree, and one that reaches beyond the edge of the fused one.
TEST(Merge, AtTheEdgeOfATreeNothingIsMadeUp) {
  auto corner = std::make_shared<mapping::SemanticOcTree>(0.1);
  std::mt19937 random(6);
  const auto key = [&] { return static_cast<octomap::key_type>(65535 - random() % 12); };
  for (int i = 0; i < 500; ++i) corner->setNodeValue(octomap::OcTreeKey(key(), key(), key()), float(random() % 3));
  const Eigen::Vector3d edge = Eigen::Vector3d::Constant(3276.8 - 0.6);
  const Contributions team{{1, {1, corner, some_pose(0.5) * SE3(Eigen::Quaterniond::Identity(), -edge)}},
                           {2, {1, random_box(2), SE3(Eigen::Quaterniond::Identity(), edge) * some_pose(0.4)}}};
  const auto merged = merge(team, {.policy = Policy::kStitch});
  ASSERT_TRUE(merged);
  int known = 0;
  for (auto leaf = (*merged)->begin_leafs(), end = (*merged)->end_leafs(); leaf != end; ++leaf) {
    const auto at = leaf.getCoordinate();
    const Eigen::Vector3d centre(at.x(), at.y(), at.z());
    const Contribution& c = team.at(centre.x() > 1000 ? 2 : 1);
    const Eigen::Vector3d there = c.T_fused_map.inverse() * centre;
    if (leaf.getDepth() < mapping::SemanticOcTree::kDepth ||
        (there / 0.1 - (there / 0.1).array().round().matrix()).cwiseAbs().minCoeff() < 0.01)
      continue;  // coordinates are floats, too coarse out there to tell on which side of a voxel's border they lie
    const auto* node = c.map->search(there.x(), there.y(), there.z());
    ASSERT_NE(node, nullptr) << centre.transpose();
    EXPECT_EQ(leaf->getLogOdds(), node->getLogOdds());
    known += centre.x() > 1000 ? 1 : 1000;
  }
  EXPECT_GT(known % 1000, 20);
  EXPECT_GT(known / 1000, 200);
}

TEST(Merge, LonelyVoxelsAreNotTooLargeWhereverTheyLie) {
  auto dust = std::make_shared<mapping::SemanticOcTree>(0.1);
  std::mt19937 random(5);
  const auto key = [&] { return static_cast<octomap::key_type>(20000 + random() % 30000); };
  for (int i = 0; i < 800; ++i) dust->setNodeValue(octomap::OcTreeKey(key(), key(), key()), 1.0F);
  const auto merged = merge({{1, {1, random_box(1), {}}}, {2, {1, dust, some_pose(0.4)}}});
  ASSERT_TRUE(merged);
  EXPECT_GT((*merged)->size(), dust->size() / 2);
}

TEST(Merge, OneCubeThatStandsForMillionsIsRefused) {
  auto cube = std::make_shared<mapping::SemanticOcTree>(0.1);
  bool made = false;
  mapping::SemanticNode* node = cube->root_or_new(made);
  for (int depth = 0; depth < 6; ++depth) node = cube->writer(0).child(node, depth == 0 ? 7 : 0, made);
  node->setLogOdds(-1.0F);
  cube->settle_count();
  cube->canonicalise();
  const auto merged = merge({{1, {1, random_box(1), {}}}, {2, {1, cube, some_pose(0.4)}}});
  ASSERT_FALSE(merged);
  EXPECT_EQ(merged.error().code, Errc::kLimit);
}

}  // namespace
}  // namespace cairn::merging
