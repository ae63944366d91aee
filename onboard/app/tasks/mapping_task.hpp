// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <vector>

#include "hal/monitor.hpp"
#include "hal/relaxed_counter.hpp"
#include "onboard/app/perception/box_joiner.hpp"
#include "onboard/app/perception/cloud_joiner.hpp"
#include "onboard/app/perception/label_joiner.hpp"
#include "onboard/app/perception/people_log.hpp"
#include "onboard/app/rejoin/rejoin_plan.hpp"
#include "onboard/app/restart/map_copier.hpp"
#include "onboard/app/streams/outlets/stream_outlets.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/app/team/team_messages.hpp"
#include "onboard/safety/overload.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// Located scans in, map out, one in a tick; labels of pictures are joined with the scans around them. When its scans
/// come too late it sheds work, in the order of Shed. It hands on changed tiles where its port `tiles` is connected.
class MappingTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  scheduler::InputPort<ArrivedMotion> motions{*this, "motions"};
  const std::size_t shed_slot = take_slots();  ///< the level of shedding
  scheduler::OutputPort<TileBatch> tiles{*this, "tiles"};
  scheduler::InputPort<ArrivedLabels> labels{*this, "labels"};
  scheduler::InputPort<ArrivedCloud> clouds{*this, "clouds"};
  scheduler::InputPort<ArrivedBoxes> boxes{*this, "boxes"};                  ///< of the colour camera
  scheduler::InputPort<ArrivedBoxes> thermal_boxes{*this, "thermal_boxes"};  ///< of the thermal camera
  scheduler::InputPort<Mates> mates{*this, "mates"};                         ///< where teammates are
  scheduler::OutputPort<RejoinJob> rejoin_jobs{*this, "rejoin_jobs"};
  scheduler::InputPort<RejoinJob> rejoined{*this, "rejoined"};

  /// All must outlive the task. `deadline`: from the last byte of a scan until the scan is in the map.
  MappingTask(const safety::OverloadConfig& overload, Duration deadline, Robot& robot, Monitor& monitor);

  /// Live: hands on copies of the map and scans. To be called before the run.
  void keep_copies(MapCopier copier) { copier_.emplace(std::move(copier)); }
  /// Live: changed tiles go to `outlet`, too, and first those of a resumed map. That changes nothing for the port. To
  /// be called before the run; `outlet` must outlive the task.
  void serve(TileOutlet& outlet);
  /// Live: after each scan or cloud in which they were looked for, the people around the robot go to `outlet`. What
  /// finds no room is left out. To be called before the run; `outlet` must outlive the task.
  void tell_people(SpscQueue<PeopleNews>& outlet) { people_outlet_ = &outlet; }
  /// After the run: `outlet` gets all tiles as they are now, as far as it has room. True: it has them all.
  bool serve_rest();

  /// The first batch holds the tiles of a resumed map. To be called before the run.
  void share_resumed_tiles();

  void tick(scheduler::Tick& tick) override;

  /// Any thread.
  [[nodiscard]] safety::Shed shed() const { return level_.load(std::memory_order_relaxed); }
  /// Any thread: the level as a report may name it.
  [[nodiscard]] safety::Shed shed_in_force() const { return safety::in_force(shed(), shed_work()); }
  /// What can be left out besides points.
  [[nodiscard]] safety::ShedWork shed_work() const {
    const bool boxed = boxes.channel() != nullptr || thermal_boxes.channel() != nullptr;
    return {.peers = tiles.connected(), .pictures = boxed || labels.channel() != nullptr};
  }
  /// Any thread: the last scan found no memory in the map.
  [[nodiscard]] bool memory_short() const { return memory_short_.load(std::memory_order_relaxed); }
  /// Scans that were mapped at each level.
  [[nodiscard]] const std::array<RelaxedCounter, safety::kShedLevels>& scans_at() const { return scans_at_; }
  [[nodiscard]] const LabelJoiner::Figures& label_figures() const { return label_joiner_.figures(); }
  [[nodiscard]] const BoxJoiner& box_joiner() const { return box_joiner_; }
  [[nodiscard]] const PeopleLog& people_log() const { return people_log_; }
  [[nodiscard]] const CloudJoiner::Figures& cloud_figures() const { return cloud_joiner_.figures(); }

 private:
  void extend(const ArrivedMotion& motion, scheduler::Tick& tick);
  void note_people(Time stamp, const SE3& T_odom_base);
  void join_clouds(scheduler::Tick& tick);
  void take_pictures(scheduler::Tick& tick);
  void rejoin(scheduler::Tick& tick);
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
  LabelJoiner label_joiner_;
  CloudJoiner cloud_joiner_;
  BoxJoiner box_joiner_;
  PeopleLog people_log_;
  RejoinPlan rejoin_plan_;
  std::optional<MapCopier> copier_;
  std::vector<mapping::TileKey> resumed_tiles_;  // not handed on yet; of epoch 0
  struct Changes {
    std::uint32_t epoch;
    UncertainPose T_odom_base;
    Vector6 twist;
    Time stamp;
    bool lost;  // at one of the scans
  };
  std::optional<Changes> changes_;  // not handed on yet
  Time next_batch_{};
  TileOutlet* outlet_ = nullptr;
  SpscQueue<PeopleNews>* people_outlet_ = nullptr;
  Time mapped_{};             // stamp of the last scan
  bool owed_changes_ = true;  // up to that scan
  bool serving_rest_ = false;
};

}  // namespace cairn::app
