// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/items/tile_codec.hpp"

#include <gtest/gtest.h>

#include "tests/fusion/peers/tile_states.hpp"
#include "tests/support/rounds.hpp"

namespace cairn::peers {
namespace {

std::vector<std::byte> encoded(const mapping::TileState& state) {
  std::vector<std::byte> bytes;
  encode_tile(state, bytes);
  return bytes;
}

/// Whether a tile is still one after some of its bits were turned and bytes cut off or added; then there must be no
/// other way to write it.
bool decodes_damaged(std::vector<std::byte> bytes, std::mt19937& random) {
  for (auto changes = 1 + random() % 2; changes > 0; --changes)
    bytes[random() % bytes.size()] ^= static_cast<std::byte>(1U << random() % 8);
  if (random() % 4 == 0) bytes.resize(random() % (bytes.size() + 3));
  const auto decoded = decode_tile(bytes);
  if (!decoded) return false;
  EXPECT_TRUE(decoded->valid());
  EXPECT_EQ(encoded(*decoded), bytes);
  return true;
}

TEST(TileCodec, DecodesWhatItEncodes) {
  std::mt19937 random(1);
  for (int i = 0; i < 3000; ++i) {
    const mapping::TileState state = random_tile_state(random);
    const auto bytes = encoded(state);
    ASSERT_LE(bytes.size(), kMaxTileBytes);
    const auto decoded = decode_tile(bytes);
    ASSERT_TRUE(decoded.has_value());
    ASSERT_EQ(*decoded, state);
  }
}

TEST(TileCodec, LabelsComeBackAndCostNothingWhereThereAreNone) {
  std::mt19937 random(4);
  for (int i = 0; i < 2000; ++i) {
    const mapping::TileState plain = random_tile_state(random);
    const auto kinds = static_cast<unsigned>(1 + random() % mapping::VoxelLabel::kCodes);
    const mapping::TileState state = with_labels(plain, random, kinds);
    const auto bytes = encoded(state);
    ASSERT_LE(bytes.size(), kMaxTileBytes);
    const auto decoded = decode_tile(bytes);
    ASSERT_TRUE(decoded.has_value());
    ASSERT_EQ(*decoded, state);
    ASSERT_EQ(has_occupied(bytes), plain.any_occupied());
    if (state.labels.empty()) {
      ASSERT_EQ(bytes, encoded(plain));
    }
  }
}

TEST(TileCodec, OnlyOneFormOfLabelsIsTaken) {
  std::mt19937 random(5);
  const int tries = support::rounds(30000, 5000);
  int decoded_ones = 0;
  for (int i = 0; i < tries; ++i) {
    const mapping::TileState wall = wall_tile_state(random);
    const auto kinds = static_cast<unsigned>(1 + random() % 20);
    decoded_ones += decodes_damaged(encoded(with_labels(wall, random, kinds)), random) ? 1 : 0;
  }
  EXPECT_GT(decoded_ones, tries / 30);
}

TEST(TileCodec, ATileOfOneKindIsOneByte) {
  for (const float value : {-1.6F, -0.4F, 0.5F, 1.5F, 2.5F, 3.5F}) {
    mapping::TileState state;
    for (unsigned i = 0; i < 512; ++i) state.set(i % 8, i / 8 % 8, i / 64, value);
    EXPECT_EQ(encoded(state).size(), 1U);
    EXPECT_EQ(decode_tile(encoded(state)).value(), state);
  }
}

TEST(TileCodec, TheWorstTileFits) {
  std::mt19937 random(2);
  mapping::TileState worst;
  for (unsigned i = 0; i < 512; ++i)
    if (i % 2 == (i / 8 + i / 64) % 2) worst.set(i % 8, i / 8 % 8, i / 64, i % 4 < 2 ? -0.4F : 1.5F);
  worst = with_labels(worst, random, 16);
  EXPECT_FALSE(worst.labels.empty());
  EXPECT_LE(encoded(worst).size(), kMaxTileBytes);
}

TEST(TileCodec, WhateverIsDecodedHasTheseBytesAndNoOthers) {
  std::mt19937 random(3);
  const int tries = support::rounds(30000, 5000);
  int decoded_ones = 0;
  for (int i = 0; i < tries; ++i) decoded_ones += decodes_damaged(encoded(random_tile_state(random)), random) ? 1 : 0;
  EXPECT_GT(decoded_ones, tries / 30);
}

TEST(TileCodec, EveryPrefixIsRefused) {
  std::mt19937 random(4);
  for (int i = 0; i < 200; ++i) {
    const auto bytes = encoded(random_tile_state(random));
    for (std::size_t n = 0; n < bytes.size(); ++n) ASSERT_FALSE(decode_tile(std::span(bytes).first(n)).has_value());
  }
}

}  // namespace
}  // namespace cairn::peers
