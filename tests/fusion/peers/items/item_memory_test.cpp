// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/items/item_memory.hpp"

#include <gtest/gtest.h>

#include "fusion/peers/items/tile_codec.hpp"
#include "fusion/team/team.hpp"
#include "tests/fusion/peers/tile_states.hpp"

namespace cairn::peers {
namespace {

/// Every voxel differs from its neighbours: no tree can be larger.
mapping::TileState checkerboard(unsigned odd) {
  mapping::TileState state;
  for (unsigned i = 0; i < 512; ++i)
    state.set(i % 8, i / 8 % 8, i / 64, (i + i / 8 + i / 64) % 2 == odd ? 3.5F : -1.6F);
  return state;
}

std::size_t blocks_in(const mapping::SemanticNode* node) {
  if (node == nullptr || node->block() == nullptr) return 0;
  std::size_t blocks = 1;
  for (unsigned i = 0; i < mapping::SemanticNode::kChildren; ++i) blocks += blocks_in(node->block() + i);
  return blocks;
}

TEST(ItemMemory, ATreeNeverNeedsMoreBlocks) {
  constexpr std::size_t kAbove = 16 - mapping::TileKey::kVoxelBits;  // blocks on the way down to a tile
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    mapping::TileState state = round == 0 ? checkerboard(0) : wall_tile_state(random);
    if (round % 2 == 1) state = with_labels(state, random, 5);
    mapping::SemanticOcTree map(0.2);
    mapping::write_tile(map, mapping::TileKey::of_voxel(32768, 32768, 32768), state);
    EXPECT_LE(blocks_in(map.getRoot()), blocks_of(state) + kAbove);
  }
  EXPECT_EQ(blocks_of(checkerboard(0)), 64U + 9U);
  mapping::TileState even;
  for (unsigned i = 0; i < 512; ++i) even.set(i % 8, i / 8 % 8, i / 64, -1.6F);
  EXPECT_EQ(blocks_of(even), 9U);
}

TEST(ItemMemory, ALiarsCheckerboardsStayWithinWhatIsKeptOfARobot) {
  constexpr std::size_t kMost = std::size_t{8} << 20U;
  team::TeamConfig config;
  config.id = 1;
  config.exchange.max_bytes_per_robot = kMost / 2;
  config.exchange.spare_bytes = kMost / 2;
  config.exchange.bytes_per_second = 1'000'000;
  team::Team honest(config, Epoch{1} << 32U);
  Exchange liar(2, "liar", Epoch{1} << 32U, {.bytes_per_second = 10'000'000, .voxel_um = 200'000});
  UncertainPose pose;
  pose.covariance = 1e-4 * Matrix6::Identity();
  std::vector<std::byte> payload;
  for (std::uint16_t i = 0; i < 1500; ++i) {
    payload.clear();
    encode_tile(checkerboard(i % 2), payload);
    liar.say(ItemId::tile(0, mapping::TileKey::of_voxel(static_cast<std::uint16_t>(8 * i), 32768, 32768)), payload);
  }
  liar.say(ItemId::edge(0), encode(Edge{0, 1, Epoch{1} << 32U, 0, pose, 0.99F}));
  Time now{};
  for (int i = 0; i < 100; ++i, now += std::chrono::milliseconds(100)) {
    std::vector<Outgoing> from_honest, from_liar;
    honest.step(now, from_honest);
    liar.send(now, from_liar);
    for (const auto& datagram : from_honest) (void)liar.receive(datagram.bytes, now);
    for (const auto& datagram : from_liar) (void)honest.receive(datagram.bytes, now);
    Budget all = Budget::steps(1'000'000);
    while (!honest.fuse(all)) continue;
  }
  const Holding& held = honest.exchange().layers().at(2).holding;
  EXPECT_GT(held.items().size(), 300U);
  EXPECT_LT(held.items().size(), 500U) << "some 20 kB each";
  EXPECT_LE(held.bytes(), kMost);
  EXPECT_LE(2 * honest.map().map().memoryUsage(), kMost);
}

}  // namespace
}  // namespace cairn::peers
