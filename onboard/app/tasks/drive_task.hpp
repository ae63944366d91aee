// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "drivers/drive/can_drive.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/scheduler/feed.hpp"

namespace cairn {

/// A CAN bus as the tick gives it: frames as the feed says, and the answers to what is sent as they were then. Slots of
/// the drive task: 0 frames taken, 1 and 2 which sends found the queue full or the link down, 3 complaints of the link.
class FedLink final : public drive::CanLink {
 public:
  static constexpr std::size_t kFramesSlot = 0, kFullSlot = 1, kDownSlot = 2, kErrorSlot = 3;

  /// `bus` (null in a replay: frames go nowhere) and `source` must outlive the link.
  FedLink(Source& source, SourceId id, drive::CanLink* bus, scheduler::Feed::Tap tap);

  void begin(scheduler::Tick& tick);
  Result<Poll> next(Packet& packet, Duration timeout) override;
  drive::SendResult send(const drive::CanFrame& frame) override;
  Result<void> restart() override;

  scheduler::Feed feed;

 private:
  drive::CanLink* bus_;
  scheduler::Tick* tick_ = nullptr;
  int sends_ = 0;
  std::int32_t errors_ = 0, errors_told_ = 0;
};

/// Ticks the drive and holds it to the safety task's decisions. It allocates nothing, locks nothing and never waits.
/// Further slots: 4 decisions taken, 5 news accepted.
class DriveTask final : public scheduler::Task {
 public:
  static constexpr std::size_t kDecisionSlot = 4, kNewsSlot = 5;
  /// What wants to move the robot; its epoch is set here. Called in every tick, on the task's thread.
  using Planner = std::function<std::optional<DriveCommand>(Time)>;

  /// All must outlive the task.
  DriveTask(DecisionChannel& decisions, DriveChannel& news) : decisions_(decisions), news_(news) {}
  /// Error kInvalidConfig.
  Result<void> attach(const drive::Config& config, Source& source, SourceId id, drive::CanLink* bus,
                      scheduler::Feed::Tap tap);
  void set_planner(Planner planner) { planner_ = std::move(planner); }

  void tick(scheduler::Tick& tick) override;

  /// Of the task's thread, or of a run that has ended.
  [[nodiscard]] const std::optional<DriveState>& state() const { return state_; }
  [[nodiscard]] const drive::CanDrive* drive() const { return drive_.get(); }
  [[nodiscard]] Time first_arrival() { return link_ ? link_->feed.first_arrival() : Time::max(); }
  [[nodiscard]] std::uint64_t missing_packets() const { return link_ ? link_->feed.missing() : 0; }

 private:
  void obey(scheduler::Tick& tick);
  void command(Time now);
  void tell(scheduler::Tick& tick);

  DecisionChannel& decisions_;
  DriveChannel& news_;
  Planner planner_;
  std::unique_ptr<FedLink> link_;
  std::unique_ptr<drive::CanDrive> drive_;
  FailsafeDecision decision_;
  std::optional<std::uint32_t> epoch_;  // of the last arming
  std::optional<DriveState> state_;
  DriveNews told_;
};

}  // namespace cairn
