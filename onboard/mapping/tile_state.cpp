// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tile_state.hpp"

#include <algorithm>

namespace cairn {
namespace {

constexpr unsigned kTileDepth = SemanticOcTree::kDepth - TileKey::kVoxelBits;

unsigned child_on_path(TileKey tile, unsigned depth) {
  return static_cast<unsigned>(tile.morton >> (3 * (kTileDepth - 1 - depth))) & 7U;
}

constexpr float kWeakFree = -0.6F;  // OctoMap's miss is −0.4: free, but seen once only

/// A cube inside a tile.
struct Cube {
  unsigned x, y, z, edge;
  [[nodiscard]] Cube child(unsigned i) const {
    const unsigned half = edge / 2;
    return {x + (i & 1U) * half, y + (i >> 1 & 1U) * half, z + (i >> 2 & 1U) * half, half};
  }
};

void fill(TileState& state, const Cube& cube, float log_odds, float threshold) {
  for (unsigned z = cube.z; z < cube.z + cube.edge; ++z)
    for (unsigned y = cube.y; y < cube.y + cube.edge; ++y)
      for (unsigned x = cube.x; x < cube.x + cube.edge; ++x) state.set(x, y, z, log_odds, threshold);
}

// NOLINTNEXTLINE(misc-no-recursion): three levels
void read(TileState& state, const SemanticNode& node, const Cube& cube, float threshold) {
  if (node.block() == nullptr) return fill(state, cube, node.getLogOdds(), threshold);
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i)
    if (node.block()[i].present()) read(state, node.block()[i], cube.child(i), threshold);
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

bool childless(const SemanticNode* node) {
  return std::none_of(node->block(), node->block() + SemanticNode::kChildren,
                      [](const SemanticNode& child) { return child.present(); });
}

/// Gives a childless node what is known of a cube; false where that is nothing.
// NOLINTNEXTLINE(misc-no-recursion): three levels
bool write(NodeWriter& writer, SemanticNode* node, const TileVoxels& voxels, const Cube& cube) {
  if (cube.edge == 1) {
    const float value = voxels[cube.x + TileState::kEdge * (cube.y + TileState::kEdge * cube.z)];
    node->setLogOdds(value);
    return value != SemanticNode::kAbsent;
  }
  bool any = false, made = false;
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
    SemanticNode* child = writer.child(node, i, made);
    if (write(writer, child, voxels, cube.child(i))) {
      any = true;
      continue;
    }
    child->setLogOdds(SemanticNode::kAbsent);
    writer.count(-1);
  }
  if (any)
    writer.refresh(node);
  else
    writer.drop_block(node);
  return any;
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

}  // namespace

bool TileState::valid() const {
  std::uint64_t wrong = 0;
  for (unsigned z = 0; z < kEdge; ++z) wrong |= ((occupied[z] | low[z]) & ~known[z]) | (high[z] & ~occupied[z]);
  return wrong == 0;
}

float TileState::log_odds(unsigned x, unsigned y, unsigned z) const {
  const unsigned at = 8 * y + x;
  const auto bit = [at, z](const Plane& plane) { return static_cast<unsigned>(plane[z] >> at & 1U); };
  if (bit(known) == 0) return SemanticNode::kAbsent;
  const unsigned grade = bit(low) | bit(high) << 1;
  return bit(occupied) != 0 ? kOccupied[grade] : kFree[grade];
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
  const SemanticNode* node = map.getRoot();
  for (unsigned depth = 0; node != nullptr && depth < kTileDepth && node->block() != nullptr; ++depth) {
    node = node->block() + child_on_path(tile, depth);
    if (!node->present()) return state;
  }
  if (node != nullptr) read(state, *node, {0, 0, 0, TileState::kEdge}, map.sensor_model().occupied);
  return state;
}

void write_tile(SemanticOcTree& map, TileKey tile, const TileState& state) {
  TileVoxels voxels;
  for (unsigned i = 0; i < voxels.size(); ++i) voxels[i] = state.log_odds(i & 7U, i >> 3 & 7U, i >> 6);
  write_tile(map, tile, voxels);
}

void write_tile(SemanticOcTree& map, TileKey tile, const TileVoxels& voxels) {
  const bool empty = std::ranges::all_of(voxels, [](float v) { return v == SemanticNode::kAbsent; });
  if (empty && read_tile(map, tile).empty()) return;
  NodeWriter& writer = map.writer(0);
  const Path path = path_to(map, writer, tile);
  clear_below(writer, path.back());
  bool known = write(writer, path.back(), voxels, {0, 0, 0, TileState::kEdge});
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

}  // namespace cairn
