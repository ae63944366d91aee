// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "fusion/merging/fold.hpp"
#include "fusion/merging/placed_tiles.hpp"
#include "fusion/merging/remembered_fold.hpp"
#include "hal/budget.hpp"
#include "hal/se3.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::merging {

/// A part of what one robot has mapped. The order is that in which opinions are folded.
struct SubmapKey {
  std::uint64_t robot = 0;
  std::uint16_t submap = 0;
  friend constexpr auto operator<=>(const SubmapKey&, const SubmapKey&) = default;
};
using SubmapPoses = std::map<SubmapKey, SE3>;  ///< T_team_submap of those that take part

/// The newest tiles of all robots, and the team's map that is fused of them.
///
/// The finished map is a pure function of the newest tiles and poses. The order in which they came, the slices of the
/// work and the place of the robot do not matter. Without a robot's submaps, the bytes are those from before it came.
/// Labels are fused in occupied voxels. Log-odds are multiples of 2⁻¹⁰, so machines that round differently agree.
///
/// The work is done in steps of one tile, of bounded cost: tens of microseconds for a few robots. New tiles change the
/// map at once, a tile at a time, and so do submaps that have just begun. Other new poses change all of the map: a
/// second map is built beside the first, and takes its place when it is complete. Meanwhile the first is kept up to
/// date. So map() is always of one set of poses.
class TeamMap {
 public:
  /// All submaps have this resolution.
  TeamMap(double resolution_m, Policy policy);

  /// The newest state of a tile, and when it came. An empty state removes the tile.
  void put(const SubmapKey& submap, mapping::TileKey tile, const mapping::TileState& state, Time stamp);
  /// Forgets all tiles of a robot.
  void drop(std::uint64_t robot);
  /// From now on these submaps take part. Those beyond ±2¹⁵ voxels do not.
  void place(const SubmapPoses& T_team_submaps);
  /// Work near this point of the team's map is done first.
  void set_focus(const Eigen::Vector3d& point_team) { focus_ = point_team; }

  /// Goes on while the budget lasts. True: map() has the newest tiles and poses.
  bool fuse(Budget& budget);
  [[nodiscard]] bool up_to_date() const;
  /// map() has the newest tiles, if not yet the newest poses.
  [[nodiscard]] bool shows_newest_tiles() const { return complete(shown_); }
  /// How many tiles are known to wait for their turn, in both maps.
  [[nodiscard]] std::size_t backlog() const;

  /// The map that is shown. It changes with each fuse(), and may be another tree then.
  [[nodiscard]] const mapping::SemanticOcTree& map() const { return *shown_.fused; }
  /// Where the submaps of map() lie.
  [[nodiscard]] const SubmapPoses& poses() const { return shown_.poses; }

  /// Who had a say in a tile of map(), and when the newest of it came.
  struct Origin {
    std::vector<std::uint64_t> robots;  ///< ascending
    Time newest{};
  };
  [[nodiscard]] Origin origin_of(mapping::TileKey tile) const;

  /// From now on the tiles of map() that may have changed are noted. That is work for those who look at them alone.
  void note_changes() { changed_.emplace(); }
  /// In canonical order, each once; all of both maps after map() has become another one. Empty before note_changes().
  [[nodiscard]] std::vector<mapping::TileKey> take_changed_tiles();

 private:
  using Dirty = std::map<std::uint64_t, std::set<mapping::TileKey>>;  // by region: tiles to be fused
  /// One map, for one set of poses.
  struct View {
    SubmapPoses poses;
    std::map<SubmapKey, Placement> placements;
    std::unique_ptr<mapping::SemanticOcTree> fused;
    Dirty dirty, later;                   // later: changed while the view was being built
    int catch_ups = 0;                    // with these
    std::optional<std::uint64_t> region;  // being worked on
    // Of a new view: whose tiles are marking what they touch, and the last that has; none: all have.
    std::optional<SubmapKey> marking;
    std::optional<mapping::TileKey> marked;
  };
  [[nodiscard]] View view_of(const SubmapPoses& poses) const;
  [[nodiscard]] std::unique_ptr<mapping::SemanticOcTree> empty_map();
  [[nodiscard]] static bool complete(const View& view) { return !view.marking && view.dirty.empty(); }
  static void mark(Dirty& dirty, const Placement& placement, mapping::TileKey tile);
  void mark_some(View& view) const;
  void step(View& view);
  [[nodiscard]] mapping::TileKey take_nearest(View& view) const;
  void fuse_tile(View& view, mapping::TileKey tile);
  [[nodiscard]] mapping::VoxelLabel fused_label(std::size_t known, std::size_t voxel);
  void begin_wanted();
  [[nodiscard]] bool add_to_shown(const View& wanted);
  void catch_up_or_show();
  void show_next();
  void note_all(const mapping::SemanticOcTree& map);

  double resolution_m_;
  std::map<SubmapKey, TileLayer> layers_;
  View shown_;
  std::optional<View> next_;
  // of the view before: to take memory for a map would make a step long
  std::unique_ptr<mapping::SemanticOcTree> spare_;
  SubmapPoses wanted_;
  bool redo_ = false;  // shown_ and next_ hold what is to be forgotten
  unsigned turn_ = 0;
  Eigen::Vector3d focus_ = Eigen::Vector3d::Zero();
  std::optional<std::set<mapping::TileKey>> changed_;
  RememberedFold fold_;
  std::vector<Placement::Opinion> by_submap_;  // of a tile; reused
  std::vector<float> opinions_;                // of a voxel
  std::vector<mapping::VoxelLabel> labels_;
};

}  // namespace cairn::merging
