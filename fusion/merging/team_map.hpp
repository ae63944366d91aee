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

/// The newest tiles of everyone, and the team's map made of them. The finished map is a pure function of the newest
/// tiles and poses: the order in which they came, how the work was cut into slices and where the robot was do not
/// matter, and without a robot's submaps the bytes are those from before it came. Labels are fused where the voxel is
/// occupied. Log-odds are multiples of 2⁻¹⁰, so that machines that round differently agree.
///
/// The work is done in steps of one tile, whose cost is bounded (tens of microseconds for a few robots). New tiles
/// change the map at once, a tile at a time, as do submaps that have just begun. Other new poses change all of it: a
/// second map is built beside the first, which goes on being kept up to date, and takes its place when it is complete.
/// So whoever asks never sees a map of two minds.
class TeamMap {
 public:
  /// All submaps have this resolution.
  TeamMap(double resolution_m, Policy policy);

  /// The newest state of a tile; an empty one removes it.
  void put(const SubmapKey& submap, TileKey tile, const TileState& state, Time stamp);
  /// Forgets the tiles of a robot.
  void drop(std::uint64_t robot);
  /// From now on these take part. Poses beyond ±2¹⁵ voxels do not.
  void place(const SubmapPoses& T_team_submaps);
  /// Work near this point of the team's map is done first.
  void set_focus(const Eigen::Vector3d& point_team) { focus_ = point_team; }

  /// Goes on while the budget lasts. True: the map is that of the newest tiles and poses.
  bool fuse(Budget& budget);
  [[nodiscard]] bool up_to_date() const;
  /// map() has the newest tiles, if not yet the newest poses.
  [[nodiscard]] bool shows_newest_tiles() const { return complete(shown_); }
  /// Tiles that wait for their turn; those of the map that is to come are not counted before it is known which.
  [[nodiscard]] std::size_t backlog() const;

  /// Consistent: of one set of poses. It is another tree after new poses, and changes with each fuse().
  [[nodiscard]] const SemanticOcTree& map() const { return *shown_.fused; }
  /// Where the submaps of map() lie.
  [[nodiscard]] const SubmapPoses& poses() const { return shown_.poses; }

  /// Who had a say in a tile of map(), and when the newest of it came.
  struct Origin {
    std::vector<std::uint64_t> robots;  ///< ascending
    Time newest{};
  };
  [[nodiscard]] Origin origin_of(TileKey tile) const;

 private:
  using Dirty = std::map<std::uint64_t, std::set<TileKey>>;  // by region: tiles to be fused
  /// One map, for one set of poses.
  struct View {
    SubmapPoses poses;
    std::map<SubmapKey, Placement> placements;
    std::unique_ptr<SemanticOcTree> fused;
    Dirty dirty, later;                   // later: changed while the view was being built
    int catch_ups = 0;                    // with these
    std::optional<std::uint64_t> region;  // being worked on
    // Of a new view: whose tiles are marking what they touch, and the last that has; none: all have.
    std::optional<SubmapKey> marking;
    std::optional<TileKey> marked;
  };
  [[nodiscard]] View view_of(const SubmapPoses& poses) const;
  [[nodiscard]] std::unique_ptr<SemanticOcTree> empty_map();
  [[nodiscard]] static bool complete(const View& view) { return !view.marking && view.dirty.empty(); }
  static void mark(Dirty& dirty, const Placement& placement, TileKey tile);
  void mark_some(View& view) const;
  void step(View& view);
  [[nodiscard]] TileKey take_nearest(View& view) const;
  void fuse_tile(View& view, TileKey tile);
  [[nodiscard]] VoxelLabel fused_label(std::size_t known, std::size_t voxel);
  void begin_wanted();
  [[nodiscard]] bool add_to_shown(const View& wanted);
  void catch_up_or_show();
  void show_next();

  double resolution_m_;
  std::map<SubmapKey, TileLayer> layers_;
  View shown_;
  std::optional<View> next_;
  std::unique_ptr<SemanticOcTree> spare_;  // of the view before: to take memory for a map would make a step long
  SubmapPoses wanted_;
  bool redo_ = false;  // shown_ and next_ hold what is to be forgotten
  unsigned turn_ = 0;
  Eigen::Vector3d focus_ = Eigen::Vector3d::Zero();
  RememberedFold fold_;
  std::vector<Placement::Said> said_;  // of a tile, by submap; reused
  std::vector<float> opinions_;
  std::vector<VoxelLabel> labels_;
};

}  // namespace cairn::merging
