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
  constexpr Mode S = Mode::kStop;
  const Act closed = [](CoreRig& r) { r.line.move(true, r.bus.now); };
  return {
      {"E1", "e-stop pressed",
       "the frame that disables is on the bus within two ticks of 2 ms; latched; no motion without a request", 4ms, 0ms,
       S, "", [closed] { return until_stop_frame([](CoreRig& r) { r.line.move(false, r.bus.now); }, closed); }},
      {"E2", "e-stop pressed and released within a tick (edges alone)", "likewise", 4ms, 0ms, S, "",
       [] {
         return until_stop_frame(
             [](CoreRig& r) {
               r.line.see_edge(false, r.bus.now, 1);
               r.line.see_edge(true, r.bus.now, 2);
             },
             [](CoreRig&) {});
       }},
      {"E3", "e-stop's GPIO chip unplugged", "as pressed", 4ms, 0ms, S, "",
       [] {
         return until_stop_frame([](CoreRig& r) { r.line.there = false; }, [](CoreRig& r) { r.line.there = true; });
       }},
      {"E4", "edges of the e-stop lost (a gap in their numbers)", "as pressed", 4ms, 0ms, S, "",
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
  constexpr Mode S = Mode::kStop;
  return {
      {"D8", "stale, duplicated, reordered feedback; random faults at random times",
       "no motion after a stop without arming", 0ms, 0ms, S, "drive/FaultSchedule.NoMotionAfterAStopWithoutArming"},
      {"D9", "the commanding process dies", "the motor controllers' own watchdog (100 ms) stops them", 0ms, 0ms, S,
       "drive/CanDrive.ADeadHostStopsTheNodes"},
      {"D10", "e-stop pressed, on a real kernel",
       "the next safety tick sees it, the drive tick after it sends the frame, or the one after that", 0ms, 0ms, S,
       "vm/EStopStopsDrive.ThroughTheRobotsOwnTasksWithinOneControlPeriod"},
  };
}

}  // namespace

std::vector<Row> drive_rows() {
  constexpr Mode H = Mode::kHold, S = Mode::kStop;
  const Act nothing = [](CoreRig&) {};
  std::vector<Row> rows{
      {"D1", "CAN bus-off", "stop within 50 ms of the error frame; restarted by us alone, moves after a request alone",
       50ms, 0ms, S, "",
       [nothing] { return drive([](CoreRig& r) { error_frame(r, drive::kErrorBusOff, 0); }, nothing); }},
      {"D2", "CAN error-passive", "stop within 50 ms of the error frame", 50ms, 0ms, S, "",
       [] {
         return drive([](CoreRig& r) { error_frame(r, drive::kErrorController, drive::kControllerPassive); },
                      [](CoreRig& r) { error_frame(r, drive::kErrorController, drive::kControllerActive); });
       }},
      {"D3", "motor controller starts anew", "stop; initialised again, enabled after a request alone", 50ms, 0ms, S, "",
       [nothing] {
         return drive(
             [](CoreRig& r) {
               auto& bus = r.bus;
               bus.deliver([&](auto& out) { bus.nodes[0].power_on(bus.now, out); });
             },
             nothing);
       }},
      {"D4", "motor controller reports a fault", "stop; reset by a request", 50ms, 0ms, S, "",
       [nothing] {
         return drive([](CoreRig& r) { r.bus.deliver([&](auto& out) { r.bus.nodes[0].fail(0x3210, out); }); }, nothing);
       }},
      {"D5", "feedback silent", "hold after 100 ms, stop after 250 ms", 110ms, 0ms, S, "",
       [] { return drive([](CoreRig& r) { mute(r, true); }, [](CoreRig& r) { mute(r, false); }); }},
      {"D6", "send queue full for 60 ms: nobody acknowledges",
       "never blocks; hold after three refusals, ends with its cause", 60ms, 1s, H, "",
       [] {
         return CoreRig().run([](CoreRig& r) { r.bus.full = true; }, [](CoreRig& r) { r.bus.full = false; }, 60ms);
       }},
      {"D11", "send queue full for 1 s", "hold, then stop: the motor controllers' own watchdogs end it", 60ms, 0ms, S,
       "", [] { return drive([](CoreRig& r) { r.bus.full = true; }, [](CoreRig& r) { r.bus.full = false; }); }},
      {"D7", "CAN interface down", "stop", 50ms, 0ms, S, "",
       [] { return drive([](CoreRig& r) { r.bus.down = true; }, [](CoreRig& r) { r.bus.down = false; }); }},
  };
  for (const auto& more : {rows_shown_elsewhere(), estop_rows()}) rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

}  // namespace cairn::faults
