// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "drivers/drive/can_drive.hpp"
#include "hal/latest_value.hpp"
#include "onboard/app/commands/commander.hpp"
#include "onboard/app/streams/outlets/stream_outlets.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/scheduler/feed.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// A CAN bus whose answers a replay repeats: frames come as the feed says, and sends end as they did then.
class ReplayableCanLink final : public drive::CanLink {
 public:
  /// Of the task that uses the link, in schedule.log.
  struct Slots {
    std::size_t frames;  ///< taken
    std::size_t full;    ///< which sends found the queue full, one bit each
    std::size_t down;    ///< which sends found the link down, one bit each
    std::size_t errors;  ///< complaints of the link
  };

  /// `bus` (null in a replay: frames go nowhere) and `source` must outlive the link.
  ReplayableCanLink(Source& source, SourceId id, const Slots& slots, drive::CanLink* bus, scheduler::Feed::Tap tap);

  void begin(scheduler::Tick& tick);
  Result<Poll> next(Packet& packet, Duration timeout) override;
  drive::SendResult send(const drive::CanFrame& frame) override;
  Result<void> restart() override;

  scheduler::Feed feed;

 private:
  Slots slots_;
  drive::CanLink* bus_;
  scheduler::Tick* tick_ = nullptr;
  int sends_ = 0;
  std::int32_t errors_ = 0, errors_returned_ = 0;  // in this tick
};

/// Ticks the drive and holds it to the safety task's decisions. It allocates nothing, locks nothing and never waits.
class DriveTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  const ReplayableCanLink::Slots can_slots{take_slots(), take_slots(), take_slots(), take_slots()};
  scheduler::InputPort<safety::FailsafeDecision> decisions{*this, "decisions"};
  scheduler::OutputPort<DriveNews> status{*this, "status"};
  scheduler::OutputPort<DriveState> wheels{*this,
                                           "wheels"};  ///< each new state; one is left out where the port is full

  const std::size_t commands_slot = take_slots();  ///< packets of the command socket taken
  scheduler::OutputPort<RearmRequest> rearms{*this, "rearms"};
  scheduler::OutputPort<clients::Placement> places{*this, "places"};  ///< for the team

  /// Says where the robot is to move, at a time; none: nowhere. The task sets the epoch of the command. Called in every
  /// tick, on the task's thread.
  using Planner = std::function<std::optional<DriveCommand>(Time)>;

  DriveTask() = default;
  /// `source` and `bus` (null in a replay) must outlive the task. Error kInvalidConfig.
  Result<void> attach(const drive::Config& config, Source& source, SourceId id, drive::CanLink* bus,
                      scheduler::Feed::Tap tap);
  void set_planner(Planner planner) { planner_ = std::move(planner); }
  /// Clients of the command socket are the planner. `source` and `answers` (null in a replay) must outlive the task. To
  /// be called after attach(): without it, the robot has no drive that could be commanded.
  /// `moves`: false, where the drive is one of a recording; then the task's input ends without the commands.
  void obey_commands(Source& source, SourceId id, clients::AnswerPort* answers, scheduler::Feed::Tap tap,
                     bool moves = true);
  /// Live: the status of the drive goes to `latest`, too, with every tick. To be called before the run; `latest` must
  /// outlive the task.
  void publish_to(LatestValue<std::optional<DriveStatus>>& latest) { published_to_ = &latest; }

  /// Live: what the wheels measured goes to `outlets`, too, while it is wanted. To be called before the run; `outlets`
  /// must outlive the task.
  void tell_wheels(StreamOutlets& outlets) { outlets_ = &outlets; }

  void tick(scheduler::Tick& tick) override;

  /// Of the task's thread, or after the run.
  [[nodiscard]] const std::optional<DriveState>& state() const { return state_; }
  [[nodiscard]] const drive::CanDrive* drive() const { return drive_.get(); }
  [[nodiscard]] Time first_arrival();
  [[nodiscard]] std::uint64_t missing_packets() const;

 private:
  struct Commands {
    Commands(Source& source, SourceId id, std::size_t slot, clients::AnswerPort* port, scheduler::Feed::Tap tap,
             const Commander::Abilities& abilities, bool awaited);
    [[nodiscard]] bool ended() const { return !awaited || feed.ended(); }
    scheduler::Feed feed;
    Commander commander;
    clients::AnswerPort* answers;
    bool awaited;  // the run goes on until they end
  };
  void obey(scheduler::Tick& tick);
  void obey_commander(scheduler::Tick& tick);
  void answer(Time now);
  void command(Time now);
  void tick_without_drive(scheduler::Tick& tick);
  template <class T>
  static void hand_on(scheduler::OutputPort<T>& port, const T& value, scheduler::Tick& tick);
  [[nodiscard]] Commander::Situation situation(Time now) const {
    return {now, decision_, drive_ ? drive_->status() : DriveStatus{}};
  }
  void publish(scheduler::Tick& tick);
  void publish_wheels(scheduler::Tick& tick);
  void tell_clients();

  Planner planner_;
  std::unique_ptr<ReplayableCanLink> link_;
  std::unique_ptr<drive::CanDrive> drive_;
  std::unique_ptr<Commands> commands_;
  double max_speed_m_s_ = 0, max_yaw_rate_rad_s_ = 0;  // of the drive
  DriveCommand told_;                                  // in this tick
  safety::FailsafeDecision decision_;
  std::optional<std::uint32_t> epoch_;  // of the last arming
  std::optional<DriveState> state_;
  Time published_wheels_ = Time::min();  // stamp
  DriveNews published_;
  LatestValue<std::optional<DriveStatus>>* published_to_ = nullptr;
  StreamOutlets* outlets_ = nullptr;
};

}  // namespace cairn::app
