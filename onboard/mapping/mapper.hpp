// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "hal/result.hpp"
#include "hal/workers.hpp"
#include "onboard/mapping/insert/entered_voxels.hpp"
#include "onboard/mapping/insert/footprint.hpp"
#include "onboard/mapping/insert/footprint_applier.hpp"
#include "onboard/mapping/insert/retraction.hpp"
#include "onboard/mapping/insert/scan_rays.hpp"
#include "onboard/mapping/labels/label_updater.hpp"
#include "onboard/mapping/mapping_config.hpp"
#include "onboard/mapping/tree/map_tile.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// What became of one scan.
struct InsertReport {
  std::size_t points = 0;         ///< given
  std::size_t not_finite = 0;     ///< of these, left out because a coordinate is NaN or infinite
  std::size_t outside_map = 0;    ///< of these, left out because they lie outside of the ±2¹⁵ voxels of a tree
  std::size_t rays = 0;           ///< marched, after points in the same voxel became one
  std::size_t cleared = 0;        ///< voxels that something had entered and left; see EnteredVoxels
  std::size_t changed_tiles = 0;  ///< see Mapper::changed_tiles()
};

/// How sure a voxel is.
enum class Standing : std::uint8_t {
  kUnknown,   ///< never seen, or hardly
  kFree,      ///< rays went through several times
  kOccupied,  ///< one or two contradictions would free it
  kSettled,   ///< seen occupied so often that one contradiction would not free it
};

/// Keeps the map of one robot. With MappingConfig::spare_surfaces off, inserting a scan leaves exactly the tree, inner
/// nodes and log-odds bits included, that octomap::OcTree::insertPointCloud(points, origin, max_range, lazy_eval =
/// false, discretize = true) would leave for the points that were accepted. With it on, beams that run along a surface
/// free less; see SurfaceBeams. The result does not depend on the number of threads.
class Mapper {
 public:
  /// `workers` must outlive the mapper.
  Mapper(const MappingConfig& config, Workers& workers);
  /// Goes on with a copy of `saved`, which must have the config's resolution.
  Mapper(const MappingConfig& config, Workers& workers, const SemanticOcTree& saved);
  Mapper(const Mapper&) = delete;
  Mapper& operator=(const Mapper&) = delete;
  ~Mapper() = default;

  /// `points_map` and the sensor's position `origin_map`, in metres in the map frame. On an error (origin outside of
  /// the map, scan or map beyond its memory) the map is as before.
  Result<InsertReport> insert(std::span<const Eigen::Vector3f> points_map, const Eigen::Vector3f& origin_map);

  /// The same for a sensor whose points mean less or more, or that sees less far. It spares no surfaces: what is wide
  /// along the beam is noise there.
  Result<InsertReport> insert(std::span<const Eigen::Vector3f> points_map, const Eigen::Vector3f& origin_map,
                              const SensorTrust& trust);

  /// The same as the first, and then clears what moved between the heights of `band` and has gone; see EnteredVoxels.
  /// Without MappingConfig::clear_movers it is the same.
  Result<InsertReport> insert(std::span<const Eigen::Vector3f> points_map, const Eigen::Vector3f& origin_map,
                              const HeightBand& band);

  /// Adds what a picture told of points, in the map frame, to the voxels that are occupied; see LabelUpdater. Occupancy
  /// does not change. A voxel that becomes free loses its label.
  LabelReport label(std::span<const LabelledPoint> points);

  /// Takes back what these points of one earlier scan have put into the map; see Retraction. Returns the voxels that
  /// changed.
  std::size_t take_back(std::span<const Eigen::Vector3f> points_map);

  /// Adds to these tiles, in canonical order, what `other` knows and the map does not; see fill_tile(). On an error
  /// (kLimit: the map's memory) the map is as before.
  Result<void> fill(std::span<const TileKey> tiles, const SemanticOcTree& other);

  /// What the map knows of a point's voxel.
  [[nodiscard]] Standing standing(const Eigen::Vector3f& point_map) const;

  /// Begins with an empty map, and returns the one before.
  std::unique_ptr<SemanticOcTree> begin_anew();

  [[nodiscard]] const SemanticOcTree& tree() const { return *tree_; }
  [[nodiscard]] const MappingConfig& config() const { return config_; }

  /// Tiles in which, since the last take_changed_tiles(), a voxel became known, went from free to occupied or back, or
  /// got a class or another one; in canonical order, each once. Log-odds that merely move do not count: in the open,
  /// every scan moves nearly all.
  [[nodiscard]] std::span<const TileKey> changed_tiles() const { return changed_; }
  [[nodiscard]] std::vector<TileKey> take_changed_tiles();

 private:
  void set_up();
  [[nodiscard]] bool march();
  void note_changed();
  [[nodiscard]] Result<void> room() const;

  MappingConfig config_;
  Workers& workers_;
  std::unique_ptr<SemanticOcTree> tree_;
  ScanRays rays_;
  std::vector<Footprint> footprints_;  // one per thread; all end up in the first
  FootprintApplier applier_;
  EnteredVoxels entered_;
  LabelUpdater labels_;
  Retraction retraction_;
  std::vector<TileKey> changed_, changed_now_, merged_;
  bool spares_ = true;  // what MappingConfig::spare_surfaces spares; false for noisy points
};

}  // namespace cairn::mapping
