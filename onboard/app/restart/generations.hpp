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
#include "onboard/app/restart/saved_keyframes.hpp"
#include "onboard/app/restart/saved_scans.hpp"
#include "onboard/app/restart/saved_state.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"
#include "onboard/mapping/tree/tree_builder.hpp"

namespace cairn::app {

/// A saved map, the pose of the robot in it, and the robot's last scans.
struct Generation {
  SavedState state;
  std::unique_ptr<mapping::SemanticOcTree> map;
  Time map_stamp{};                ///< of the last scan in the map
  std::uint32_t newest_epoch = 0;  ///< that was begun; above the map's epoch when its own map was not saved yet
  std::vector<odometry::PlacedScan> scans;           ///< empty: none were saved, or they are damaged
  std::vector<visual_odometry::Keyframe> keyframes;  ///< the same
};

/// The map on disk, in a folder of its own.
/// - map.a.cairn and map.b.cairn are two generations. Saving replaces the older one.
/// - state.txt is the newest pose, scans.bin the newest scans, and keyframes.bin the newest keyframes of a robot that
///   both eyes tell its motion. They are saved more often.
///
/// Each file has a checksum of the whole and is replaced atomically. Once there was a whole generation, there always is
/// one, whenever the program dies or the disk fails. Pose, scans and keyframes are not synced: they outlive the
/// program, and after a reboot they are of no use.
///
/// Calls block on the disk: they are for a task that may wait. Only encode() needs the map; store() may run on another
/// thread.
class Generations {
 public:
  /// Makes `folder` if it is not there. `calls` and `monitor` must outlive the generations.
  Generations(std::filesystem::path folder, Monitor& monitor, FileCalls& calls = FileCalls::machine());

  /// The newest whole generation, with the newest pose, scans and keyframes of its epoch; none: there is none. Each
  /// damaged file is one event. To be called once, before the first save.
  [[nodiscard]] std::optional<Generation> load(Time now, const mapping::MapLimits& limits = {});
  /// After load(): a map file was there that could not be read.
  [[nodiscard]] bool damaged() const { return damaged_; }

  /// The bytes of the next generation. Sets `state.sequence`.
  [[nodiscard]] std::vector<std::byte> encode(const mapping::SemanticOcTree& map, SavedState state) const;
  /// Error kIo: the previous generation is as it was, and the next call tries the same place again.
  Result<void> store(std::span<const std::byte> generation);
  /// encode() and store(). Error kLimit also when there is no memory for the bytes.
  Result<void> save(const mapping::SemanticOcTree& map, const SavedState& state);
  /// Errors as of store(). The generations stay as they are.
  Result<void> save_state(SavedState state);
  Result<void> save_scans(const SavedScans& scans);
  Result<void> save_keyframes(const SavedKeyframes& keyframes);

  static constexpr std::array<const char*, 2> kMapFiles{"map.a.cairn", "map.b.cairn"};
  static constexpr const char* kStateFile = "state.txt";
  static constexpr const char* kScansFile = "scans.bin";
  static constexpr const char* kKeyframesFile = "keyframes.bin";

 private:
  [[nodiscard]] std::optional<Generation> load_file(std::size_t slot, Time now, const mapping::MapLimits& limits);
  void take_newer_pose(Generation& generation, Time now);
  void take_scans(Generation& generation, Time now);
  void take_keyframes(Generation& generation, Time now);

  std::filesystem::path folder_;
  Monitor& monitor_;
  FileCalls& calls_;
  std::uint64_t sequence_ = 0;  ///< of the newest generation on disk
  std::size_t next_ = 0;        ///< the slot that is written next
  bool damaged_ = false;
};

}  // namespace cairn::app
