// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "tests/drivers/velodyne/lidar_rig.hpp"
#include "tests/faults/campaign.hpp"
#include "tests/faults/lidar_rig.hpp"

namespace cairn::faults {
namespace {

using namespace std::chrono_literals;
using recording::Spell;

/// One spell that fills the time of the fault.
recording::Faults spell(Spell kind, Duration lasts) {
  recording::Faults faults;
  faults.spell = kind;
  faults.freeze = lasts;
  faults.period = TaskRig::kBegin + lasts;
  return faults;
}

Measured silent(Spell kind, Duration lasts, std::optional<Fault> fault = {}) {
  return LidarRig(spell(kind, lasts), lasts).run(fault);
}

/// The packets held back come, and are used: none is missing, unlike after a silence.
Measured burst() {
  LidarRig rig(spell(Spell::kBurst, 400ms), 400ms);
  Measured m = rig.run();
  m.held = m.held && rig.counters().lost_packets == 0;
  for (std::size_t i = 1; i < rig.scans().size(); ++i)
    m.held = m.held && rig.scans()[i].valid.end > rig.scans()[i - 1].valid.end;
  return m;
}

/// Beside a LiDAR: pictures at `rate_hz` that stay out for a second. The scans are those of a run without the fault.
Measured pictures_missing(recording::SensorKind kind, double rate_hz, Fault fault) {
  const auto camera = [rate_hz](Time start) {
    return [=, n = 0](Packet& packet) mutable {
      packet.bytes.assign(16, static_cast<std::byte>(n));
      packet.arrival = start + n++ * from_seconds(1 / rate_hz);
    };
  };
  LidarRig clean({}, 1s), dirty({}, 1s);
  const Time begin = dirty.start() + TaskRig::kBegin;
  dirty.tasks().add(kind,
                    std::make_unique<SickSource>(camera(dirty.start()), begin, begin + 1s, spell(Spell::kSilence, 1s)));
  clean.run();
  Measured m = dirty.run(fault);
  m.held = m.held && std::equal(clean.scans().begin(), clean.scans().end(), dirty.scans().begin(), dirty.scans().end(),
                                velodyne::test::same);
  return m;
}

Measured shares(const std::function<void(recording::Faults&)>& set) {
  recording::Faults faults;
  set(faults);
  return LidarRig(faults, 2s).run();
}

/// Scans of a disturbed and of an undisturbed sensor.
Measured same_scans(const std::function<void(recording::Faults&)>& set) {
  recording::Faults faults;
  set(faults);
  LidarRig clean({}, 2s), dirty(faults, 2s);
  clean.run();
  Measured m = dirty.run();
  m.held = m.held && std::equal(clean.scans().begin(), clean.scans().end(), dirty.scans().begin(), dirty.scans().end(),
                                velodyne::test::same);
  return m;
}

Measured device_time_jump(Duration by) {
  LidarRig rig({}, 1s);
  // The packets still come when they come: the device's clock alone jumps.
  rig.strike = [by](velodyne::test::Sensor& sensor) {
    sensor.device_ns += by.count();
    sensor.start -= by;
  };
  Measured m = rig.run();
  m.held = m.held && rig.counters().time_jumps == 1;
  for (std::size_t i = 1; i < rig.scans().size(); ++i)
    m.held = m.held && rig.scans()[i].valid.end > rig.scans()[i - 1].valid.end;
  return m;
}

Measured damaged_never_decodes_to_nonsense() {
  recording::Faults faults;
  faults.flip = 0.05;
  LidarRig rig(faults, 2s);
  Measured m = rig.run();
  for (const Scan& scan : rig.scans())
    for (const auto& p : scan.cloud.xyz) m.held = m.held && p.allFinite() && p.norm() <= 131.0F;
  return m;
}

}  // namespace

std::vector<Row> sensor_rows() {
  constexpr Mode N = Mode::kNormal, D = Mode::kDegraded, H = Mode::kHold;
  return {
      {"L1", "LiDAR silent for 0.3 s", "degraded 150 ms after the last scan, normal with the second scan", 260ms, 310ms,
       D, "", [] { return silent(Spell::kSilence, 300ms); }},
      {"L2", "LiDAR silent for 2 s", "hold 500 ms after the last scan, normal with the second scan", 260ms, 310ms, H,
       "", [] { return silent(Spell::kSilence, 2s); }},
      {"L3", "LiDAR unplugged and back (link down for 3 s)", "as silent; nothing blocks", 260ms, 310ms, H, "",
       [] { return silent(Spell::kDisconnect, 3s); }},
      {"L4", "LiDAR stuck: the same packet again and again",
       "hold with the third; well again when fewer than half of a second's were refused", 50ms, 1200ms, H, "",
       [] { return silent(Spell::kStuck, 2s, Fault::kLidarStuck); }},
      {"L5", "garbage: 90 % of the packets are cut off", "refused whole; more than half in a second: as silent", 700ms,
       1200ms, H, "", [] { return shares([](auto& f) { f.cut = 0.9; }); }},
      {"L6", "garbage: a bit flipped in 5 % of the packets", "no NaN, no infinity, nothing beyond the range", 0ms, 0ms,
       N, "", damaged_never_decodes_to_nonsense},
      {"L7", "duplicates: every packet twice", "the scans are those of the undisturbed run, bit for bit", 0ms, 0ms, N,
       "", [] { return same_scans([](auto& f) { f.repeat = 1; }); }},
      {"L8", "reordered: a tenth of the packets after their successor", "refused, counted; the robot goes on", 0ms, 0ms,
       N, "", [] { return shares([](auto& f) { f.swap = 0.1; }); }},
      {"L9", "oversize datagrams: 10 % with bytes added", "refused whole; the robot goes on", 0ms, 0ms, N, "",
       [] { return shares([](auto& f) { f.extend = 0.1; }); }},
      {"L10", "a third of the packets is lost", "counted; incomplete scans are still scans", 0ms, 0ms, N, "",
       [] { return shares([](auto& f) { f.drop = 0.33; }); }},
      {"L11", "a fifth of the packets 50 ms late", "refused as overtaken, counted; the robot goes on", 0ms, 0ms, N, "",
       [] { return shares([](auto& f) { f.delay = 0.2; }); }},
      {"L12", "a burst: nothing for 0.4 s, then all at once",
       "degraded, normal with the second scan; no scan goes back", 260ms, 310ms, D, "", burst},
      {"L13", "device time jumps by 30 min (PPS lost)", "one event, no scan goes back in time, no mode", 0ms, 0ms, N,
       "", [] { return device_time_jump(30min); }},
      {"L14", "device time jumps back by 17 min", "likewise", 0ms, 0ms, N, "", [] { return device_time_jump(-17min); }},
      {"L15", "camera of 15 Hz silent for 1 s", "known after three pictures; geometry goes on, bit for bit", 240ms,
       100ms, N, "", [] { return pictures_missing(recording::kCamera, 15, Fault::kCameraSilent); }},
      {"L16", "thermal camera of 9 Hz silent for 1 s", "likewise", 380ms, 150ms, N, "",
       [] { return pictures_missing(recording::kThermal, 9, Fault::kThermalSilent); }},
      {"L17", "depth camera of 15 Hz silent for 1 s", "likewise", 240ms, 100ms, N, "",
       [] { return pictures_missing(recording::kDepth, 15, Fault::kDepthSilent); }},
  };
}

}  // namespace cairn::faults
