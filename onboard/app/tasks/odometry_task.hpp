// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <optional>

#include "hal/monitor.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/app/tasks/map_copier.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/app/team/team_messages.hpp"
#include "onboard/safety/overload.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn {

/// Scan in, pose out, one in a tick. Slots: 0 scans taken, 1 iterations granted, 2 located scans and 3 news accepted.
class OdometryTask final : public scheduler::Task {
 public:
  static constexpr std::size_t kScansSlot = 0, kStepsSlot = 1, kMotionsSlot = 2, kNewsSlot = 3;
  using Progress = std::function<void(Time, std::size_t scans)>;

  struct Parts {
    ScanChannel& scans;
    MotionChannel& motions;
    OdometryChannel& news;
  };

  /// All must outlive the task. `progress` is called after every scan, on the task's thread; may be empty.
  OdometryTask(const RobotProfile& profile, const Parts& parts, Robot& robot, Monitor& monitor, Progress progress);

  /// Live: where every pose goes, besides. To be called before the run; `pose` must outlive the task.
  void tell(LatestValue<TrackPoint>& pose) { told_ = &pose; }

  void tick(scheduler::Tick& tick) override;

 private:
  void locate(const ArrivedScan& arrived, scheduler::Tick& tick);
  void tell_safety(scheduler::Tick& tick);

  Duration deadline_;
  int max_iterations_;
  Parts parts_;
  Robot& robot_;
  Monitor& monitor_;
  StageStats& latency_;
  Progress progress_;
  LatestValue<TrackPoint>* told_ = nullptr;
  LocatedScan dropped_;  // filled when the channel is full
  std::size_t count_ = 0;
  bool lost_ = false, told_lost_ = false;
};

/// Located scans in, map out, one in a tick. When its scans come too late it sheds work, in the order of Shed. Slots:
/// 0 located scans taken, 1 the level of shedding, 2 batches of tiles accepted.
class MappingTask final : public scheduler::Task {
 public:
  static constexpr std::size_t kMotionsSlot = 0, kShedSlot = 1, kTilesSlot = 2;

  /// All must outlive the task. `deadline`: from a scan's last byte to its being in the map.
  MappingTask(const OverloadConfig& overload, Duration deadline, MotionChannel& motions, Robot& robot,
              Monitor& monitor);

  /// Live: hands on copies of the map and scans. To be called before the run.
  void keep_copies(MapCopier copier) { copier_.emplace(std::move(copier)); }

  /// Hands on what scans change, and first what a resumed map holds. To be called before the run; `tiles` must outlive
  /// the task.
  void share_tiles(TileChannel& tiles);

  void tick(scheduler::Tick& tick) override;

  /// Any thread.
  [[nodiscard]] Shed shed() const { return level_.load(std::memory_order_relaxed); }
  /// Any thread: the last scan found no memory in the map.
  [[nodiscard]] bool memory_short() const { return memory_short_.load(std::memory_order_relaxed); }
  /// Scans that were mapped at each level.
  [[nodiscard]] const std::array<RelaxedCounter, kShedLevels>& scans_at() const { return scans_at_; }

 private:
  void extend(const ArrivedMotion& motion, scheduler::Tick& tick);
  Shed decide(const ArrivedMotion& motion, scheduler::Tick& tick);
  void note_changes(const LocatedScan& scan, scheduler::Tick& tick);
  void hand_on_tiles(scheduler::Tick& tick);

  Duration deadline_;
  OverloadController overload_;
  std::atomic<Shed> level_{Shed::kNothing};
  std::atomic<bool> memory_short_{false};
  std::array<RelaxedCounter, kShedLevels> scans_at_{};
  std::uint64_t count_ = 0;
  MotionChannel& motions_;
  Robot& robot_;
  Monitor& monitor_;
  StageStats& latency_;
  std::optional<MapCopier> copier_;
  TileChannel* tiles_ = nullptr;
  std::vector<TileKey> resumed_tiles_;  // not handed on yet; of epoch 0
  struct Changes {
    std::uint32_t epoch;
    UncertainPose T_odom_base;
  };
  std::optional<Changes> changes_;  // not handed on yet
  Time next_batch_{};
};

}  // namespace cairn
