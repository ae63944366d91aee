// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/files/cairn_file.hpp"

#include <gtest/gtest.h>
#include <zstd.h>

#include "hal/bytes.hpp"
#include "onboard/mapping/files/cairn_format.hpp"
#include "onboard/mapping/tree/label_evidence.hpp"
#include "onboard/mapping/tree/tile_state.hpp"
#include "tests/onboard/mapping/random_maps.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"

namespace cairn::mapping {
namespace {

using Bytes = std::vector<std::byte>;

/// A file whose only chunk holds these bytes; everything around it is right.
Bytes file_with(const std::vector<std::uint8_t>& structure, const std::vector<float>& values, std::uint64_t nodes,
                std::uint32_t extra_length = 0) {
  Bytes raw;
  append_le(raw, static_cast<std::uint32_t>(structure.size() + extra_length));
  for (const std::uint8_t s : structure) append_le(raw, s);
  for (const float v : values) append_le(raw, v);
  Bytes frame(ZSTD_compressBound(raw.size()));
  frame.resize(ZSTD_compress(frame.data(), frame.size(), raw.data(), raw.size(), 1));
  const cairn_format::Chunk chunk{static_cast<std::uint32_t>(raw.size()), static_cast<std::uint32_t>(frame.size()),
                                  cairn_format::hash(frame)};
  return cairn_format::assemble({0.1, SemanticOcTree(0.1).sensor_model(), nodes, {}, {chunk}, 0}, frame);
}

std::string_view cause(const Result<std::unique_ptr<SemanticOcTree>>& result) {
  return result ? "no error" : result.error().cause;
}

class CairnFile : public testing::TestWithParam<unsigned> {};

TEST_P(CairnFile, DecodeIsTheInverseOfEncode) {
  auto tree = random_map<SemanticOcTree>(GetParam(), 4000, 0.123456789);
  tree->set_sensor_model({0.9F, -0.3F, -1.5F, 3.0F, 0.1F});
  const Bytes bytes = encode_cairn(*tree, "robot: husky");
  const auto back = decode_cairn(bytes);
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(differing_nodes(**back, *tree), 0U);
  EXPECT_EQ((*back)->getResolution(), 0.123456789);
  EXPECT_EQ((*back)->sensor_model(), tree->sensor_model());
  EXPECT_EQ(encode_cairn(**back, "robot: husky"), bytes);
  EXPECT_EQ(decode_cairn_metadata(bytes).value(), "robot: husky");
}

std::vector<std::uint32_t> labels_of(const SemanticOcTree& tree) {
  std::vector<std::uint32_t> labels;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) labels.push_back(leaf->label_id());
  return labels;
}

TEST_P(CairnFile, LabelsAreKeptAndCostNothingWhereThereAreNone) {
  auto tree = random_map<SemanticOcTree>(GetParam(), 4000);
  const Bytes plain = encode_cairn(*tree);
  std::mt19937 random(GetParam());
  TileState state;
  std::vector<VoxelLabel> labels(512);
  for (unsigned i = 0; i < 512; ++i) state.set(i % 8, i / 8 % 8, i / 64, 2.5F);
  for (VoxelLabel& label : labels) label.code = static_cast<std::uint8_t>(random() % 9);
  state.set_labels(labels);
  write_tile(*tree, TileKey::of_voxel(32768, 32768, 32768), state);
  const Bytes bytes = encode_cairn(*tree);
  const auto back = decode_cairn(bytes);
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(differing_nodes(**back, *tree), 0U);
  EXPECT_EQ(labels_of(**back), labels_of(*tree));
  EXPECT_EQ(encode_cairn(**back), bytes);
  EXPECT_EQ(plain[68], std::byte{0});
  EXPECT_EQ(bytes[68], std::byte{1});
}

/// A map of one leaf, whose label is stored as `id` in this form.
Bytes file_with_label(std::uint32_t id, cairn_format::LeafLabel form) {
  Bytes raw;
  append_le(raw, std::uint32_t{0});
  append_le(raw, 2.5F);
  if (form == cairn_format::LeafLabel::kCode)
    append_le(raw, static_cast<std::uint8_t>(id));
  else
    append_le(raw, id);
  Bytes frame(ZSTD_compressBound(raw.size()));
  frame.resize(ZSTD_compress(frame.data(), frame.size(), raw.data(), raw.size(), 1));
  const cairn_format::Chunk chunk{static_cast<std::uint32_t>(raw.size()), static_cast<std::uint32_t>(frame.size()),
                                  cairn_format::hash(frame)};
  return cairn_format::assemble({0.1, SemanticOcTree(0.1).sensor_model(), 1, {}, {chunk}, 0, form}, frame);
}

TEST(CairnFileRead, LabelsThatAreNoneAreRefused) {
  for (const unsigned code : {0U, 1U, 76U, 77U, 255U})
    EXPECT_EQ(decode_cairn(file_with_label(code, cairn_format::LeafLabel::kCode)).has_value(), code == 1 || code == 76)
        << code;
}

TEST(CairnFileRead, EvidenceThatNoWriterLeavesIsRefused) {
  LabelEvidence evidence;
  evidence.add(13, 20);
  const auto read = decode_cairn(file_with_label(evidence.id(), cairn_format::LeafLabel::kEvidence));
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ((*read)->getRoot()->label_id(), evidence.id());
  for (const std::uint32_t id : {0U, 13U, LabelEvidence::kMark, evidence.id() ^ 1U << 7U, 0xFFFF'FFFFU})
    EXPECT_FALSE(decode_cairn(file_with_label(id, cairn_format::LeafLabel::kEvidence))) << id;
}

INSTANTIATE_TEST_SUITE_P(Seeds, CairnFile, testing::Values(1U, 2U, 3U, 4U));

TEST(CairnFileRead, SeveralChunksAreJoined) {
  SemanticOcTree tree(0.1);
  std::mt19937 random(1);
  for (int i = 0; i < 30000; ++i) {
    const auto key = [&random] { return static_cast<octomap::key_type>(random()); };
    const octomap::OcTreeKey at(key(), key(), key());
    tree.setNodeValue(at, static_cast<float>(random() % 1000) * 0.001F);
  }
  const Bytes bytes = encode_cairn(tree);
  EXPECT_GT(cairn_format::parse(bytes)->chunks.size(), 2U);
  const auto back = decode_cairn(bytes);
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(differing_nodes(**back, tree), 0U);
}

TEST(CairnFileRead, EmptyAndSingleNodeMaps) {
  const auto empty = decode_cairn(encode_cairn(SemanticOcTree(0.2)));
  ASSERT_TRUE(empty);
  EXPECT_EQ((*empty)->size(), 0U);
  const auto single = decode_cairn(file_with({}, {0.5F}, 1));
  ASSERT_TRUE(single);
  EXPECT_EQ((*single)->size(), 1U);
  EXPECT_EQ((*single)->getRoot()->getLogOdds(), 0.5F);
}

TEST(CairnFileRead, OnlyTheCanonicalTreeIsWritten) {
  auto tree = random_map<SemanticOcTree>(1, 1000);
  const Bytes bytes = encode_cairn(*tree);
  tree->expandNode(tree->search(octomap::OcTreeKey(32768, 32768, 32768)));
  ASSERT_FALSE(tree->is_canonical());
  EXPECT_EQ(encode_cairn(*tree), bytes);
}

TEST(CairnFileRead, EveryFlippedBitIsNoticed) {
  Bytes bytes = encode_cairn(*random_map<SemanticOcTree>(2, 30), "m");
  ASSERT_TRUE(decode_cairn(bytes));
  for (std::size_t i = 0; i < bytes.size(); ++i)
    for (unsigned bit = 0; bit < 8; ++bit) {
      bytes[i] ^= std::byte{1} << bit;
      EXPECT_FALSE(decode_cairn(bytes)) << "byte " << i << " bit " << bit;
      bytes[i] ^= std::byte{1} << bit;
    }
}

TEST(CairnFileRead, EveryTruncationNamesTheOffset) {
  const Bytes bytes = encode_cairn(*random_map<SemanticOcTree>(2, 30));
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const auto back = decode_cairn(std::span(bytes).first(n));
    ASSERT_FALSE(back);
    EXPECT_EQ(back.error().code, Errc::kTruncated);
    EXPECT_EQ(back.error().offset, n);
  }
}

TEST(CairnFileRead, WhatFollowsTheMapIsAnError) {
  Bytes bytes = encode_cairn(*random_map<SemanticOcTree>(2, 30));
  bytes.push_back(std::byte{0});
  EXPECT_EQ(cause(decode_cairn(bytes)), "bytes follow the map");
}

TEST(CairnFileRead, ContentsThatChecksumsCannotCatchAreChecked) {
  const std::vector<std::uint8_t> root{0x03, 0x00};
  EXPECT_EQ(cause(decode_cairn(file_with(root, {1, 2}, 3))), "no error");
  EXPECT_EQ(cause(decode_cairn(file_with(root, {1}, 3))), "nodes are missing");
  EXPECT_EQ(cause(decode_cairn(file_with(root, {1, 2}, 4))), "the header announces another number of nodes");
  EXPECT_EQ(cause(decode_cairn(file_with(root, {1, 2, 3}, 3))), "the header announces another number of nodes");
  EXPECT_EQ(cause(decode_cairn(file_with(root, {1, NAN}, 3))), "a log-odds value is not finite");
  EXPECT_EQ(cause(decode_cairn(file_with(root, {1, -INFINITY}, 3))), "a log-odds value is not finite");
  EXPECT_EQ(cause(decode_cairn(file_with({0x00, 0x00}, {}, 3))), "an inner node has no children");
  EXPECT_EQ(cause(decode_cairn(file_with({0x03, 0x04}, {1, 2}, 3))), "an inner node is not a child");
  EXPECT_EQ(cause(decode_cairn(file_with({0xFF, 0x00}, std::vector<float>(8, 1.0F), 9))), "the tree is not pruned");
  EXPECT_EQ(cause(decode_cairn(file_with({0x03}, {1, 2}, 3))), "a chunk ends inside the tree");
  EXPECT_EQ(cause(decode_cairn(file_with(root, {1, 2}, 3, 100))), "a chunk is empty or too short");
  std::vector<std::uint8_t> deep;
  for (int i = 0; i < 20; ++i) deep.insert(deep.end(), {0x01, 0x01});
  EXPECT_EQ(cause(decode_cairn(file_with(deep, {1}, 21))), "the tree is deeper than 16 levels");
}

TEST(CairnFileRead, ClaimsAreBoundedBeforeMemoryIsTaken) {
  const Bytes frame(16, std::byte{0});
  const SensorModel model = SemanticOcTree(0.1).sensor_model();
  const auto with = [&](const cairn_format::Header& header) {
    return decode_cairn(cairn_format::assemble(header, frame));
  };
  const std::uint64_t hash = cairn_format::hash(frame);
  EXPECT_EQ(cause(with({0.1, model, 9, {}, {{0xFFFFFFFFU, 16, hash}}, 0})), "a chunk claims more bytes than it may");
  EXPECT_EQ(cause(with({0.1, model, 9, {}, {{64, 0xFFFFFFFFU, hash}}, 0})), "a chunk claims more bytes than it may");
  EXPECT_EQ(cause(with({0.1, model, 9, {}, {{64, 16, hash}}, 0})), "a chunk does not decompress to what it claims");
  EXPECT_EQ(cause(with({0.1, model, 9, {}, {{64, 8, cairn_format::hash(std::span(frame).first(8))}}, 0})),
            "the chunks do not fill the file");
  EXPECT_EQ(cause(with({1e300, model, 9, {}, {{64, 16, hash}}, 0})), "the resolution is senseless");
  EXPECT_EQ(cause(with({NAN, model, 9, {}, {{64, 16, hash}}, 0})), "the resolution is senseless");
  EXPECT_EQ(cause(with({0.1, {NAN, 0, 0, 0, 0}, 9, {}, {{64, 16, hash}}, 0})), "the sensor model is senseless");
  MapLimits small;
  small.max_tree_bytes = 256;
  const auto refused = decode_cairn(encode_cairn(*random_map<SemanticOcTree>(2, 30)), small);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kLimit);
}

}  // namespace
}  // namespace cairn::mapping
