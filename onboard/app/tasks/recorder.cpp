// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/recorder.hpp"

namespace cairn {

scheduler::Feed::Tap Recorder::tap(std::size_t packets) {
  Queue& queue = queues_.emplace_back(packets);
  return [&queue](const Packet& packet) {
    Packet* place = queue.packets.back();
    if (place == nullptr) {
      ++queue.lost;
      return;
    }
    *place = packet;
    queue.packets.push();
  };
}

void Recorder::fail(Time now, const Error& error) {
  failed_ = true;
  monitor_.event(now, "recording", "ended: " + to_string(error));
}

void Recorder::write_waiting(Time now) {
  for (Queue& queue : queues_)
    for (; const Packet* packet = queue.packets.front(); queue.packets.pop()) {
      if (failed_) continue;
      if (const auto written = writer_.write(*packet); !written) fail(now, written.error());
    }
  if (failed_) return;
  if (const auto flushed = writer_.flush(); !flushed) fail(now, flushed.error());
}

void Recorder::close(Time now) {
  write_waiting(now);
  if (lost() > 0)
    monitor_.event(now, "recording",
                   "packets were lost to the recording: the disk was too slow. It cannot be replayed "
                   "to the bit");
  if (const auto closed = writer_.close(); !closed && !failed_) fail(now, closed.error());
}

std::uint64_t Recorder::lost() const {
  std::uint64_t lost = 0;
  for (const Queue& queue : queues_) lost += queue.lost;
  return lost;
}

}  // namespace cairn
