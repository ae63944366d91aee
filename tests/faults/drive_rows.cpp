// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/campaign.hpp"
#include "tests/faults/core_rig.hpp"

namespace cairn::faults {
namespace {

using namespace std::chrono_literals;
using Act = std::function<void(CoreRig&)>;

Measured drive(
    const Act& strike, const Act& mend = [](CoreRig&) {}) {
  return CoreRig().run(strike, mend);
}

/// The time until the frame that disables the motors, in place of the time until the core knows.
Measured until_stop_frame(const Act& strike, const Act& mend) {
  CoreRig rig;
  Measured m = rig.run(strike, mend);
  m.detect = rig.stop_frame_after();
  return m;
}

void error_frame(CoreRig& rig, std::uint32_t classes, std::uint8_t detail) {
  rig.bus.inject(drive::make_frame(drive::kErrorFrame | classes, {0, detail, 0, 0, 0, 0, 0, 0}));
}
void mute(CoreRig& rig, bool silent) {
  for (auto& node : rig.bus.nodes) node.mute(silent);
}

std::vector<Row> estop_rows() {
  constexpr safety::Mode S = safety::Mode::kStop;
  const Act closed = [](CoreRig& r) { r.line.move(true, r.bus.now); };
  return {
      {"E1", "e-stop pressed",
       "The frame that disables the motors is on the bus within two ticks of 2 ms. The stop is latched.", 4ms, 0ms, S,
       "", [closed] { return until_stop_frame([](CoreRig& r) { r.line.move(false, r.bus.now); }, closed); }},
      {"E2", "e-stop pressed and released within one tick", "As for E1, because edges are read too.", 4ms, 0ms, S, "",
       [] {
         return until_stop_frame(
             [](CoreRig& r) {
               r.line.see_edge(false, r.bus.now, 1);
               r.line.see_edge(true, r.bus.now, 2);
             },
             [](CoreRig&) {});
       }},
      {"E3", "GPIO chip of the e-stop unplugged", "As for a pressed e-stop.", 4ms, 0ms, S, "",
       [] {
         return until_stop_frame([](CoreRig& r) { r.line.there = false; }, [](CoreRig& r) { r.line.there = true; });
       }},
      {"E4", "edges of the e-stop lost: a gap in their numbers", "As for a pressed e-stop.", 4ms, 0ms, S, "",
       [] {
         return until_stop_frame(
             [](CoreRig& r) {
               r.line.see_edge(true, r.bus.now, 1);
               r.line.see_edge(true, r.bus.now, 7);
             },
             [](CoreRig&) {});
       }},
  };
}

std::vector<Row> rows_shown_elsewhere() {
  constexpr safety::Mode S = safety::Mode::kStop;
  return {
      {"D8", "old, repeated or reordered feedback, and random faults at random times",
       "No motion after a stop until the drive is armed again.", 0ms, 0ms, S,
       "drive/FaultSchedule.NoMotionAfterAStopWithoutArming"},
      {"D9", "the core dies", "The watchdogs of the motor controllers stop the motors after 100 ms.", 0ms, 0ms, S,
       "drive/CanDrive.ADeadHostStopsTheNodes"},
      {"D10", "e-stop pressed, on a real kernel",
       "The next safety tick sees it. The stop frame is sent by one of the next two drive ticks.", 0ms, 0ms, S,
       "vm/EStopStopsDrive.ThroughTheRobotsOwnTasksWithinOneControlPeriod"},
      {"D12", "the wheels' scale in the profile is wrong by more than 15 %",
       "The wheels are not believed along corridors and over gaps. An event and a note say so, with the right scale.",
       0ms, 0ms, safety::Mode::kNormal, "odometry/WheelAidTest.WheelsWithAScaleFarOffAreNotBelieved"},
  };
}

}  // namespace

std::vector<Row> drive_rows() {
  constexpr safety::Mode H = safety::Mode::kHold, S = safety::Mode::kStop;
  const Act nothing = [](CoreRig&) {};
  std::vector<Row> rows{
      {"D1", "CAN bus-off",
       "Stop within 50 ms of the error frame. Cairn restarts the bus. The robot moves only after a request.", 50ms, 0ms,
       S, "", [nothing] { return drive([](CoreRig& r) { error_frame(r, drive::kErrorBusOff, 0); }, nothing); }},
      {"D2", "CAN error-passive", "Stop within 50 ms of the error frame.", 50ms, 0ms, S, "",
       [] {
         return drive([](CoreRig& r) { error_frame(r, drive::kErrorController, drive::kControllerPassive); },
                      [](CoreRig& r) { error_frame(r, drive::kErrorController, drive::kControllerActive); });
       }},
      {"D3", "motor controller restarts", "Stop. The controller is set up again. It is enabled only after a request.",
       50ms, 0ms, S, "",
       [nothing] {
         return drive(
             [](CoreRig& r) {
               auto& bus = r.bus;
               bus.deliver([&](auto& out) { bus.nodes[0].power_on(bus.now, out); });
             },
             nothing);
       }},
      {"D4", "motor controller reports a fault", "Stop. A request resets the fault.", 50ms, 0ms, S, "",
       [nothing] {
         return drive([](CoreRig& r) { r.bus.deliver([&](auto& out) { r.bus.nodes[0].fail(0x3210, out); }); }, nothing);
       }},
      {"D5", "no wheel feedback", "Hold after 100 ms. Stop after 250 ms.", 110ms, 0ms, S, "",
       [] { return drive([](CoreRig& r) { mute(r, true); }, [](CoreRig& r) { mute(r, false); }); }},
      {"D6", "send queue full for 60 ms: no node acknowledges",
       "Sending never blocks. Hold after three refused frames. The hold ends with its cause.", 60ms, 1s, H, "",
       [] {
         return CoreRig().run([](CoreRig& r) { r.bus.full = true; }, [](CoreRig& r) { r.bus.full = false; }, 60ms);
       }},
      {"D11", "send queue full for 1 s", "Hold, then stop: the watchdogs of the motor controllers run out.", 60ms, 0ms,
       S, "", [] { return drive([](CoreRig& r) { r.bus.full = true; }, [](CoreRig& r) { r.bus.full = false; }); }},
      {"D7", "CAN interface down", "Stop within 50 ms.", 50ms, 0ms, S, "",
       [] { return drive([](CoreRig& r) { r.bus.down = true; }, [](CoreRig& r) { r.bus.down = false; }); }},
  };
  for (const auto& more : {rows_shown_elsewhere(), estop_rows()}) rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

}  // namespace cairn::faults
