// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "drivers/drive/canopen/canopen.hpp"
#include "drivers/drive/canopen/cia402.hpp"
#include "onboard/app/tasks/drive_task.hpp"
#include "onboard/app/tasks/safety_task.hpp"
#include "onboard/scheduler/task_graph.hpp"
#include "tests/drivers/drive/virtual_bus.hpp"
#include "tests/faults/campaign.hpp"
#include "tests/support/command_queue.hpp"
#include "tests/support/estop_line.hpp"

namespace cairn::faults {

/// A driving robot: the robot's own safety and drive tasks, ticked as live every 2 ms of virtual time, an e-stop's line
/// and simulated motor controllers on a CAN bus.
class CoreRig {
 public:
  static constexpr Duration kTick = std::chrono::milliseconds(2);

  /// Around what is the tasks' own; the simulated bus is not.
  struct Guard {
    void (*enter)() = [] {};
    void (*leave)() = [] {};
  };

  CoreRig() : CoreRig(Guard{}) {}
  explicit CoreRig(const Guard& guard) : guard_(guard) {
    safety::Fitted fitted;
    fitted.drive = fitted.estop = fitted.watched[static_cast<std::size_t>(safety::Watched::kFeedback)] = true;
    safety_.emplace(safety::FailsafeConfig{}, fitted);
    graph_.add({.name = "safety"}, *safety_);
    graph_.add({.name = "drive"}, drive_);
    graph_.connect(drive_.status, safety_->drive, {.capacity = 64});
    graph_.connect(safety_->decisions, drive_.decisions, {.capacity = 64});
    graph_.connect(drive_.rearms, safety_->rearms, {.capacity = 8});
    safety_->use_lines({}, line, SourceId{1}, &line, {});
    moves_ = drive_.attach(drive::test::two_nodes(), wire_, SourceId{0}, &wire_, {}).has_value();
    commands.keep_answers = false;
    drive_.obey_commands(commands, SourceId{2}, &commands, {});
    bus.power_on();
    go(std::chrono::seconds(1));
    commands.arm(bus.now, decision().epoch);
    go(std::chrono::seconds(1));
    moves_ = moves_ && drives();
  }
  CoreRig(const CoreRig&) = delete;
  CoreRig& operator=(const CoreRig&) = delete;

  /// Strikes, waits, mends, and waits again; then asks to be re-armed where it has to.
  Measured run(const std::function<void(CoreRig&)>& strike, const std::function<void(CoreRig&)>& mend,
               Duration lasts = std::chrono::seconds(1)) {
    using std::chrono::seconds;
    struck_ = bus.now;
    strike(*this);
    go(lasts);
    Measured m{detected_, {}, worst_, moves_};
    mend(*this);
    const Time mended = bus.now;
    well_.reset();
    go(seconds(2));
    if (worst_ < safety::Mode::kStop) {
      if (well_) m.recover = *well_ - mended;
      return m;
    }
    // Latched: two seconds after the mending nothing has moved, whatever was commanded; a request brings it back.
    m.held = m.held && !well_ && left_speed() < 1e-9;
    for (int i = 0; i < 20 && decision().mode == safety::Mode::kStop; ++i) {
      commands.arm(bus.now, decision().epoch);
      go(std::chrono::milliseconds(200));
    }
    go(seconds(1));
    m.held = m.held && drives();
    return m;
  }

  /// From the strike to the first frame that disables a motor.
  [[nodiscard]] std::optional<Duration> stop_frame_after() const {
    if (!stop_frame_) return std::nullopt;
    return *stop_frame_ - struck_;
  }
  [[nodiscard]] const safety::FailsafeDecision& decision() const { return safety_->decision(); }
  [[nodiscard]] bool drives() const { return decision().mode == safety::Mode::kNormal && left_speed() > 0.4; }
  [[nodiscard]] app::DriveTask& drive_task() { return drive_; }
  /// Of both tasks.
  [[nodiscard]] std::uint64_t ticks() const { return 2 * index_; }

  [[nodiscard]] double left_speed() const { return std::abs(bus.nodes[0].speed()) * 0.16; }  ///< m/s at the rim
  /// Both tasks tick for so long.
  void go(Duration length) {
    for (const Time end = bus.now + length; bus.now < end; ++index_) {
      bus.advance(kTick);
      if (asks_to_drive && index_ % 10 == 0) commands.drive(bus.now, 0.5);
      tick(*safety_);
      tick(drive_);
      note(bus.now, decision().mode);
    }
  }

  drive::test::VirtualBus bus;
  support::EStopLine line;
  support::CommandQueue commands;
  std::function<void(const drive::CanFrame&)> sees{};  ///< gets what was sent, after each tick; may be empty
  bool asks_to_drive = true;                           ///< a client says 0.5 m/s, fifty times a second

 private:
  /// The bus as the tasks see it.
  class Wire final : public drive::CanLink {
    template <class Act>
    auto outside(Act act) {
      guard_.leave();
      auto result = act();
      guard_.enter();
      return result;
    }

   public:
    Wire(drive::test::VirtualBus& bus, const Guard& guard) : bus_(bus), guard_(guard) {}
    Result<Poll> next(Packet& packet, Duration timeout) override {
      return outside([&] { return bus_.next(packet, timeout); });
    }
    drive::SendResult send(const drive::CanFrame& frame) override {
      return outside([&] { return bus_.send(frame); });
    }
    Result<void> restart() override {
      return outside([&] { return bus_.restart(); });
    }

   private:
    drive::test::VirtualBus& bus_;
    const Guard& guard_;
  };

  void tick(scheduler::Task& task) {
    scheduler::TickRecord record;
    record.index = index_;
    scheduler::Tick tick(scheduler::Regime::kLive, bus.now, record);
    guard_.enter();
    task.tick(tick);
    guard_.leave();
  }
  void note(Time now, safety::Mode mode) {
    if (struck_ != Time{}) {
      worst_ = std::max(worst_, mode);
      if (mode != safety::Mode::kNormal && !detected_) detected_ = now - struck_;
      if (mode == safety::Mode::kNormal && !well_) well_ = now;
      if (mode != safety::Mode::kNormal) well_.reset();
      for (const drive::CanFrame& frame : bus.sent)
        if (frame.is(drive::canopen::kRpdo1 + 1) && !stop_frame_ &&
            (frame.data[0] & 0x0FU) != drive::cia402::kEnableOperation)
          stop_frame_ = now;
    }
    if (sees)
      for (const drive::CanFrame& frame : bus.sent) sees(frame);
    bus.sent.clear();
  }

  Guard guard_;
  Wire wire_{bus, guard_};
  std::optional<app::SafetyTask> safety_;
  app::DriveTask drive_;
  scheduler::TaskGraph graph_;  // joins the two
  std::uint64_t index_ = 0;
  bool moves_ = false;
  Time struck_{};
  std::optional<Time> well_, stop_frame_;
  std::optional<Duration> detected_;
  safety::Mode worst_ = safety::Mode::kNormal;
};

}  // namespace cairn::faults
