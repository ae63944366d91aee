// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/insert/entered_voxels.hpp"

#include <algorithm>
#include <utility>

#include "hal/semantic_class.hpp"
#include "onboard/mapping/tree/label_evidence.hpp"

namespace cairn::mapping {
namespace {

// Chosen on simulated drives of seeds 50000 to 69999 with people whom nobody follows.
constexpr int kUnlabelled = 3;              // scans that look through a voxel without a class
constexpr int kAround = 12;                 // looks through the columns around
constexpr std::uint32_t kRest = 5;          // scans without a hit
constexpr std::uint32_t kColumnsEvery = 5;  // scans: the columns are judged so often
constexpr std::uint32_t kLife = 600;        // scans after the last hit: then it is left to OctoMap

constexpr unsigned kVoxelBits = 12;  // of a path below a brick
constexpr unsigned kWordBits = 6;

/// The key of the voxel at the end of a path of 16 octal digits.
octomap::OcTreeKey key_of(std::uint64_t path) {
  octomap::OcTreeKey key;
  for (unsigned axis = 0; axis < 3; ++axis) {
    unsigned bits = 0;
    for (unsigned level = 0; level < SemanticOcTree::kDepth; ++level)
      bits |= static_cast<unsigned>(path >> (3 * level + axis) & 1U) << level;
    key[axis] = static_cast<octomap::key_type>(bits);
  }
  return key;
}

std::uint32_t column_of(unsigned x, unsigned y) { return x << 16U | (y & 0xFFFFU); }

bool has(const std::uint64_t* words, std::uint64_t path) {
  return (words[path >> kWordBits & 63U] >> (path & 63U) & 1U) != 0;
}

}  // namespace

int rays_to_clear(std::uint8_t class_id) {
  if (class_id == kNoClass) return kUnlabelled;
  return class_id >= kPersonClass ? 1 : 0;  // riders and vehicles have higher ids
}

void EnteredVoxels::follow(std::span<const EnteredBlock> entered, Footprint& footprint, const SemanticOcTree& tree,
                           const HeightBand& band) {
  ++scan_;
  note(footprint, tree.sensor_model());
  add(entered, tree, band);
  if (scan_ % kColumnsEvery == 0) judge_columns();
}

/// Bricks and voxels are in the same order. A voxel that is free again stays until its column was judged.
void EnteredVoxels::note(Footprint& footprint, const SensorModel& model) {
  const std::span<const BrickRef> bricks = footprint.sorted_bricks();
  auto brick = bricks.begin();
  for (Voxel& v : voxels_) {
    while (brick != bricks.end() && brick->path < v.path >> kVoxelBits) ++brick;
    if (brick == bricks.end()) break;
    if (brick->path != v.path >> kVoxelBits) continue;
    if (has(footprint.occupied(brick->slot), v.path)) {
      v.log_odds = model.update(v.log_odds, model.hit);
      v.hit_scan = scan_;
      v.seen_through = 0;
    } else if (has(footprint.free(brick->slot), v.path)) {
      v.log_odds = model.update(v.log_odds, model.miss);
      ++v.seen_through;
    }
  }
  std::erase_if(voxels_, [&](const Voxel& v) {
    return (v.log_odds <= kFreeRays * model.miss && v.seen_through >= kRest + kColumnsEvery) ||
           scan_ - v.hit_scan > kLife;
  });
}

void EnteredVoxels::add(std::span<const EnteredBlock> entered, const SemanticOcTree& tree, const HeightBand& band) {
  fresh_.clear();
  for (const EnteredBlock& block : entered)
    for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
      if ((block.voxels >> i & 1U) == 0) continue;
      const std::uint64_t path = block.path << 3U | i;
      const octomap::OcTreeKey key = key_of(path);
      const double height = tree.keyToCoord(key[2]);
      if (height < band.low || height > band.high || follows(path) || stands_beside(key, tree)) continue;
      const SemanticNode* node = tree.search(key);
      if (node == nullptr) continue;
      fresh_.push_back({.path = path, .key = key, .hit_scan = scan_, .log_odds = node->getLogOdds()});
    }
  fresh_.resize(std::min(fresh_.size(), kMost - std::min(kMost, voxels_.size())));
  const auto old = static_cast<std::ptrdiff_t>(voxels_.size());
  voxels_.insert(voxels_.end(), fresh_.begin(), fresh_.end());
  const auto by_path = [](const Voxel& a, const Voxel& b) { return a.path < b.path; };
  std::inplace_merge(voxels_.begin(), voxels_.begin() + old, voxels_.end(), by_path);
}

bool EnteredVoxels::follows(std::uint64_t path) const {
  const auto at = std::ranges::lower_bound(voxels_, path, {}, &Voxel::path);
  return at != voxels_.end() && at->path == path;
}

/// A voxel with one hit more than misses may be of the same body, and of this very scan.
bool EnteredVoxels::stands_beside(const octomap::OcTreeKey& key, const SemanticOcTree& tree) const {
  const float sure = tree.sensor_model().occupied + tree.sensor_model().hit;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const auto next = [&](unsigned axis, int step) { return static_cast<octomap::key_type>(key[axis] + step); };
        const octomap::OcTreeKey beside(next(0, dx), next(1, dy), next(2, dz));
        const SemanticNode* node = tree.search(beside);
        if (node != nullptr && node->getLogOdds() > sure && !follows(voxel_path(beside))) return true;
      }
  return false;
}

void EnteredVoxels::judge_columns() {
  columns_.clear();
  for (const Voxel& v : voxels_) {
    Column& column = columns_[column_of(v.key[0], v.key[1])];
    column.hit_scan = std::max(column.hit_scan, v.hit_scan);
    column.seen_through += v.seen_through;
  }
  for (Voxel& v : voxels_) {
    if (v.log_odds < 0 || scan_ - v.hit_scan < kRest) continue;
    const Column column = around(v.key);
    v.due = scan_ - column.hit_scan >= kRest && column.seen_through >= kAround;
  }
}

EnteredVoxels::Column EnteredVoxels::around(const octomap::OcTreeKey& key) const {
  Column sum;
  for (unsigned dy = 0; dy <= 2; ++dy)
    for (unsigned dx = 0; dx <= 2; ++dx) {
      const auto found = columns_.find(column_of((key[0] + dx - 1U) & 0xFFFFU, key[1] + dy - 1U));
      if (found == columns_.end()) continue;
      sum.hit_scan = std::max(sum.hit_scan, found->second.hit_scan);
      sum.seen_through += found->second.seen_through;
    }
  return sum;
}

std::size_t EnteredVoxels::clear(SemanticOcTree& tree, std::vector<TileKey>& changed) {
  placed_.clear();
  for (std::size_t i = 0; i < voxels_.size(); ++i)
    if (voxels_[i].due || (voxels_[i].seen_through > 0 && voxels_[i].log_odds >= 0))
      placed_.push_back({voxels_[i].path, static_cast<std::uint32_t>(i)});
  const float free = kFreeRays * tree.sensor_model().miss;
  std::size_t cleared = 0;
  OccupiedWalk walk(tree, [&](SemanticNode& node, PlacedPoints points) {
    Voxel& voxel = voxels_[points.front().point];
    const int rays = rays_to_clear(LabelEvidence::from_id(node.label_id()).class_id());
    const bool ready = rays > 0 && (voxel.due || voxel.seen_through >= rays);
    voxel.due = false;
    voxel.log_odds = node.getLogOdds();
    if (!ready) return false;
    node.setLogOdds(std::max(free, tree.sensor_model().min));
    node.set_label_id(0);
    voxel.log_odds = node.getLogOdds();
    ++cleared;
    const TileKey tile{voxel.path >> (3 * TileKey::kVoxelBits)};
    if (changed.empty() || changed.back() != tile) changed.push_back(tile);
    return true;
  });
  (void)walk.run(placed_);
  return cleared;
}

}  // namespace cairn::mapping
