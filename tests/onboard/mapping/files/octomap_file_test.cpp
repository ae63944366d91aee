// SPDX-License-Identifier: Apache-2.0
// The oracle is OctoMap's own writer and reader, on files that are good.
#include "onboard/mapping/files/octomap_file.hpp"

#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "hal/bytes.hpp"
#include "hal/files/file.hpp"
#include "tests/onboard/mapping/random_maps.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"
#include "tests/support/hostile_maps.hpp"
#include "tests/support/recorded_data.hpp"

namespace cairn::mapping {
namespace {

std::vector<std::byte> to_bytes(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::string to_string(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string stock_ot(const octomap::AbstractOcTree& tree) {
  std::stringstream out;
  tree.write(out);
  return out.str();
}

std::string stock_bt(octomap::OcTree tree) {
  std::stringstream out;
  tree.writeBinary(out);
  return out.str();
}

/// Prunes and updates an OctoMap tree completely; its own prune() stops at the first level with nothing to prune.
class CanonicalOcTree : public octomap::OcTree {
 public:
  using OcTree::OcTree;
  void canonicalise() {
    if (root != nullptr) below(root);
  }

 private:
  void below(octomap::OcTreeNode* node) {
    if (!nodeHasChildren(node)) return;
    for (unsigned i = 0; i < 8; ++i)
      if (nodeChildExists(node, i)) below(getNodeChild(node, i));
    if (!pruneNode(node)) node->updateOccupancyChildren();
  }
};

std::string ot_header(const std::string& size, const std::string& res = "0.1", const std::string& id = "OcTree") {
  return "# Octomap OcTree file\nid " + id + "\nsize " + size + "\nres " + res + "\ndata\n";
}
std::string bt_header(const std::string& size) {
  return "# Octomap OcTree binary file\nid OcTree\nsize " + size + "\nres 0.1\ndata\n";
}
/// One .ot node.
std::string node(float value, unsigned char children) {
  std::string text(5, '\0');
  std::memcpy(text.data(), &value, 4);
  text[4] = static_cast<char>(children);
  return text;
}

// The format begins with the children of the root, so one cube has no word of its own in it.
TEST(BtFile, HoldsAMapThatIsOneCube) {
  for (const float log_odds : {3.5F, -2.0F}) {
    const auto cube = support::whole_tree(log_odds);
    const auto back = decode_bt(encode_bt(*cube));
    ASSERT_TRUE(back) << to_string(back.error());
    EXPECT_EQ((*back)->size(), 1U);
    EXPECT_EQ((*back)->isNodeOccupied((*back)->getRoot()), log_odds > 0);
  }
}

TEST(MapFiles, OfHostileMapsAreReadBack) {
  for (const auto& [name, map] : support::hostile_maps()) {
    const auto ot = decode_ot(encode_ot(*map));
    ASSERT_TRUE(ot) << name;
    EXPECT_EQ(encode_ot(**ot), encode_ot(*map)) << name;
    const auto bt = decode_bt(encode_bt(*map));
    ASSERT_TRUE(bt) << name << to_string(bt.error());
    EXPECT_EQ(encode_bt(**bt), encode_bt(*map)) << name;
  }
}

class OctoMapFile : public testing::TestWithParam<unsigned> {
 protected:
  std::unique_ptr<SemanticOcTree> ours = random_map<SemanticOcTree>(GetParam(), 2000);
  std::unique_ptr<octomap::OcTree> stock = random_map<octomap::OcTree>(GetParam(), 2000);
};

TEST_P(OctoMapFile, EncodersGiveOctoMapsBytes) {
  EXPECT_EQ(to_string(encode_ot(*ours)), stock_ot(*stock));
  EXPECT_EQ(to_string(encode_bt(*ours)), stock_bt(*stock));
}

TEST_P(OctoMapFile, OtComesBackAsItWas) {
  const auto tree = decode_ot(to_bytes(stock_ot(*stock)));
  ASSERT_TRUE(tree) << to_string(tree.error());
  EXPECT_EQ(differing_nodes(**tree, *stock), 0U);
  EXPECT_EQ((*tree)->used_bytes(), ours->used_bytes());
}

TEST_P(OctoMapFile, BtGivesWhatOctoMapReads) {
  const std::string bytes = stock_bt(*stock);
  CanonicalOcTree oracle(0.1);
  std::stringstream in(bytes);
  ASSERT_TRUE(oracle.readBinary(in));
  oracle.canonicalise();
  const auto tree = decode_bt(to_bytes(bytes));
  ASSERT_TRUE(tree) << to_string(tree.error());
  EXPECT_EQ(differing_nodes(**tree, oracle), 0U);
  EXPECT_TRUE((*tree)->is_canonical());
}

TEST_P(OctoMapFile, EveryTruncationIsAnError) {
  const auto whole_ot = encode_ot(*random_map<SemanticOcTree>(GetParam() * 2, 20));
  for (std::size_t n = 0; n < whole_ot.size(); ++n) EXPECT_FALSE(decode_ot(std::span(whole_ot).first(n))) << n;
  const auto whole_bt = encode_bt(*random_map<SemanticOcTree>(GetParam() * 2, 20));
  for (std::size_t n = 0; n < whole_bt.size(); ++n) EXPECT_FALSE(decode_bt(std::span(whole_bt).first(n))) << n;
}

INSTANTIATE_TEST_SUITE_P(Seeds, OctoMapFile, testing::Values(1U, 2U, 3U));

TEST(OctoMapFileRead, EmptyMapsAreMaps) {
  const octomap::OcTree empty(0.25);
  const auto ot = decode_ot(to_bytes(stock_ot(empty)));
  const auto bt = decode_bt(to_bytes(stock_bt(octomap::OcTree(0.25))));
  ASSERT_TRUE(ot && bt);
  EXPECT_EQ((*ot)->size() + (*bt)->size(), 0U);
  EXPECT_EQ((*bt)->getResolution(), 0.25);
  EXPECT_EQ(to_string(encode_ot(SemanticOcTree(0.25))), stock_ot(empty));
  EXPECT_EQ(to_string(encode_bt(SemanticOcTree(0.25))), stock_bt(octomap::OcTree(0.25)));
}

TEST(OctoMapFileRead, TreesWithoutColourHaveNoLabels) {
  auto colour = random_map<octomap::ColorOcTree>(2, 500);
  const auto stock = random_map<octomap::OcTree>(2, 500);
  const auto tree = decode_ot(to_bytes(stock_ot(*colour)));
  ASSERT_TRUE(tree) << to_string(tree.error());
  EXPECT_EQ(data_of(**tree), data_of(*stock));
}

TEST(OctoMapFileRead, InnerNodesAreComputedWhateverTheFileSays) {
  std::string bytes = ot_header("9") + node(99.0F, 0xFF);
  for (int i = 0; i < 8; ++i) bytes += node(i == 3 ? 1.5F : -0.5F, 0);
  const auto tree = decode_ot(to_bytes(bytes));
  ASSERT_TRUE(tree);
  EXPECT_EQ((*tree)->getRoot()->getLogOdds(), 1.5F);
}

struct Hostile {
  const char* name;
  std::string bytes;
  Errc code;
  const char* cause;
};

std::string deep_chain_ot() {
  std::string bytes = ot_header("40");
  for (int i = 0; i < 39; ++i) bytes += node(0.5F, 1);
  return bytes + node(0.5F, 0);
}
std::string deep_chain_bt() {
  std::string bytes = bt_header("40");
  for (int i = 0; i < 39; ++i) bytes += std::string("\x03\x00", 2);
  return bytes + std::string("\x02\x00", 2);
}

class OctoMapFileHostile : public testing::TestWithParam<Hostile> {};

TEST_P(OctoMapFileHostile, IsAnErrorThatNamesTheCause) {
  const auto bytes = to_bytes(GetParam().bytes);
  const auto tree = is_bt(bytes) ? decode_bt(bytes) : decode_ot(bytes);
  ASSERT_FALSE(tree);
  EXPECT_EQ(tree.error().code, GetParam().code);
  EXPECT_EQ(tree.error().cause, GetParam().cause);
  EXPECT_TRUE(tree.error().offset);
}

const float kNan = std::numeric_limits<float>::quiet_NaN();
const float kInfinity = std::numeric_limits<float>::infinity();

INSTANTIATE_TEST_SUITE_P(
    Files, OctoMapFileHostile,
    testing::Values(
        Hostile{"nothing", "", Errc::kMalformed, "not an OctoMap .ot file"},
        Hostile{"no_data_line", "# Octomap OcTree file\nid OcTree\n", Errc::kTruncated,
                "the header has no line `data`"},
        Hostile{"endless_header", "# Octomap OcTree file\n" + std::string(100000, '#'), Errc::kMalformed,
                "the header has no line `data`"},
        Hostile{"res_1e300", ot_header("1", "1e300"), Errc::kMalformed, "the resolution is missing or senseless"},
        Hostile{"res_nan", ot_header("1", "nan"), Errc::kMalformed, "the resolution is missing or senseless"},
        Hostile{"res_negative", ot_header("1", "-0.1"), Errc::kMalformed, "the resolution is missing or senseless"},
        Hostile{"res_text", ot_header("1", "0.1m"), Errc::kMalformed, "`res` is not a number"},
        Hostile{"size_huge", ot_header("99999999999999999999999"), Errc::kMalformed, "`size` is not a number"},
        Hostile{"unknown_key", "# Octomap OcTree file\nfoo 1\ndata\n", Errc::kMalformed, "unknown header line"},
        Hostile{"unknown_type", ot_header("1", "0.1", "MyTree"), Errc::kUnsupported, "the tree type is not supported"},
        Hostile{"ends_early", ot_header("9") + node(1, 1), Errc::kTruncated, "the file ends inside the tree"},
        Hostile{"bt_ends_early", bt_header("2"), Errc::kTruncated, "the file ends inside the tree"},
        Hostile{"too_deep", deep_chain_ot(), Errc::kMalformed, "the tree is deeper than 16 levels"},
        Hostile{"bt_too_deep", deep_chain_bt(), Errc::kMalformed, "the tree is deeper than 16 levels"},
        Hostile{"bt_childless", bt_header("1") + std::string(2, '\0'), Errc::kMalformed,
                "an inner node has no children"},
        Hostile{"nan", ot_header("1") + node(kNan, 0), Errc::kMalformed, "a log-odds value is not finite"},
        Hostile{"minus_infinity", ot_header("1") + node(-kInfinity, 0), Errc::kMalformed,
                "a log-odds value is not finite"},
        Hostile{"fewer_nodes", ot_header("3") + node(1, 1) + node(1, 0), Errc::kMalformed,
                "fewer nodes than the header announces"},
        Hostile{"more_nodes", ot_header("1") + node(1, 1) + node(1, 0), Errc::kMalformed,
                "more nodes than the header announces"},
        Hostile{"trailing", ot_header("1") + node(1, 0) + "x", Errc::kMalformed, "bytes follow the last node"}),
    [](const testing::TestParamInfo<Hostile>& i) { return std::string(i.param.name); });

TEST(OctoMapFileRead, MemoryIsBounded) {
  const auto bytes = encode_ot(*random_map<SemanticOcTree>(2, 3000));
  MapLimits limits;
  limits.max_tree_bytes = 1024;
  const auto tree = decode_ot(bytes, limits);
  ASSERT_FALSE(tree);
  EXPECT_EQ(tree.error().code, Errc::kLimit);
}

class OctoMapFileReal : public testing::TestWithParam<const char*> {};

TEST_P(OctoMapFileReal, IsReadAsOctoMapReadsIt) {
  const auto path = support::recorded_data("octomap") / GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no recording at " << path;
  const auto bytes = read_file(path, 1U << 24);
  ASSERT_TRUE(bytes);
  const auto tree = decode_bt(*bytes);
  ASSERT_TRUE(tree) << to_string(tree.error());
  CanonicalOcTree oracle(0.1);
  ASSERT_TRUE(oracle.readBinary(path.string()));
  oracle.canonicalise();
  EXPECT_EQ(differing_nodes(**tree, oracle), 0U);
  EXPECT_GT((*tree)->size(), 100000U);
}

INSTANTIATE_TEST_SUITE_P(Maps, OctoMapFileReal, testing::Values("fr_079.bt", "geb079.bt"),
                         [](const auto& i) { return std::string(i.param).substr(0, 3); });

}  // namespace
}  // namespace cairn::mapping
