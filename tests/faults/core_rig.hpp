// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "drivers/drive/canopen.hpp"
#include "drivers/drive/cia402.hpp"
#include "drivers/gpio/estop.hpp"
#include "onboard/scheduler/failsafe.hpp"
#include "tests/drivers/drive/virtual_bus.hpp"
#include "tests/faults/campaign.hpp"

namespace cairn::faults {

/// A driving robot: simulated motor controllers on a CAN bus, the real drive, the real e-stop and the real failsafe,
/// all ticked every 5 ms of virtual time, as the safety task does it.
class CoreRig {
 public:
  static constexpr Duration kTick = std::chrono::milliseconds(5);

  CoreRig() {
    robot.every_tick = [this] { tick(); };
    robot.bus.power_on();
    robot.run(std::chrono::seconds(1));
    request();
    robot.run(std::chrono::seconds(1));
    moves_ = decision().mode == Mode::kNormal && robot.left_speed() > 0.4;
  }

  /// Strikes, waits, mends, and waits again; then asks to be re-armed where it has to.
  Measured run(const std::function<void(CoreRig&)>& strike, const std::function<void(CoreRig&)>& mend,
               Duration lasts = std::chrono::seconds(1)) {
    using std::chrono::seconds;
    robot.bus.sent.clear();
    struck_ = robot.bus.now;
    strike(*this);
    robot.run(lasts);
    Measured m{detected_, {}, worst_, moves_};
    mend(*this);
    const Time mended = robot.bus.now;
    well_.reset();
    robot.run(seconds(2));
    if (worst_ < Mode::kStop) {
      if (well_) m.recover = *well_ - mended;
      return m;
    }
    // Latched: two seconds after the mending nothing has moved, whatever was commanded; a request brings it back.
    m.held = m.held && !well_ && std::abs(robot.left_speed()) < 1e-9;
    for (int i = 0; i < 20 && decision().mode == Mode::kStop; ++i) {
      request();
      robot.run(std::chrono::milliseconds(200));
    }
    robot.run(seconds(1));
    m.held = m.held && decision().mode == Mode::kNormal && robot.left_speed() > 0.4;
    return m;
  }

  /// Ticks from the strike to the first frame that disables a motor.
  [[nodiscard]] std::optional<Duration> stop_frame_after() const {
    if (!stop_frame_) return std::nullopt;
    return *stop_frame_ - struck_;
  }
  [[nodiscard]] const FailsafeDecision& decision() const { return failsafe_.decision(); }

  drive::test::Robot robot;
  bool contact_closed = true, chip_there = true;
  gpio::EStop estop{gpio::Config{}};

 private:
  static Fitted fitted() {
    Fitted f;
    f.drive = f.estop = f.watched[static_cast<std::size_t>(Watched::kFeedback)] = true;
    return f;
  }
  void request() { request_ = decision().epoch; }

  void tick() {
    const Time now = robot.bus.now;
    if (chip_there)
      estop.level(now, contact_closed);
    else
      estop.lost(now);
    Drive& motors = *robot.drive;
    if (estop.stopped(now)) motors.stop(DriveCause::kEmergencyStop, now);
    FailsafeInputs in;
    in.now = now;
    in.drive = motors.status();
    in.estop = {estop.released(now), !chip_there, estop.stopped(now)};
    if (robot.newest && robot.newest->stamp != seen_.last) seen_ = {robot.newest->stamp, seen_.count + 1};
    in.seen[static_cast<std::size_t>(Watched::kFeedback)] = seen_;
    in.rearm = std::exchange(request_, std::nullopt);
    const FailsafeDecision& d = failsafe_.step(in);
    if (d.mode == Mode::kStop && !d.arm && motors.status().level != DriveLevel::kStop && !arming_)
      motors.stop(DriveCause::kRequested, now);
    arming_ = d.arm;
    if (d.arm && estop.rearm(now)) robot.arm();
    const DriveCommand allowed = limited({0.5, 0, robot.epoch}, d);
    robot.go(allowed.v, allowed.w);
    note(now, d.mode);
  }
  void note(Time now, Mode mode) {
    if (struck_ == Time{}) return;
    worst_ = std::max(worst_, mode);
    if (mode != Mode::kNormal && !detected_) detected_ = now - struck_;
    if (mode == Mode::kNormal && !well_) well_ = now;
    if (mode != Mode::kNormal) well_.reset();
    for (const drive::CanFrame& frame : robot.bus.sent)
      if (frame.is(drive::canopen::kRpdo1 + 1) && !stop_frame_ &&
          (frame.data[0] & 0x0FU) != drive::cia402::kEnableOperation)
        stop_frame_ = now;
    robot.bus.sent.clear();
  }

  Failsafe failsafe_{FailsafeConfig{}, fitted()};
  Seen seen_;
  std::optional<std::uint32_t> request_;
  bool arming_ = false, moves_ = false;
  Time struck_{};
  std::optional<Time> well_, stop_frame_;
  std::optional<Duration> detected_;
  Mode worst_ = Mode::kNormal;
};

}  // namespace cairn::faults
