// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tree/tile_state.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace cairn::mapping {
namespace {

constexpr unsigned kTileDepth = SemanticOcTree::kDepth - TileKey::kVoxelBits;

unsigned child_on_path(TileKey tile, unsigned depth) {
  return static_cast<unsigned>(tile.morton >> (3 * (kTileDepth - 1 - depth))) & 7U;
}

// Log-odds from which a free voxel has the weak grade. OctoMap's miss is −0.4: such a voxel was
// seen once only.
constexpr float kWeakFree = -0.6F;

template <class Visit>
void for_each_voxel(const Visit& visit) {
  for (int z = 0; z < kTileEdge; ++z)
    for (int y = 0; y < kTileEdge; ++y)
      for (int x = 0; x < kTileEdge; ++x)
        visit(static_cast<unsigned>(x), static_cast<unsigned>(y), static_cast<unsigned>(z),
              static_cast<std::size_t>(tile_index(0, x) | tile_index(1, y) | tile_index(2, z)));
}

/// Frees what is below a node and keeps the count of nodes.
// NOLINTNEXTLINE(misc-no-recursion): three levels
void clear_below(NodeWriter& writer, SemanticNode* node) {
  if (node->block() == nullptr) return;
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
    SemanticNode* child = node->block() + i;
    if (!child->present()) continue;
    clear_below(writer, child);
    writer.count(-1);
  }
  writer.drop_block(node);
}

/// The node of a tile, or the leaf above it that stands for it; null: nothing is known there.
const SemanticNode* node_of(const SemanticOcTree& map, TileKey tile) {
  const SemanticNode* node = map.getRoot();
  for (unsigned depth = 0; node != nullptr && depth < kTileDepth && node->block() != nullptr; ++depth) {
    node = node->block() + child_on_path(tile, depth);
    if (!node->present()) return nullptr;
  }
  return node;
}

bool childless(const SemanticNode* node) {
  return std::none_of(node->block(), node->block() + SemanticNode::kChildren,
                      [](const SemanticNode& child) { return child.present(); });
}

/// The nodes from the root to a tile.
using Path = std::array<SemanticNode*, kTileDepth + 1>;

Path path_to(SemanticOcTree& map, NodeWriter& writer, TileKey tile) {
  Path path{};
  bool made = false;
  path[0] = map.root_or_new(made);
  for (unsigned depth = 0; depth < kTileDepth; ++depth) {
    if (!made && path[depth]->block() == nullptr) writer.expand(path[depth]);
    made = false;
    path[depth + 1] = writer.child(path[depth], child_on_path(tile, depth), made);
  }
  return path;
}

/// How often each label occurs.
using LabelCounts = std::array<std::size_t, VoxelLabel::kCodes + 1>;
LabelCounts count(std::span<const VoxelLabel> labels) {
  LabelCounts counts{};
  for (const VoxelLabel label : labels) ++counts[label.code];
  counts[0] = 0;
  return counts;
}
std::size_t kinds(const LabelCounts& counts) {
  return static_cast<std::size_t>(std::ranges::count_if(counts, [](std::size_t n) { return n > 0; }));
}

bool sound(const TileState& state) {
  if (state.labels.empty()) return true;
  if (state.labels.size() != static_cast<std::size_t>(kTileVoxels)) return false;
  for (std::size_t i = 0; i < state.labels.size(); ++i) {
    const bool occupied = (state.occupied[i / 64] >> (i % 64) & 1U) != 0;
    if (!state.labels[i].valid() || (state.labels[i].any() && !occupied)) return false;
  }
  const std::size_t different = kinds(count(state.labels));
  return different > 0 && different <= TileState::kMostLabels;
}

}  // namespace

bool TileState::valid() const {
  std::uint64_t wrong = 0;
  for (unsigned z = 0; z < kEdge; ++z) wrong |= ((occupied[z] | low[z]) & ~known[z]) | (high[z] & ~occupied[z]);
  return wrong == 0 && sound(*this);
}

void TileState::set_labels(std::vector<VoxelLabel> of_voxels) {
  labels = std::move(of_voxels);
  LabelCounts counts = count(labels);
  while (kinds(counts) > kMostLabels) {
    std::size_t rarest = 0;
    for (std::size_t code = 1; code < counts.size(); ++code)
      if (counts[code] > 0 && (rarest == 0 || counts[code] < counts[rarest])) rarest = code;
    std::ranges::replace(labels, VoxelLabel{static_cast<std::uint8_t>(rarest)}, VoxelLabel{});
    counts[rarest] = 0;
  }
  if (kinds(counts) == 0) labels.clear();
}

void TileState::set(unsigned x, unsigned y, unsigned z, float log_odds, float threshold) {
  const bool is_occupied = log_odds >= threshold;
  const auto halfway = [&](const auto& grades, std::size_t i) { return (grades[i] + grades[i + 1]) / 2; };
  std::size_t grade = 0;
  if (is_occupied)
    while (grade < 3 && log_odds < halfway(kOccupied, grade)) ++grade;
  else
    grade = log_odds > kWeakFree ? 1 : 0;
  const std::uint64_t bit = std::uint64_t{1} << (8 * y + x);
  const auto put = [bit, z](Plane& plane, bool value) { plane[z] = value ? plane[z] | bit : plane[z] & ~bit; };
  put(known, true);
  put(occupied, is_occupied);
  put(low, (grade & 1U) != 0);
  put(high, (grade & 2U) != 0);
}

TileState read_tile(const SemanticOcTree& map, TileKey tile) {
  TileState state;
  const SemanticNode* node = node_of(map, tile);
  if (node == nullptr) return state;
  TileVoxels voxels;
  read_voxels(*node, voxels);
  const float threshold = map.sensor_model().occupied;
  for_each_voxel([&](unsigned x, unsigned y, unsigned z, std::size_t i) {
    if (voxels[i] != SemanticNode::kAbsent) state.set(x, y, z, voxels[i], threshold);
  });
  TileLabels labels;
  if (!state.any_occupied() || !read_labels(*node, labels)) return state;
  std::vector<VoxelLabel> of_voxels;
  for_each_voxel([&](unsigned x, unsigned y, unsigned z, std::size_t i) {
    of_voxels.push_back((state.occupied[z] >> (8 * y + x) & 1U) != 0 ? labels[i] : VoxelLabel{});
  });
  state.set_labels(std::move(of_voxels));
  return state;
}

void write_tile(SemanticOcTree& map, TileKey tile, const TileState& state) {
  TileVoxels voxels;
  for_each_voxel([&](unsigned x, unsigned y, unsigned z, std::size_t i) { voxels[i] = state.log_odds(x, y, z); });
  if (state.labels.empty()) return write_tile(map, tile, voxels);
  TileLabels labels;
  for_each_voxel([&](unsigned x, unsigned y, unsigned z, std::size_t i) { labels[i] = state.label(x, y, z); });
  write_tile(map, tile, voxels, &labels);
}

void write_tile(SemanticOcTree& map, TileKey tile, const TileVoxels& voxels, const TileLabels* labels) {
  const bool empty = std::ranges::all_of(voxels, [](float v) { return v == SemanticNode::kAbsent; });
  if (empty && read_tile(map, tile).empty()) return;
  NodeWriter& writer = map.writer(0);
  const Path path = path_to(map, writer, tile);
  clear_below(writer, path.back());
  path.back()->set_label_id(0);
  bool known = write_voxels(voxels, writer, path.back(), labels);
  for (unsigned depth = kTileDepth; depth-- > 0;) {
    if (!known) {
      path[depth + 1]->setLogOdds(SemanticNode::kAbsent);
      writer.count(-1);
    }
    known = !childless(path[depth]);
    if (known)
      writer.refresh(path[depth]);
    else
      writer.drop_block(path[depth]);
  }
  map.settle_count();
  if (!known) map.clear();
}

bool fill_tile(SemanticOcTree& map, TileKey tile, const SemanticOcTree& other) {
  const SemanticNode *own = node_of(map, tile), *others = node_of(other, tile);
  if (others == nullptr) return false;
  TileVoxels voxels, added;
  TileLabels labels{}, added_labels{};
  voxels.fill(SemanticNode::kAbsent);
  if (own != nullptr) read_voxels(*own, voxels);
  read_voxels(*others, added);
  bool labelled = own != nullptr && read_labels(*own, labels), changed = false;
  labelled = read_labels(*others, added_labels) || labelled;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    if (voxels[i] != SemanticNode::kAbsent || added[i] == SemanticNode::kAbsent) continue;
    voxels[i] = added[i];
    labels[i] = added_labels[i];
    changed = true;
  }
  if (changed) write_tile(map, tile, voxels, labelled ? &labels : nullptr);
  return changed;
}

std::vector<TileKey> known_tiles(const SemanticOcTree& map, std::size_t most) {
  std::vector<TileKey> tiles;
  const auto visit = [&](const auto& self, const SemanticNode& node, unsigned depth, std::uint64_t path) -> void {
    if (tiles.size() >= most) return;
    if (depth == kTileDepth) return tiles.push_back({path});
    for (unsigned i = 0; i < SemanticNode::kChildren; ++i)
      if (node.block() == nullptr)
        self(self, node, depth + 1, path << 3 | i);
      else if (node.block()[i].present())
        self(self, node.block()[i], depth + 1, path << 3 | i);
  };
  if (map.getRoot() != nullptr) visit(visit, *map.getRoot(), 0, 0);
  return tiles;
}

}  // namespace cairn::mapping
