// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hal/files/file_calls.hpp"
#include "hal/monitor.hpp"
#include "hal/result.hpp"
#include "onboard/app/restart/saved_scans.hpp"
#include "onboard/app/restart/saved_state.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"
#include "onboard/mapping/tree/tree_builder.hpp"

namespace cairn::app {

/// A map, where the robot was in it, and what it saw there last.
struct Generation {
  SavedState state;
  std::unique_ptr<mapping::SemanticOcTree> map;
  Time map_stamp{};                ///< what was seen later is not in the map
  std::uint32_t newest_epoch = 0;  ///< that was begun; larger than the map's if that one's map was not saved yet
  std::vector<odometry::PlacedScan> scans;  ///< empty: none were saved, or they are damaged
};

/// The map on disk, in a folder of its own: two generations, map.a.cairn and map.b.cairn, of which the older one is
/// replaced, and two files that are saved more often: state.txt, the newest pose, and scans.bin, the newest scans. Each
/// file is checksummed as a whole and replaced atomically: whenever the program dies or the disk fails, there is a
/// whole generation once there was one.
///
/// Pose and scans are not synced: they outlive the program, and after a reboot they would be worth nothing.
///
/// For a task that may wait: calls block on the disk. encode() alone needs the map; store() may run on another thread.
class Generations {
 public:
  /// `folder` is made if it is not there. `calls` and `monitor` must outlive the generations.
  Generations(std::filesystem::path folder, Monitor& monitor, FileCalls& calls = FileCalls::machine());

  /// The newest generation that is whole, with the newest pose and scans of its epoch; none when there is none. One
  /// event for each file that is not what it should be. To be called once, before the first save.
  [[nodiscard]] std::optional<Generation> load(Time now, const mapping::MapLimits& limits = {});
  /// After load(): a map file was there that could not be read.
  [[nodiscard]] bool damaged() const { return damaged_; }

  /// The bytes of the next generation. `state.sequence` is set here.
  [[nodiscard]] std::vector<std::byte> encode(const mapping::SemanticOcTree& map, SavedState state) const;
  /// On an error the generation before is as it was, and the next call tries the same place again.
  Result<void> store(std::span<const std::byte> generation);
  /// Both. Error kLimit also where there is no memory for the bytes.
  Result<void> save(const mapping::SemanticOcTree& map, const SavedState& state);
  /// Errors as of store(); what is in the generations stays as it is.
  Result<void> save_state(SavedState state);
  Result<void> save_scans(const SavedScans& scans);

  static constexpr std::array<const char*, 2> kMapFiles{"map.a.cairn", "map.b.cairn"};
  static constexpr const char* kStateFile = "state.txt";
  static constexpr const char* kScansFile = "scans.bin";

 private:
  [[nodiscard]] std::optional<Generation> load_file(std::size_t slot, Time now, const mapping::MapLimits& limits);
  void take_newer_pose(Generation& generation, Time now);
  void take_scans(Generation& generation, Time now);

  std::filesystem::path folder_;
  Monitor& monitor_;
  FileCalls& calls_;
  std::uint64_t sequence_ = 0;  ///< of the newest generation on disk
  std::size_t next_ = 0;        ///< the slot that is written next
  bool damaged_ = false;
};

}  // namespace cairn::app
