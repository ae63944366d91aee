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

Measured silent(Spell kind, Duration lasts, std::optional<safety::Fault> fault = {}) {
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

/// Beside a LiDAR: pictures at `rate_hz` that stay out, or are the same, for a second. The scans are those of a run
/// without the fault.
Measured pictures_missing(recording::SensorKind kind, double rate_hz, safety::Fault fault,
                          Spell how = Spell::kSilence) {
  const auto camera = [rate_hz](Time start) {
    return [=, n = 0](Packet& packet) mutable {
      packet.bytes.assign(16, static_cast<std::byte>(n));
      packet.arrival = start + n++ * from_seconds(1 / rate_hz);
    };
  };
  LidarRig clean({}, 1s), dirty({}, 1s);
  const Time begin = dirty.start() + TaskRig::kBegin;
  // A stuck camera repeats the picture before.
  const Duration before = how == Spell::kStuck ? from_seconds(1 / rate_hz) + 1ms : Duration{};
  dirty.tasks().add(kind,
                    std::make_unique<SickSource>(camera(dirty.start()), begin - before, begin + 1s, spell(how, 1s)));
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

std::vector<Row> lidar_rows() {
  constexpr safety::Mode N = safety::Mode::kNormal, D = safety::Mode::kDegraded, H = safety::Mode::kHold;
  return {
      {"L1", "LiDAR silent for 0.3 s", "Degraded 150 ms after the last scan. Normal with the second new scan.", 260ms,
       310ms, D, "", [] { return silent(Spell::kSilence, 300ms); }},
      {"L2", "LiDAR silent for 2 s", "Hold 500 ms after the last scan. Normal with the second new scan.", 260ms, 310ms,
       H, "", [] { return silent(Spell::kSilence, 2s); }},
      {"L3", "LiDAR unplugged for 3 s", "As for a silent LiDAR (L2). No task blocks.", 260ms, 310ms, H, "",
       [] { return silent(Spell::kDisconnect, 3s); }},
      {"L4", "LiDAR stuck: it repeats the same packet",
       "Hold with the third equal packet. Normal when less than half of a second's packets are refused.", 50ms, 1200ms,
       H, "", [] { return silent(Spell::kStuck, 2s, safety::Fault::kLidarStuck); }},
      {"L5", "90 % of the packets are cut short",
       "Damaged packets are refused whole. Hold when more than half of a second's packets are refused.", 700ms, 1200ms,
       H, "", [] { return shares([](auto& f) { f.cut = 0.9; }); }},
      {"L6", "one bit is flipped in 5 % of the packets", "Points are finite and within the sensor's range.", 0ms, 0ms,
       N, "", damaged_never_decodes_to_nonsense},
      {"L7", "every packet comes twice", "The scans equal those of a run without the fault, to the bit.", 0ms, 0ms, N,
       "", [] { return same_scans([](auto& f) { f.repeat = 1; }); }},
      {"L8", "10 % of the packets come after the next one", "Late packets are refused and counted. The robot goes on.",
       0ms, 0ms, N, "", [] { return shares([](auto& f) { f.swap = 0.1; }); }},
      {"L9", "10 % of the packets have bytes added", "Such packets are refused whole. The robot goes on.", 0ms, 0ms, N,
       "", [] { return shares([](auto& f) { f.extend = 0.1; }); }},
      {"L10", "a third of the packets is lost", "Lost packets are counted. Incomplete scans are still used.", 0ms, 0ms,
       N, "", [] { return shares([](auto& f) { f.drop = 0.33; }); }},
      {"L11", "20 % of the packets are 50 ms late", "Late packets are refused and counted. The robot goes on.", 0ms,
       0ms, N, "", [] { return shares([](auto& f) { f.delay = 0.2; }); }},
      {"L12", "no packets for 0.4 s, then all at once",
       "Degraded, then normal with the second new scan. Scans stay in the order of time.", 260ms, 310ms, D, "", burst},
      {"L13", "device time jumps by 30 min (PPS lost)",
       "One event. Scans stay in the order of time. The mode does not change.", 0ms, 0ms, N, "",
       [] { return device_time_jump(30min); }},
      {"L14", "device time jumps back by 17 min", "As for L13.", 0ms, 0ms, N, "",
       [] { return device_time_jump(-17min); }},
  };
}

std::vector<Row> camera_rows() {
  constexpr safety::Mode N = safety::Mode::kNormal;
  return {
      {"L15", "camera of 15 Hz silent for 1 s",
       "The fault is raised after three periods without a picture. Scans equal those of a run without the fault, to "
       "the bit.",
       240ms, 100ms, N, "", [] { return pictures_missing(recording::kCamera, 15, safety::Fault::kCameraSilent); }},
      {"L16", "thermal camera of 9 Hz silent for 1 s", "As for L15.", 380ms, 150ms, N, "",
       [] { return pictures_missing(recording::kThermal, 9, safety::Fault::kThermalSilent); }},
      {"L17", "depth camera of 15 Hz silent for 1 s", "As for L15.", 240ms, 100ms, N, "",
       [] { return pictures_missing(recording::kDepth, 15, safety::Fault::kDepthSilent); }},
      {"L24", "camera of 15 Hz frozen for 1 s: the same picture again and again",
       "It counts as silent from its third equal picture on. Scans equal those of a run without the fault, to the bit.",
       450ms, 100ms, N, "",
       [] { return pictures_missing(recording::kCamera, 15, safety::Fault::kCameraSilent, Spell::kStuck); }},
      {"L25", "thermal camera of 9 Hz frozen for 1 s", "As for L24.", 700ms, 150ms, N, "",
       [] { return pictures_missing(recording::kThermal, 9, safety::Fault::kThermalSilent, Spell::kStuck); }},
  };
}

}  // namespace

std::vector<Row> sensor_rows() {
  std::vector<Row> rows = lidar_rows();
  const std::vector<Row> cameras = camera_rows();
  rows.insert(rows.end(), cameras.begin(), cameras.end());
  return rows;
}

}  // namespace cairn::faults
