// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/relaxed_counter.hpp"
#include "hal/spsc_queue.hpp"
#include "onboard/scheduler/progress.hpp"

namespace cairn::scheduler {

template <class T>
class InputPort;
template <class T>
class OutputPort;

/// How much a channel holds, and when a message may be read.
struct ChannelOptions {
  std::size_t capacity = 8;  ///< values that may wait
  /// Places beyond the capacity, for the replay of a log. On one thread, a tick that ran late in the live run comes in
  /// the order of its release, perhaps before the tick that made room for it.
  std::size_t reserve = 0;
  Duration lag{};  ///< above zero where the consumer comes before the producer in the order of tasks
};

/// What figures and printing need of any channel.
class ChannelBase {
 public:
  explicit ChannelBase(const ChannelOptions& options) : options_(options) {}
  ChannelBase(const ChannelBase&) = delete;
  ChannelBase& operator=(const ChannelBase&) = delete;
  virtual ~ChannelBase() = default;

  /// How full the queue is, and how many values were dropped.
  struct Fill {
    std::size_t waiting = 0, capacity = 0;
    std::uint64_t dropped = 0;
  };
  /// For figures: a moment's view, for any thread.
  [[nodiscard]] virtual Fill fill() const = 0;
  [[nodiscard]] const ChannelOptions& options() const { return options_; }

 private:
  ChannelOptions options_;
};

/// Hands values from one task to another, in order, each once. Wait-free when live. The producer writes through an
/// OutputPort and the consumer reads through an InputPort. What the consumer gets in a tick is
/// - live: what is there, and how many is logged;
/// - logged: as many as then;
/// - virtual: what was released up to `lag` before this tick (logical execution time, as in Giotto: Henzinger 2003).
/// A full channel drops the newest, and the rest of that tick, so that the log can say so in one number.
template <class T>
class Channel final : public ChannelBase {
 public:
  /// Both progresses must outlive the channel.
  Channel(const ChannelOptions& options, const Progress& producer, const Progress& consumer)
      : ChannelBase(options), producer_(producer), consumer_(consumer), queue_(options.capacity + options.reserve) {}

  [[nodiscard]] Fill fill() const override { return {queue_.size(), queue_.capacity(), dropped_}; }

 private:
  friend class InputPort<T>;
  friend class OutputPort<T>;
  struct Item {
    Time produced{};
    T value{};
  };

  const Progress& producer_;
  const Progress& consumer_;
  SpscQueue<Item> queue_;
  RelaxedCounter dropped_;
};

}  // namespace cairn::scheduler
