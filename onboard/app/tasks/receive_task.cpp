// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/receive_task.hpp"

#include <algorithm>

#include "drivers/clients/messages/picture.hpp"
#include "drivers/recording/formats/right_eye.hpp"
#include "onboard/app/door/fitted.hpp"

namespace cairn::app {

using scheduler::Tick;

namespace {

constexpr std::size_t kPulses = 64;  // a fast trigger's, of the time that a picture takes
// From the pulse to the picture: exposure, readout and transfer.
constexpr Duration kLongestExposure = std::chrono::milliseconds(500);

}  // namespace

ReceiveTask::ReceiveTask(Monitor& monitor) : monitor_(monitor), decode_stage_(monitor.stage("decode")) {}

bool ReceiveTask::add(Input& input, SourceId id, scheduler::Feed::Tap tap) {
  if (sensors_.size() == kMaxInputs) return false;
  const auto complain = [this](Time now, const Error& error) { monitor_.event(now, "input", to_string(error)); };
  const std::size_t slot = packets_slot + sensors_.size();
  const bool right = input.entry.id == recording::kRightEye;  // is recorded, and nobody looks at it
  sensors_.push_back({.feed = {*input.source, id, slot, complain, std::move(tap)},
                      .decoder = input.scans.get(),
                      .watched = right ? std::nullopt : watched_as(input.entry.kind),
                      .pictures = right ? PicturePorts{} : ports_of(input.entry.kind),
                      .kind = input.entry.kind});
  const auto triggered = std::ranges::find(triggered_, input.entry.kind, &Triggered::kind);
  if (triggered != triggered_.end() && !right) sensors_.back().triggered = triggered->latency;
  return true;
}

bool ReceiveTask::show(recording::SensorKind kind, PictureOutlet& outlet) {
  const auto camera = std::ranges::find_if(
      sensors_, [&](const Sensor& sensor) { return sensor.kind == kind && sensor.pictures[0] != nullptr; });
  if (camera == sensors_.end()) return false;
  camera->shown.push_back(&outlet);
  return true;
}

/// Who does not keep up gets fewer pictures.
void ReceiveTask::show(const Packet& picture, PictureOutlet& outlet) {
  if (!outlet.wanted.load(std::memory_order_relaxed) || picture.bytes.size() > clients::PicturePart::kMaxBytes) return;
  if (Packet* place = outlet.pictures.back()) {
    *place = picture;
    outlet.pictures.push();
  }
}

void ReceiveTask::tick(Tick& tick) {
  read_lines(tick);
  bool ended = true;
  for (Sensor& sensor : sensors_) {
    while (const Packet* packet = sensor.feed.take(tick)) receive(*packet, sensor, tick);
    if (sensor.decoder != nullptr && tick.regime() != scheduler::Regime::kDrain)
      hand_on(sensor.decoder->expire(tick.release()), tick, false);
    ended = ended && sensor.feed.ended();
  }
  judge(tick.release());
  publish(tick);
  if (ended) tick.end_of_input();
}

void ReceiveTask::finish(Tick& tick) {
  for (Sensor& sensor : sensors_)
    if (sensor.decoder != nullptr) hand_on(sensor.decoder->flush(), tick, true);
}

void ReceiveTask::receive(const Packet& packet, Sensor& sensor, Tick& tick) {
  if (!figures_.start) figures_.start = packet.arrival;
  figures_.end = std::max(figures_.end, packet.arrival);
  if (sensor.decoder == nullptr) return take_undecoded(packet, sensor, tick);
  if (sensor.stuck.step(packet.channel, packet.payload())) {
    ++sensor.refused;
    monitor_.event(packet.arrival, "lidar", "stuck: the same packet again and again");
    return;
  }
  decode(packet, sensor, tick);
}

void ReceiveTask::read_lines(Tick& tick) {
  while (const LineEdge* edge = lines.take(tick)) {
    if (edge->line == gpio::Line::kTrigger) {
      pulses_.push_back(edge->at);
      if (pulses_.size() > kPulses) pulses_.pop_front();
      continue;
    }
    if (!seconds_.pulse(edge->at) || seconds_.state(edge->at) != gpio::PpsMonitor::State::kLocked) continue;
    for (Sensor& sensor : sensors_)
      if (sensor.decoder != nullptr) sensor.decoder->note_second(edge->at);
  }
}

/// The pulse nearest to when the picture was taken, by what is known of its delay. None: the trigger has been quiet for
/// longer than a picture takes.
std::optional<Time> ReceiveTask::pulse_of(Time arrival, Duration latency) const {
  std::optional<Time> best;
  const auto off = [&](Time pulse) { return std::chrono::abs(pulse - (arrival - latency)); };
  for (const Time pulse : pulses_)
    if (pulse <= arrival && arrival - pulse < kLongestExposure && (!best || off(pulse) < off(*best))) best = pulse;
  return best;
}

/// Pictures are handed on even if they repeat: whoever looks at them judges them.
void ReceiveTask::take_undecoded(const Packet& packet, Sensor& sensor, Tick& tick) {
  const bool is_camera = sensor.pictures[0] != nullptr;
  if (is_camera && sensor.stuck.step(packet.channel, sensor.sample.of(packet.payload())))
    monitor_.event(packet.arrival, "camera", "stuck: the same picture again and again");
  else if (sensor.watched)
    note(*sensor.watched, packet.arrival);
  const auto pulse = sensor.triggered ? pulse_of(packet.arrival, *sensor.triggered) : std::nullopt;
  if (pulse) {
    exposed_ = packet;
    exposed_.arrival = *pulse + *sensor.triggered;
  } else if (sensor.triggered) {
    monitor_.event(packet.arrival, "camera",
                   "a picture without a pulse of the trigger: it has the time of its arrival");
  }
  const Packet& picture = pulse ? exposed_ : packet;
  for (PictureOutlet* outlet : sensor.shown) show(picture, *outlet);
  for (auto* port : sensor.pictures)
    if (port != nullptr) hand_on(picture, *port, tick);
}

void ReceiveTask::decode(const Packet& packet, Sensor& sensor, Tick& tick) {
  const auto scan = [&] {
    const StageTimer timing(decode_stage_);
    return sensor.decoder->decode(packet);
  }();
  ++(scan ? sensor.accepted : sensor.refused);
  if (const auto fix = sensor.decoder->take_fix()) hand_on(*fix, tick);
  if (!scan)
    monitor_.event(packet.arrival, "decode", scan.error().cause);
  else
    hand_on(*scan, tick, false);
}

void ReceiveTask::judge(Time now) {
  safety::FaultSet faults;
  for (Sensor& sensor : sensors_) {
    if (sensor.decoder == nullptr) continue;
    if (sensor.stuck.stuck()) faults.set(safety::Fault::kLidarStuck);
    if (sensor.rejection.step(now, sensor.accepted, sensor.refused)) faults.set(safety::Fault::kLidarRejected);
  }
  unpublished_ = unpublished_ || faults != seen_.faults;
  seen_.faults = faults;
}

void ReceiveTask::hand_on(const Scan* scan, Tick& tick, bool at_the_end) {
  if (scan == nullptr) return;
  ++figures_.scans;
  figures_.lost_packets += scan->lost_packets;
  if (!scan->partial) note(safety::Watched::kLidar, figures_.end);
  // Where the data begins and ends, the first and the last revolution are cut. The sensor is not at fault.
  if (scan->incomplete && figures_.scans > 1 && !at_the_end)
    monitor_.event(scan->valid.end, "lidar", "incomplete scan: packets were lost or late, or the motor stood");
  // A map that begins with a part of a turn leaves directions open, and every later pose would refer to it.
  if (scan->incomplete && figures_.scans == 1 && !at_the_end) return;
  ArrivedScan* out = scans.back(tick);
  if (out == nullptr) {
    monitor_.event(scan->valid.end, "receive", "a scan was dropped: odometry is behind");
    return;
  }
  out->scan = *scan;
  out->arrival = figures_.end;
  scans.push(tick);
}

void ReceiveTask::hand_on(const GeoFix& fix, Tick& tick) {
  GeoFix* out = fixes.back(tick);
  if (out == nullptr) return;  // the next one comes in a second
  *out = fix;
  fixes.push(tick);
}

/// Perception takes the newest. Where it is behind, what finds no place would only be older when its turn comes.
void ReceiveTask::hand_on(const Packet& picture, scheduler::OutputPort<ArrivedPicture>& to, Tick& tick) {
  ArrivedPicture* out = to.back(tick);
  if (out == nullptr) return;
  out->packet = picture;
  to.push(tick);
}

ReceiveTask::PicturePorts ReceiveTask::ports_of(recording::SensorKind kind) {
  if (kind == recording::kCamera) return {&pictures, &watched, &eyes, &mounted};
  if (kind == recording::kThermal) return {&thermals, &mounted_thermals};
  if (kind == recording::kDepth) return {&depths};
  return {};
}

void ReceiveTask::note(safety::Watched what, Time when) {
  safety::Seen& last = seen_.seen[static_cast<std::size_t>(what)];
  last = {when, last.count + 1};
  unpublished_ = true;
}

void ReceiveTask::publish(Tick& tick) {
  if (!unpublished_ || tick.regime() == scheduler::Regime::kDrain) return;
  SensorsSeen* out = seen.back(tick);
  if (out == nullptr) return;  // with the next tick
  *out = seen_;
  seen.push(tick);
  unpublished_ = false;
}

Time ReceiveTask::first_arrival() {
  Time first = Time::max();
  for (Sensor& sensor : sensors_) first = std::min(first, sensor.feed.first_arrival());
  return first;
}

std::uint64_t ReceiveTask::missing_packets() const {
  std::uint64_t missing = 0;
  for (const Sensor& sensor : sensors_) missing += sensor.feed.missing();
  return missing;
}

}  // namespace cairn::app
