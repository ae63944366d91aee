// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "onboard/mapping/insert/footprint.hpp"
#include "onboard/mapping/tree/map_tile.hpp"
#include "onboard/mapping/tree/occupied_walk.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// Voxels of one block (a node at depth 15) that a scan hit although rays had gone through them before.
struct EnteredBlock {
  std::uint64_t path = 0;  ///< of the node: 15 octal digits, the child index at depth 0 highest
  std::uint8_t voxels = 0;
};

/// The heights in the map, m, between which things move about.
struct HeightBand {
  double low = 0, high = 0;
};

/// How many rays must go through a voxel that something entered until it is free: one where pictures show what moves
/// about, three where they show nothing. 0: never by this rule, since pictures show what stands.
[[nodiscard]] int rays_to_clear(std::uint8_t class_id);

/// Clears what something left that came, was mapped, and went: a person whom no detector found, a cart, a door.
///
/// OctoMap forgets a voxel after as many misses as it takes to outweigh the hits, and a voxel that no later ray meets
/// stays for ever. Here a voxel counts as *entered* if rays had made it free beyond doubt, then a scan hit it, and
/// nothing stood beside it. Such a voxel is free again
/// - when as many scans as rays_to_clear() look through it, or
/// - when twelve looks have gone through the columns of voxels around it, and no hit for five scans: a body leaves
///   as a whole.
/// What was occupied when it was first seen, or stands beside what was, is never entered, and clears as in OctoMap.
class EnteredVoxels {
 public:
  static constexpr std::size_t kMost = 16'384;  ///< voxels that are followed; what enters beyond is left to OctoMap

  /// Notes what a scan has hit and missed, and what it has entered within the band. The scan is in the tree already.
  void follow(std::span<const EnteredBlock> entered, Footprint& footprint, const SemanticOcTree& tree,
              const HeightBand& band);
  /// Frees the voxels that are due. `tree` stays canonical. Adds to `changed` the tiles in which a voxel became free,
  /// in canonical order. Returns the number of voxels that became free.
  std::size_t clear(SemanticOcTree& tree, std::vector<TileKey>& changed);
  void forget() { *this = {}; }

  [[nodiscard]] std::size_t size() const { return voxels_.size(); }

 private:
  struct Voxel {
    std::uint64_t path = 0;
    octomap::OcTreeKey key;
    std::uint32_t hit_scan = 0;      ///< the last that hit it
    std::uint16_t seen_through = 0;  ///< scans since
    float log_odds = 0;              ///< as the tree has it
    bool due = false;
  };
  struct Column {
    std::uint32_t hit_scan = 0;
    int seen_through = 0;
  };

  void note(Footprint& footprint, const SensorModel& model);
  void add(std::span<const EnteredBlock> entered, const SemanticOcTree& tree, const HeightBand& band);
  [[nodiscard]] bool stands_beside(const octomap::OcTreeKey& key, const SemanticOcTree& tree) const;
  [[nodiscard]] bool follows(std::uint64_t path) const;
  void judge_columns();
  [[nodiscard]] Column around(const octomap::OcTreeKey& key) const;

  std::vector<Voxel> voxels_, fresh_;  // in order of paths
  std::unordered_map<std::uint32_t, Column> columns_;
  std::vector<PlacedPoint> placed_;
  std::uint32_t scan_ = 0;
};

}  // namespace cairn::mapping
