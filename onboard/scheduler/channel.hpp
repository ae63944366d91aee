// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "hal/relaxed_counter.hpp"
#include "hal/spsc_queue.hpp"
#include "onboard/scheduler/progress.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn::scheduler {

/// What the executive must know of a channel to run a log on one thread.
class ChannelBase {
 public:
  virtual ~ChannelBase() = default;
  /// Whether as much has been handed over as the consumer's next tick took then.
  [[nodiscard]] virtual bool holds(const TickRecord& consumer) const = 0;

  struct Fill {
    std::size_t waiting = 0, capacity = 0;
    std::uint64_t dropped = 0;
  };
  /// For figures: a moment's view, for any thread.
  [[nodiscard]] virtual Fill fill() const = 0;

 protected:
  ChannelBase() = default;
  ChannelBase(const ChannelBase&) = default;
  ChannelBase& operator=(const ChannelBase&) = default;
};

/// Hands values from one task to another, in order, each once. Wait-free when live. What the consumer gets in a tick is
/// - live: what is there, and how many is logged;
/// - logged: as many as then;
/// - virtual: what was released up to `lag` before this tick (logical execution time, as in Giotto: Henzinger 2003).
/// A full channel drops the newest, and the rest of that tick, so that the log can say so in one number.
template <class T>
class Channel final : public ChannelBase {
 public:
  struct Ends {
    std::size_t capacity = 8;
    /// Places beyond the capacity, for the replay of a log: on one thread, a tick that ran late in the live run comes
    /// in the order of its release, perhaps before the one that made room for it.
    std::size_t reserve = 0;
    std::size_t producer_slot = 0, consumer_slot = 0;  ///< in the records of the two tasks
    Duration lag{};  ///< more than zero where the consumer comes before the producer in the order of tasks
  };
  /// Both progresses must outlive the channel.
  Channel(const Ends& ends, const Progress& producer, const Progress& consumer)
      : ends_(ends), producer_(producer), consumer_(consumer), queue_(ends.capacity + ends.reserve) {}

  /// Producer: the value to be filled, or null where it is dropped. Nothing is visible before push().
  [[nodiscard]] T* back(Tick& tick) {
    if (tick.index() != pushing_ || tick.regime() == Regime::kDrain) {
      pushing_ = tick.index();
      pushed_ = 0;
      dropping_ = false;
    }
    if (!dropping_ && refuses(tick)) {
      dropping_ = true;
      if (tick.regime() != Regime::kLogged) tick.slot(ends_.producer_slot) = pushed_ + 1;
    }
    if (dropping_) ++dropped_;
    return dropping_ ? nullptr : &queue_.back()->value;
  }
  void push(Tick& tick) {
    queue_.back()->produced = tick.release();
    queue_.push();
    ++pushed_;
    if (tick.gate() != nullptr) tick.gate()->open();
  }

  /// Consumer: the next value of this tick, or null. It stays the consumer's until give_back() or the next call.
  [[nodiscard]] T* take(Tick& tick) {
    give_back(tick);
    if (tick.index() != taking_) {
      taking_ = tick.index();
      taken_ = 0;
    }
    Item* next = due(tick);
    if (next == nullptr) return nullptr;
    held_ = true;
    ++taken_;
    if (tick.regime() == Regime::kLive) tick.slot(ends_.consumer_slot) = taken_;
    return &next->value;
  }

  /// Consumer: at the end of a tick that does not take() until null.
  void give_back(Tick& tick) {
    if (!held_) return;
    queue_.pop();
    held_ = false;
    if (tick.gate() != nullptr) tick.gate()->open();
  }

  [[nodiscard]] bool holds(const TickRecord& consumer) const override {
    const auto wanted = static_cast<std::size_t>(std::max(0, consumer.slots[ends_.consumer_slot]));
    return queue_.size() >= wanted;
  }
  [[nodiscard]] Fill fill() const override { return {queue_.size(), queue_.capacity(), dropped_}; }
  [[nodiscard]] std::size_t size() const { return queue_.size(); }
  [[nodiscard]] std::size_t capacity() const { return ends_.capacity; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  struct Item {
    Time produced{};
    T value{};
  };

  /// Whether the next value finds no place.
  bool refuses(Tick& tick) {
    const bool logged = tick.regime() == Regime::kLogged;
    const std::int32_t limit = logged ? tick.slot(ends_.producer_slot) : 0;
    if (limit > 0 && pushed_ >= limit - 1) return true;
    const std::size_t room = logged ? queue_.capacity() : ends_.capacity;
    // A replay waits until the consumer has had its chance, which is what a single thread would have given it.
    if (tick.gate() != nullptr && queue_.size() >= room)
      tick.gate()->wait_until([&] { return queue_.size() < room || had_its_chance(tick); });
    return queue_.size() >= room;
  }
  bool had_its_chance(const Tick& tick) const {
    if (tick.regime() == Regime::kLogged) return consumer_.reached(Time::max());
    return consumer_.reached(ends_.lag > Duration{} ? tick.release() : tick.release() - Duration{1});
  }

  Item* due(Tick& tick) {
    switch (tick.regime()) {
      case Regime::kLive:
      case Regime::kDrain:
        return queue_.front();
      case Regime::kLogged:
        return taken_ < tick.slot(ends_.consumer_slot) ? awaited(tick) : nullptr;
      case Regime::kVirtual:
        break;
    }
    const Time visible = tick.release() - ends_.lag;
    // Even when something is there: what the producer still has to do up to then might find the channel full.
    if (tick.gate() != nullptr) tick.gate()->wait_until([&] { return producer_.reached(visible); });
    Item* next = queue_.front();
    return next != nullptr && next->produced <= visible ? next : nullptr;
  }
  Item* awaited(Tick& tick) {
    if (tick.gate() != nullptr)
      tick.gate()->wait_until([&] { return queue_.front() != nullptr || producer_.reached(Time::max()); });
    return queue_.front();
  }

  Ends ends_;
  const Progress& producer_;
  const Progress& consumer_;
  SpscQueue<Item> queue_;
  // The producer's.
  std::uint64_t pushing_ = ~std::uint64_t{0};
  std::int32_t pushed_ = 0;
  bool dropping_ = false;
  RelaxedCounter dropped_;
  // The consumer's.
  std::uint64_t taking_ = ~std::uint64_t{0};
  std::int32_t taken_ = 0;
  bool held_ = false;
};

}  // namespace cairn::scheduler
