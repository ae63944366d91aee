// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>

#include "drivers/gpio/estop.hpp"
#include "drivers/gpio/gpio_lines.hpp"
#include "hal/spsc_queue.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/scheduler/feed.hpp"

namespace cairn {

/// The safety task reads the e-stop, knows who was heard last, and decides what the robot may do. It allocates nothing,
/// locks nothing and never waits. Slots: 0 edges taken, 1 the level where the edges did not tell it, 2 news of sensors
/// and 3 of the drive taken, 4 decisions accepted, 5 re-arm request, 6 faults that only the machine shows, 7 news of
/// odometry taken.
class SafetyTask final : public scheduler::Task {
 public:
  static constexpr std::size_t kEdgesSlot = 0, kLevelSlot = 1, kSensorsSlot = 2, kDriveSlot = 3, kDecisionSlot = 4,
                               kRearmSlot = 5, kFaultsSlot = 6, kOdometrySlot = 7;
  struct Parts {
    SeenChannel& sensors;
    DriveChannel& drive;
    DecisionChannel& decisions;
    OdometryChannel& odometry;
  };
  /// What changed, for whoever may lock and allocate.
  struct Change {
    Time at{};
    Mode mode{};
    std::optional<Fault> cause;
    FaultSet raised, ended, active;
    std::uint32_t epoch = 0;
  };
  static constexpr std::size_t kChanges = 1024;

  /// The parts must outlive the task.
  SafetyTask(const FailsafeConfig& config, const Fitted& fitted, const Parts& parts)
      : failsafe_(config, fitted), parts_(parts) {}
  /// The e-stop's line; `source` and `lines` (null in a replay) must outlive the task.
  void watch_estop(const gpio::Config& config, Source& source, SourceId id, gpio::GpioLines* lines,
                   scheduler::Feed::Tap tap);

  void tick(scheduler::Tick& tick) override;

  /// Any thread: the operator wants to move again; `epoch` is the one of the stop that he saw.
  void request_rearm(std::uint32_t epoch) { rearm_.store(static_cast<std::int32_t>(epoch) + 1); }
  /// Any one thread: faults that the machine shows and the data does not: a hung task, say.
  void report(FaultSet faults) { faults_.store(static_cast<std::int32_t>(faults.bits())); }

  /// One other thread.
  [[nodiscard]] SpscQueue<Change>& changes() { return changes_; }
  /// Of the task's thread, or of a run that has ended.
  [[nodiscard]] const FailsafeDecision& decision() const { return failsafe_.decision(); }
  [[nodiscard]] Time first_arrival() { return edges_ ? edges_->first_arrival() : Time::max(); }
  [[nodiscard]] std::uint64_t lost_changes() const { return lost_changes_; }
  [[nodiscard]] bool input_ended() const { return !edges_ || edges_->ended(); }

 private:
  void read_news(scheduler::Tick& tick);
  void read_estop(scheduler::Tick& tick);
  void read_level(scheduler::Tick& tick);
  void tell(const FailsafeDecision& before, scheduler::Tick& tick);

  Failsafe failsafe_;
  Parts parts_;
  FailsafeInputs inputs_;
  FaultSet sensor_faults_, odometry_faults_;
  Time arming_until_{};
  std::optional<gpio::EStop> estop_;
  std::optional<scheduler::Feed> edges_;
  gpio::GpioLines* lines_ = nullptr;
  std::int32_t closed_ = 0;  // as the edges say: 0 nothing yet, 1 open, 2 closed
  std::atomic<std::int32_t> rearm_{0}, faults_{0};
  SpscQueue<Change> changes_{kChanges};
  RelaxedCounter lost_changes_;
};

}  // namespace cairn
