// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <deque>
#include <string>

#include "hal/monitor.hpp"
#include "onboard/app/restart/generations.hpp"
#include "onboard/app/restart/map_copier.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn::app {

/// Keeps on disk what the next run needs after a crash: the pose with every tick, scans and keyframes when there
/// are new ones, the map when a copy of it is there. Live only. A slow or full disk delays this task alone.
class SavingTask final : public scheduler::Task {
 public:
  /// The references must outlive the task. `first_epoch`: the number on disk of this run's epoch 0.
  SavingTask(Generations& generations, ToSave& in, std::uint32_t first_epoch, std::string boot, Monitor& monitor)
      : generations_(generations), in_(in), first_epoch_(first_epoch), boot_(std::move(boot)), monitor_(monitor) {}

  /// The scans and keyframes that the run goes on with. They are of its epoch 0.
  void go_on_with(const Generation& saved) {
    for (const odometry::PlacedScan& scan : saved.scans) scans_.add(scan);
    keyframes_.assign(saved.keyframes.begin(), saved.keyframes.end());
  }

  void tick(scheduler::Tick& tick) override { save(tick.release()); }
  /// Writes what waits to the disk.
  void save(Time now);
  /// After the last tick of all tasks: writes what waits, and the whole map.
  void close(Time now, const Robot& robot);

  /// Any thread: the last write failed.
  [[nodiscard]] bool failing() const { return failing_.load(std::memory_order_relaxed); }

 private:
  void save_pose(Time now);
  void save_scans(Time now);
  void save_keyframes(Time now);
  void save_copy(Time now);
  void save_map(Time now, const mapping::SemanticOcTree& map, const TrackPoint& newest);
  [[nodiscard]] SavedState state_at(const TrackPoint& point) const;
  void note(Time now, const Result<void>& saved);

  Generations& generations_;
  ToSave& in_;
  std::uint32_t first_epoch_;
  std::string boot_;
  Monitor& monitor_;
  odometry::RecentScans scans_;
  std::uint32_t scans_epoch_ = 0;
  std::deque<visual_odometry::Keyframe> keyframes_;
  std::uint32_t keyframes_epoch_ = 0;
  std::atomic<bool> failing_{false};
};

}  // namespace cairn::app
