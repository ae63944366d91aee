// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/recorder.hpp"

namespace cairn::app {

Recorder::Queue::Queue(std::size_t capacity, std::size_t bytes) : packets(capacity) {
  for (std::size_t place = 0; place <= capacity; ++place) {  // one more than it holds
    packets.back()->bytes.reserve(bytes);
    packets.push();
    packets.pop();
  }
}

scheduler::Feed::Tap Recorder::tap(std::size_t packets, std::size_t bytes) {
  Queue& queue = queues_.emplace_back(packets, bytes);
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
  ++failures_;
  monitor_.event(now, "recording", "ended: " + to_string(error));
}

void Recorder::write_waiting(Time now) {
  for (Queue& queue : queues_)
    for (; const Packet* packet = queue.packets.front(); queue.packets.pop()) {
      if (failed()) continue;
      if (const auto written = writer_.write(*packet); !written) fail(now, written.error());
    }
  if (failed()) return;
  if (const auto flushed = writer_.flush(); !flushed) fail(now, flushed.error());
}

void Recorder::close(Time now) {
  write_waiting(now);
  if (lost() > 0)
    monitor_.event(now, "recording",
                   "packets were lost to the recording: the disk was too slow. It cannot be replayed "
                   "to the bit");
  if (const auto closed = writer_.close(); !closed && !failed()) fail(now, closed.error());
}

std::uint64_t Recorder::lost() const {
  std::uint64_t lost = 0;
  for (const Queue& queue : queues_) lost += queue.lost;
  return lost;
}

}  // namespace cairn::app
