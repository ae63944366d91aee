// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string_view>

#include "onboard/scheduler/channel.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn::scheduler {

/// One end of a channel, and its slot in the records of its task. A port is a member of its task and takes the next
/// free slot when it is constructed: the order of declaration is the order of numbers in schedule.log. To keep old
/// recordings replayable, add new ports after all others.
class Port {
 public:
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  /// As `--print-tasks` shows it; a string literal.
  [[nodiscard]] std::string_view name() const { return name_; }
  [[nodiscard]] std::size_t slot() const { return slot_; }
  [[nodiscard]] const Task& task() const { return task_; }

 protected:
  Port(Task& task, std::string_view name) : task_(task), name_(name), slot_(task.take_slots()) {}
  ~Port() = default;

 private:
  const Task& task_;
  std::string_view name_;
  std::size_t slot_;
};

/// An input of any type, as the executive sees it.
class InputPortBase : public Port {
 public:
  /// Whether as much has been handed over as the task took in the tick of this record.
  [[nodiscard]] virtual bool holds(const TickRecord& record) const = 0;
  /// Null: not connected.
  [[nodiscard]] virtual const ChannelBase* channel() const = 0;

 protected:
  using Port::Port;
  ~InputPortBase() = default;
};

/// The consumer's end. Not connected, it is always empty.
template <class T>
class InputPort final : public InputPortBase {
 public:
  InputPort(Task& task, std::string_view name) : InputPortBase(task, name) {}
  /// Before the run; `channel` must outlive the port's use.
  void connect(Channel<T>& channel) { channel_ = &channel; }

  /// The next value of this tick, or null. It stays the task's until give_back() or the next call.
  [[nodiscard]] T* take(Tick& tick) {
    if (channel_ == nullptr) return nullptr;
    give_back(tick);
    if (tick.index() != taking_) {
      taking_ = tick.index();
      taken_ = 0;
    }
    Item* next = due(tick);
    if (next == nullptr) return nullptr;
    held_ = true;
    ++taken_;
    if (tick.regime() == Regime::kLive) tick.slot(slot()) = taken_;
    return &next->value;
  }
  /// At the end of a tick that does not take() until null.
  void give_back(Tick& tick) {
    if (!held_) return;
    channel_->queue_.pop();
    held_ = false;
    if (tick.gate() != nullptr) tick.gate()->open();
  }

  /// Values that wait, one that was taken and not given back included.
  [[nodiscard]] std::size_t size() const { return channel_ != nullptr ? channel_->queue_.size() : 0; }
  /// Without the reserve; 0: not connected.
  [[nodiscard]] std::size_t capacity() const { return channel_ != nullptr ? channel_->options().capacity : 0; }

  [[nodiscard]] bool holds(const TickRecord& record) const override {
    return size() >= static_cast<std::size_t>(std::max(0, record.slots[slot()]));
  }
  [[nodiscard]] const ChannelBase* channel() const override { return channel_; }

 private:
  using Item = typename Channel<T>::Item;

  Item* due(Tick& tick) {
    switch (tick.regime()) {
      case Regime::kLive:
      case Regime::kDrain:
        return channel_->queue_.front();
      case Regime::kLogged:
        return taken_ < tick.slot(slot()) ? awaited(tick) : nullptr;
      case Regime::kVirtual:
        break;
    }
    const Time visible = tick.release() - channel_->options().lag;
    // Even when something is there: what the producer still has to do up to then might find the channel full.
    if (tick.gate() != nullptr) tick.gate()->wait_until([&] { return channel_->producer_.reached(visible); });
    Item* next = channel_->queue_.front();
    return next != nullptr && next->produced <= visible ? next : nullptr;
  }
  Item* awaited(Tick& tick) {
    if (tick.gate() != nullptr)
      tick.gate()->wait_until(
          [&] { return channel_->queue_.front() != nullptr || channel_->producer_.reached(Time::max()); });
    return channel_->queue_.front();
  }

  Channel<T>* channel_ = nullptr;
  std::uint64_t taking_ = ~std::uint64_t{0};  // index of the tick that takes
  std::int32_t taken_ = 0;                    // in it
  bool held_ = false;
};

/// The producer's end. Not connected, it takes nothing: back() is null.
template <class T>
class OutputPort final : public Port {
 public:
  OutputPort(Task& task, std::string_view name) : Port(task, name) {}
  /// Before the run; `channel` must outlive the port's use.
  void connect(Channel<T>& channel) { channel_ = &channel; }
  [[nodiscard]] bool connected() const { return channel_ != nullptr; }

  /// The value to be filled, or null where it is dropped. Nothing is visible before push().
  [[nodiscard]] T* back(Tick& tick) {
    if (channel_ == nullptr) return nullptr;
    if (tick.index() != pushing_ || tick.regime() == Regime::kDrain) {
      pushing_ = tick.index();
      pushed_ = 0;
      dropping_ = false;
    }
    if (!dropping_ && refuses(tick)) {
      dropping_ = true;
      if (tick.regime() != Regime::kLogged) tick.slot(slot()) = pushed_ + 1;
    }
    if (dropping_) ++channel_->dropped_;
    return dropping_ ? nullptr : &channel_->queue_.back()->value;
  }
  void push(Tick& tick) {
    channel_->queue_.back()->produced = tick.release();
    channel_->queue_.push();
    ++pushed_;
    if (tick.gate() != nullptr) tick.gate()->open();
  }

 private:
  /// Whether the next value finds no place.
  bool refuses(Tick& tick) {
    const bool logged = tick.regime() == Regime::kLogged;
    const std::int32_t limit = logged ? tick.slot(slot()) : 0;
    if (limit > 0 && pushed_ >= limit - 1) return true;
    const auto& queue = channel_->queue_;
    const std::size_t room = logged ? queue.capacity() : channel_->options().capacity;
    // A replay waits until the consumer has had its chance, which is what a single thread would have given it.
    if (tick.gate() != nullptr && queue.size() >= room)
      tick.gate()->wait_until([&] { return queue.size() < room || consumer_had_its_chance(tick); });
    return queue.size() >= room;
  }
  [[nodiscard]] bool consumer_had_its_chance(const Tick& tick) const {
    if (tick.regime() == Regime::kLogged) return channel_->consumer_.reached(Time::max());
    const bool before_us = channel_->options().lag > Duration{};
    return channel_->consumer_.reached(before_us ? tick.release() : tick.release() - Duration{1});
  }

  Channel<T>* channel_ = nullptr;
  std::uint64_t pushing_ = ~std::uint64_t{0};  // index of the tick that pushes
  std::int32_t pushed_ = 0;                    // in it
  bool dropping_ = false;                      // the rest of it
};

}  // namespace cairn::scheduler
