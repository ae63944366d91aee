// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/receive_task.hpp"

#include <algorithm>

namespace cairn {

using scheduler::Tick;

namespace {

std::optional<Watched> watched_as(std::string_view kind) {
  if (kind == recording::kCamera) return Watched::kCamera;
  if (kind == recording::kThermal) return Watched::kThermal;
  if (kind == recording::kDepth) return Watched::kDepth;
  return std::nullopt;
}

}  // namespace

ReceiveTask::ReceiveTask(ScanChannel& scans, SeenChannel& seen, Monitor& monitor)
    : scans_(scans), seen_channel_(seen), monitor_(monitor), decode_stage_(monitor.stage("decode")) {}

bool ReceiveTask::add(Input& input, SourceId id, scheduler::Feed::Tap tap) {
  if (ways_.size() == kMaxInputs) return false;
  const auto complain = [this](Time now, const Error& error) { monitor_.event(now, "input", to_string(error)); };
  ways_.push_back(
      {{*input.source, id, ways_.size(), complain, std::move(tap)}, input.scans.get(), watched_as(input.entry.kind)});
  return true;
}

void ReceiveTask::tick(Tick& tick) {
  bool ended = true;
  for (Way& way : ways_) {
    while (const Packet* packet = way.feed.take(tick)) receive(*packet, way, tick);
    if (way.decoder != nullptr && tick.regime() != scheduler::Regime::kDrain)
      hand_on(way.decoder->expire(tick.release()), tick, false);
    ended = ended && way.feed.ended();
  }
  judge(tick.release());
  tell(tick);
  if (ended) tick.end_of_input();
}

void ReceiveTask::finish(Tick& tick) {
  for (Way& way : ways_)
    if (way.decoder != nullptr) hand_on(way.decoder->flush(), tick, true);
}

void ReceiveTask::receive(const Packet& packet, Way& way, Tick& tick) {
  if (!figures_.start) figures_.start = packet.arrival;
  figures_.end = std::max(figures_.end, packet.arrival);
  if (way.decoder == nullptr) {
    if (way.watched) note(*way.watched, packet.arrival);
    return;
  }
  if (way.stuck.step(packet.channel, packet.payload())) {
    ++way.refused;
    monitor_.event(packet.arrival, "lidar", "stuck: the same packet again and again");
    return;
  }
  decode(packet, way, tick);
}

void ReceiveTask::decode(const Packet& packet, Way& way, Tick& tick) {
  const auto scan = [&] {
    const StageTimer timing(decode_stage_);
    return way.decoder->decode(packet);
  }();
  ++(scan ? way.accepted : way.refused);
  if (!scan)
    monitor_.event(packet.arrival, "decode", scan.error().cause);
  else
    hand_on(*scan, tick, false);
}

void ReceiveTask::judge(Time now) {
  FaultSet faults;
  for (Way& way : ways_) {
    if (way.decoder == nullptr) continue;
    if (way.stuck.stuck()) faults.set(Fault::kLidarStuck);
    if (way.rejection.step(now, way.accepted, way.refused)) faults.set(Fault::kLidarRejected);
  }
  news_ = news_ || faults != seen_.faults;
  seen_.faults = faults;
}

void ReceiveTask::hand_on(const Scan* scan, Tick& tick, bool at_the_end) {
  if (scan == nullptr) return;
  ++figures_.scans;
  figures_.lost_packets += scan->lost_packets;
  if (!scan->partial) note(Watched::kLidar, figures_.end);
  // The first and the last revolution are cut by where the data begins and ends: nothing is wrong with the sensor.
  if (scan->incomplete && figures_.scans > 1 && !at_the_end)
    monitor_.event(scan->valid.end, "lidar", "incomplete scan: packets were lost or late, or the motor stood");
  // A map that begins with a part of a turn leaves directions open, and every later pose would refer to it.
  if (scan->incomplete && figures_.scans == 1 && !at_the_end) return;
  ArrivedScan* out = scans_.back(tick);
  if (out == nullptr) {
    monitor_.event(scan->valid.end, "receive", "a scan was dropped: odometry is behind");
    return;
  }
  out->scan = *scan;
  out->arrival = figures_.end;
  scans_.push(tick);
}

void ReceiveTask::note(Watched what, Time when) {
  Seen& seen = seen_.seen[static_cast<std::size_t>(what)];
  seen = {when, seen.count + 1};
  news_ = true;
}

void ReceiveTask::tell(Tick& tick) {
  if (!news_ || tick.regime() == scheduler::Regime::kDrain) return;
  SensorsSeen* out = seen_channel_.back(tick);
  if (out == nullptr) return;  // with the next tick
  *out = seen_;
  seen_channel_.push(tick);
  news_ = false;
}

Time ReceiveTask::first_arrival() {
  Time first = Time::max();
  for (Way& way : ways_) first = std::min(first, way.feed.first_arrival());
  return first;
}

std::uint64_t ReceiveTask::missing_packets() const {
  std::uint64_t missing = 0;
  for (const Way& way : ways_) missing += way.feed.missing();
  return missing;
}

}  // namespace cairn
