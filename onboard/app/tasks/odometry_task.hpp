// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <optional>

#include "hal/monitor.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/app/streams/stream_outlets.hpp"
#include "onboard/app/tasks/map_copier.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/app/tasks/wheel_history.hpp"
#include "onboard/app/team/team_messages.hpp"
#include "onboard/safety/overload.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// Scan in, pose out, one in a tick.
class OdometryTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  scheduler::InputPort<ArrivedScan> scans{*this, "scans"};
  const std::size_t steps_slot = take_slots();  ///< iterations granted
  scheduler::OutputPort<ArrivedMotion> motions{*this, "motions"};
  scheduler::OutputPort<OdometryNews> status{*this, "status"};
  scheduler::InputPort<DriveState> wheels{*this, "wheels"};

  using Progress = std::function<void(Time, std::size_t scans)>;

  /// All must outlive the task. `progress` is called after every scan, on the task's thread; may be empty.
  OdometryTask(const RobotProfile& profile, Robot& robot, Monitor& monitor, Progress progress);

  /// Live: every pose is written to `pose`, too. To be called before the run; `pose` must outlive the task.
  void publish_to(LatestValue<TrackPoint>& pose) { published_ = &pose; }
  /// Live: every pose goes to `outlets`, too, and scans while they are wanted. What finds no room is left out. To be
  /// called before the run; `outlets` must outlive the task.
  void serve(StreamOutlets& outlets) { outlets_ = &outlets; }

  void tick(scheduler::Tick& tick) override;

 private:
  void locate(const ArrivedScan& arrived, scheduler::Tick& tick);
  void publish_status(scheduler::Tick& tick);
  void hand_to_clients(const TrackPoint& point, const LocatedScan& scan);

  Duration deadline_;
  int max_steps_;
  WheelHistory history_;
  Robot& robot_;
  Monitor& monitor_;
  StageStats& latency_;
  Progress progress_;
  LatestValue<TrackPoint>* published_ = nullptr;
  StreamOutlets* outlets_ = nullptr;
  LocatedScan dropped_;  // filled when the channel is full
  std::size_t count_ = 0;
  bool lost_ = false, published_lost_ = false;
};

/// Located scans in, map out, one in a tick. When its scans come too late it sheds work, in the order of Shed. It hands
/// on changed tiles where its port `tiles` is connected.
class MappingTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  scheduler::InputPort<ArrivedMotion> motions{*this, "motions"};
  const std::size_t shed_slot = take_slots();  ///< the level of shedding
  scheduler::OutputPort<TileBatch> tiles{*this, "tiles"};

  /// All must outlive the task. `deadline`: from the last byte of a scan until the scan is in the map.
  MappingTask(const safety::OverloadConfig& overload, Duration deadline, Robot& robot, Monitor& monitor);

  /// Live: hands on copies of the map and scans. To be called before the run.
  void keep_copies(MapCopier copier) { copier_.emplace(std::move(copier)); }
  /// Live: changed tiles go to `outlet`, too, and first those of a resumed map. That changes nothing for the port. To
  /// be called before the run; `outlet` must outlive the task.
  void serve(TileOutlet& outlet);
  /// After the run: `outlet` gets all tiles as they are now, as far as it has room. True: it has them all.
  bool serve_rest();

  /// The first batch holds the tiles of a resumed map. To be called before the run.
  void share_resumed_tiles();

  void tick(scheduler::Tick& tick) override;

  /// Any thread.
  [[nodiscard]] safety::Shed shed() const { return level_.load(std::memory_order_relaxed); }
  /// Any thread: the last scan found no memory in the map.
  [[nodiscard]] bool memory_short() const { return memory_short_.load(std::memory_order_relaxed); }
  /// Scans that were mapped at each level.
  [[nodiscard]] const std::array<RelaxedCounter, safety::kShedLevels>& scans_at() const { return scans_at_; }

 private:
  void extend(const ArrivedMotion& motion, scheduler::Tick& tick);
  safety::Shed decide(const ArrivedMotion& motion, scheduler::Tick& tick);
  void note_changes(const LocatedScan& scan, scheduler::Tick& tick);
  void hand_on_tiles(scheduler::Tick& tick);
  void owe_changes();
  void hand_to_clients(std::size_t most);

  Duration deadline_;
  safety::OverloadController overload_;
  std::atomic<safety::Shed> level_{safety::Shed::kNothing};
  std::atomic<bool> memory_short_{false};
  std::array<RelaxedCounter, safety::kShedLevels> scans_at_{};
  std::uint64_t count_ = 0;
  Robot& robot_;
  Monitor& monitor_;
  StageStats& latency_;
  std::optional<MapCopier> copier_;
  std::vector<mapping::TileKey> resumed_tiles_;  // not handed on yet; of epoch 0
  struct Changes {
    std::uint32_t epoch;
    UncertainPose T_odom_base;
  };
  std::optional<Changes> changes_;  // not handed on yet
  Time next_batch_{};
  TileOutlet* outlet_ = nullptr;
  Time mapped_{};             // stamp of the last scan
  bool owed_changes_ = true;  // up to that scan
  bool serving_rest_ = false;
};

}  // namespace cairn::app
