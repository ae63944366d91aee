// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "hal/budget.hpp"
#include "hal/clock.hpp"
#include "hal/time.hpp"

namespace cairn::scheduler {

/// What answers the questions whose answers differ from run to run, such as: how many packets are there?
enum class Regime : std::uint8_t {
  kLive,     ///< the machine; the answers are logged
  kVirtual,  ///< virtual time, in which every tick happens at its release and takes none
  kLogged,   ///< the log of a live run
  kDrain,    ///< after the last tick: what is left is used, without bounds of time
};

/// What one tick was given and decided, in numbered slots whose meaning is the task's own. An idle tick leaves zero in
/// every slot.
struct TickRecord {
  static constexpr std::size_t kSlots = 20;
  std::uint64_t index = 0;    ///< of the release
  std::uint32_t skipped = 0;  ///< releases passed since the tick before
  std::array<std::int32_t, kSlots> slots{};

  [[nodiscard]] bool idle() const { return skipped == 0 && slots == std::array<std::int32_t, kSlots>{}; }
  friend bool operator==(const TickRecord&, const TickRecord&) = default;
};

/// Lets the threads of a replay wait for each other. Live runs and replays on one thread have no gate and never wait.
class Gate {
 public:
  void open() {
    turn_.fetch_add(1, std::memory_order_release);
    turn_.notify_all();
  }
  /// Returns when `met()` is true. It is asked at once, and again after every open().
  template <class Condition>
  void wait_until(Condition met) {
    for (;;) {
      const std::uint32_t turn = turn_.load(std::memory_order_acquire);
      if (met()) return;
      turn_.wait(turn, std::memory_order_acquire);
    }
  }

 private:
  std::atomic<std::uint32_t> turn_{0};
};

/// One release of one task. A task asks its tick, and nothing else, about the world. The answers come from the machine,
/// from virtual time or from a log, and the task cannot tell which.
class Tick {
 public:
  Tick(Regime regime, Time release, TickRecord& record, Gate* gate = nullptr, const Clock* clock = nullptr)
      : regime_(regime), release_(release), record_(record), gate_(gate), clock_(clock) {}

  [[nodiscard]] Regime regime() const { return regime_; }
  [[nodiscard]] std::uint64_t index() const { return record_.index; }
  /// The time, for everything that the task decides.
  [[nodiscard]] Time release() const { return release_; }
  /// Whether this tick happens in real time. Only then latencies mean something.
  [[nodiscard]] bool takes_time() const { return clock_ != nullptr && regime_ != Regime::kDrain; }
  /// The time, for figures only. release() when the tick takes no time.
  [[nodiscard]] Time figure_now() const { return clock_ != nullptr ? clock_->now() : release_; }

  /// A number: live `live()`, logged the number of then, otherwise `otherwise`.
  template <class Live>
  std::int32_t decide(std::size_t slot, Live live, std::int32_t otherwise) {
    if (regime_ == Regime::kLogged) return record_.slots[slot];
    return record_.slots[slot] = regime_ == Regime::kLive ? live() : otherwise;
  }
  /// The steps of an anytime stage: live until `deadline`, logged as many as then, otherwise `limit`. settle() follows.
  [[nodiscard]] Budget budget(std::size_t slot, Time deadline, int limit) const {
    if (regime_ == Regime::kLogged) return Budget::steps(record_.slots[slot]);
    return regime_ == Regime::kLive && clock_ != nullptr ? Budget::until(deadline, *clock_, limit)
                                                         : Budget::steps(limit);
  }
  /// Notes the steps that were taken of budget(). A slot serves one stage of the tick.
  void settle(std::size_t slot, const Budget& budget) {
    if (regime_ != Regime::kLogged) record_.slots[slot] = budget.spent();
  }

  /// For ports and feeds: the slot as this regime writes or reads it.
  [[nodiscard]] std::int32_t& slot(std::size_t i) { return record_.slots[i]; }
  [[nodiscard]] Gate* gate() const { return gate_; }

  /// An input task says that nothing will follow. The run ends soon after the last input task has said so.
  void end_of_input() { ended_ = true; }
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  Regime regime_;
  Time release_;
  TickRecord& record_;
  Gate* gate_;
  const Clock* clock_;
  bool ended_ = false;
};

/// What runs at a fixed rate. One thread calls it.
class Task {
 public:
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;
  virtual ~Task() = default;
  /// One release. Whatever is not the task's own state is asked of `tick`, its inputs and outputs.
  virtual void tick(Tick& tick) = 0;
  /// After the last tick: hands on what is still held back.
  virtual void finish(Tick& /*tick*/) {}

  /// The first of the next `count` free slots in the records of this task. Every member that keeps a number in the
  /// schedule log takes its slot when it is constructed, so slots follow the order of declaration. Aborts when a task
  /// needs more than TickRecord::kSlots.
  [[nodiscard]] std::size_t take_slots(std::size_t count = 1) {
    const std::size_t first = slots_;
    slots_ += count;
    if (slots_ > TickRecord::kSlots) std::abort();
    return first;
  }

 protected:
  Task() = default;

 private:
  std::size_t slots_ = 0;  // taken
};

}  // namespace cairn::scheduler
