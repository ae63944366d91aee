// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>

#include "drivers/recording/recording_writer.hpp"
#include "hal/monitor.hpp"
#include "hal/spsc_queue.hpp"
#include "onboard/scheduler/feed.hpp"

namespace cairn::app {

/// Writes what a live run receives. No task waits for it: tasks put copies of their packets into queues, and the
/// housekeeping task writes these to the disk. A packet that finds its queue full is lost to the recording and counted.
class Recorder {
 public:
  /// `monitor` must outlive the recorder.
  Recorder(recording::RecordingWriter writer, Monitor& monitor) : writer_(std::move(writer)), monitor_(monitor) {}

  /// A queue of its own for one task, for `packets` packets. Packets of up to `bytes` are kept without an allocation.
  /// The recorder must outlive the tap.
  [[nodiscard]] scheduler::Feed::Tap tap(std::size_t packets, std::size_t bytes);

  /// On the housekeeping thread. An error of the disk ends the recording and nothing else.
  void write_waiting(Time now);
  /// After the last tick of all tasks: writes what waits and ends the files.
  void close(Time now);
  /// Packets that found their queue full.
  [[nodiscard]] std::uint64_t lost() const;
  /// Any thread: an error of the disk has ended the recording.
  [[nodiscard]] bool failed() const { return failures_ > 0; }

 private:
  struct Queue {
    Queue(std::size_t capacity, std::size_t bytes);
    SpscQueue<Packet> packets;
    RelaxedCounter lost;
  };
  void fail(Time now, const Error& error);

  recording::RecordingWriter writer_;
  Monitor& monitor_;
  std::deque<Queue> queues_;
  RelaxedCounter failures_;
};

}  // namespace cairn::app
