// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "hal/se3.hpp"
#include "hal/workers.hpp"
#include "onboard/mapping/mapper.hpp"
#include "onboard/mapping/mapping_config.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"
#include "tools/cli/evaluate/true_scans.hpp"

namespace cairn::cli {

/// How well a map keeps what stands and drops who walked through: the preservation and rejection rates of Lim, Hwang
/// and Myung, "ERASOR", RA-L 2021, over voxels of the true map.
struct MoverError {
  std::uint64_t seen_static_voxels = 0;  ///< occupied true voxels with kLeastReturns or more of what is no person
  std::uint64_t seen_kept = 0;           ///< of these, in the map
  std::uint64_t static_voxels = 0;       ///< of the seen ones, in the reference
  std::uint64_t kept = 0;                ///< of these, in the map
  std::uint64_t mover_voxels = 0;        ///< with a return of a person, and more than one voxel from what stands
  std::uint64_t dropped = 0;             ///< of these, whose centre lies in no occupied voxel of the map

  [[nodiscard]] std::optional<double> static_accuracy() const;       ///< kept / static_voxels
  [[nodiscard]] std::optional<double> seen_static_accuracy() const;  ///< seen_kept / seen_static_voxels
  [[nodiscard]] std::optional<double> dynamic_accuracy() const;      ///< dropped / mover_voxels
};

/// Counts in the voxels of the true map what a simulated LiDAR met, and makes the reference: the map that the same
/// mapping makes of the same returns without those of people. A map lacks some voxels that were seen, because later
/// beams passed through them; the reference lacks them, too. A true voxel is in a map that has an occupied voxel at
/// most a voxel's diagonal away, from centre to centre.
class MoverTruth {
 public:
  static constexpr std::uint32_t kLeastReturns = 3;  ///< below, a static voxel was hardly seen
  static constexpr std::uint8_t kPersonId = 11;

  /// `world`: the true map, without people; it must outlive this. `T_world_map`: the frame of the map to be judged in
  /// that of the true map. `config`: of the mapping; returns beyond its range do not count.
  MoverTruth(const mapping::SemanticOcTree& world, const SE3& T_world_map, const mapping::MappingConfig& config);

  /// `scan`: along the true path, in the frame of the true map.
  void count(const TrueScan& scan);
  /// `scan`: along the path that the map was made with, in its frame. Error: the reference exceeds its memory.
  [[nodiscard]] Result<void> insert(const TrueScan& scan);
  [[nodiscard]] MoverError judge(const mapping::SemanticOcTree& map) const;

 private:
  struct Seen {
    std::uint32_t people = 0, others = 0;  // returns
  };

  [[nodiscard]] bool near_what_stands(const octomap::OcTreeKey& key) const;
  void judge_static(const mapping::SemanticOcTree& map, const Eigen::Vector3d& p_map, MoverError& error) const;

  const mapping::SemanticOcTree& world_;
  SE3 T_map_world_;
  double max_range_m_;
  Workers workers_{1};
  mapping::Mapper reference_;
  std::vector<Eigen::Vector3f> standing_;  // of one scan
  std::unordered_map<octomap::OcTreeKey, Seen, octomap::OcTreeKey::KeyHash> voxels_;
};

}  // namespace cairn::cli
