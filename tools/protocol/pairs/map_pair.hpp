// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::protocol {

// The purposes of pairs of maps.

/// Tables 4.3 to 4.5: two robots, or two halves of a map.
inline constexpr const char* kScene = "scene";
inline constexpr const char* kOverlap = "overlap";  ///< the same, cut to less and less overlap
/// Table 5.2: b by LiDAR, a by a depth camera.
inline constexpr const char* kHeterogeneous = "heterogeneous";
/// Table 6.2: two robots among people.
inline constexpr const char* kMission = "mission";
/// Tables 5.2 and 7.5: a by the LiDAR of a UGV, b by the stereo camera of a UAV, both growing.
inline constexpr const char* kUnlike = "unlike";

/// Two maps of one place and where b's frame lies in a's.
struct MapPair {
  std::string name, scene, kind = kScene;
  std::shared_ptr<const mapping::SemanticOcTree> a, b;
  SE3 T_a_b;
  double overlap = 0;  ///< see overlap_of()
  std::size_t voxels_a = 0, voxels_b = 0, edges_a = 0, edges_b = 0;
};

/// Centres of the occupied voxels, m, in depth-first order. Empty for a map beyond
/// matching::kMaxVoxels.
[[nodiscard]] std::vector<Eigen::Vector3f> occupied_centres(const mapping::SemanticOcTree& map);

/// Fills in overlap and counts from the maps.
void measure(MapPair& pair);

/// A folder with a.cairn, b.cairn and pair.json. Labels are kept. Errors: those of the disk; kMalformed.
[[nodiscard]] Result<void> save_pair(const MapPair& pair, const std::filesystem::path& dir);
[[nodiscard]] Result<MapPair> load_pair(const std::filesystem::path& dir);

/// The book's ε (4.21) at a pose: the mean, over both maps, of the share of occupied voxels that
/// have one of the other map within the diagonal of a voxel.
[[nodiscard]] double overlap_of(const mapping::SemanticOcTree& a, const mapping::SemanticOcTree& b, const SE3& T_a_b);

/// Cuts both maps across `along` (in frame a) so that their overlap becomes `overlap`. A smaller
/// overlap stays as it is. a keeps what lies below one plane, b what lies above another. Both
/// planes have the same distance from the middle of the common part.
[[nodiscard]] MapPair cut_to_overlap(const MapPair& whole, const Eigen::Vector3d& along, double overlap);

}  // namespace cairn::protocol
