// SPDX-License-Identifier: Apache-2.0
// The e-stop's wire through the kernel and the robot's own safety and drive tasks to the motors: a simulated GPIO chip
// (CAIRN_TEST_GPIOCHIP, CAIRN_TEST_GPIOSIM), a CAN interface (CAIRN_TEST_CAN) and simulated CiA 402 controllers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "tests/vm/estop_rig.hpp"

namespace cairn::vm {
namespace {

using namespace std::chrono_literals;
using scheduler::ScheduledTask;

constexpr int kPresses = 16;

/// An operator: presses while the robot drives, releases, waits whether it moves by itself, and asks for it again.
class Operator {
 public:
  explicit Operator(EStopRig& rig) : rig_(rig) {}

  /// A look every 20 ms; true when all is done or nothing happens any more.
  bool look() {
    const Time now = rig_.clock.now();
    for (; const auto* change = rig_.safety->changes().front(); rig_.safety->changes().pop())
      mode_ = change->mode, cause_ = change->cause, epoch_ = change->epoch;
    if (now > changed_ + 20s) return true;
    rig_.drive(0.5);
    const std::uint64_t speed = rig_.far_end->speed_mrad_s;
    const bool driving = speed > 3000, standing = speed < 10;  // 0.5 m/s: 3.1 rad/s
    switch (doing_) {
      case kAsking:
        if (driving && mode_ == safety::Mode::kNormal) return press(), false;
        if (mode_ == safety::Mode::kStop && now > asked_ + 200ms) rig_.arm(epoch_), asked_ = now;
        break;
      case kPressing:
        if (standing && mode_ == safety::Mode::kStop) release(now);
        break;
      case kReleased:
        moved_by_itself = moved_by_itself || !standing;
        if (now > changed_ + 1s) next(now);
        break;
      case kDone:
        break;
    }
    return doing_ == kDone;
  }

  int presses = 0, causes_right = 0;
  bool moved_by_itself = false;
  [[nodiscard]] bool done() const { return doing_ == kDone; }

 private:
  void press() {
    // At another place of the period each time.
    LiveClock::wait_until(rig_.clock.now() + presses * 270us);
    rig_.pull(false);
    ++presses;
    become(kPressing);
  }
  void release(Time) {
    causes_right += cause_ == safety::Fault::kEStopOpen ? 1 : 0;
    rig_.pull(true);
    become(kReleased);
  }
  void next(Time) { become(presses == kPresses ? kDone : kAsking); }

  enum Doing { kAsking, kPressing, kReleased, kDone };
  void become(Doing doing) {
    doing_ = doing;
    changed_ = rig_.clock.now();
  }

  EStopRig& rig_;
  Doing doing_ = kAsking;
  Time changed_ = rig_.clock.now(), asked_{};
  safety::Mode mode_ = safety::Mode::kStop;
  std::optional<safety::Fault> cause_;
  std::uint32_t epoch_ = 0;
};

/// Which releases of a task were served, and in which any of the slots says that there was news.
struct History {
  History(const FarEnd& far_end, const ScheduledTask& task, std::initializer_list<std::size_t> slots)
      : releases(task.releases) {
    for (const auto& done : far_end.ticks) {
      if (done.task != &task) continue;
      for (std::uint64_t k = done.record.index - done.record.skipped; k < done.record.index; ++k) passed.push_back(k);
      const auto news = [&](std::size_t slot) { return done.record.slots[slot] > 0; };
      if (std::any_of(slots.begin(), slots.end(), news)) took.push_back(done.record.index);
    }
  }
  /// The first tick from `from` on that took something; the number of ticks served from there up to it.
  [[nodiscard]] std::pair<std::uint64_t, int> first_taking(std::uint64_t from) const {
    const auto it = std::lower_bound(took.begin(), took.end(), from);
    if (it == took.end()) return {from, 0};
    const auto skipped = std::count_if(passed.begin(), passed.end(), [&](auto k) { return k >= from && k < *it; });
    return {*it, static_cast<int>(*it - from + 1) - static_cast<int>(skipped)};
  }
  scheduler::Releases releases;
  std::vector<std::uint64_t> passed, took;
};

/// One press, from the wire to the bus.
struct Reaction {
  int safety_ticks = 0, drive_ticks = 0;  ///< served until the edge, then the decision, was taken
  int orders_to_move = 0;                 ///< on the bus after the edge
  Duration measured = Duration::max();    ///< from the kernel's stamp of the edge to that of the stop frame
};

Reaction reaction(const EStopRig& rig, Time pressed, const History& safety, const History& drive) {
  Reaction r;
  // A tick that was released before the edge but had not looked yet may see it, too.
  std::uint64_t from = safety.releases.not_before(pressed);
  if (const auto before = safety.first_taking(from == 0 ? 0 : from - 1); before.first + 1 == from) --from;
  const auto [seen, safety_ticks] = safety.first_taking(from);
  r.safety_ticks = safety_ticks;
  r.drive_ticks = drive.first_taking(drive.releases.not_before(safety.releases.at(seen))).second;
  for (const FarEnd::Order& order : rig.far_end->orders) {
    if (order.on_bus < pressed) continue;
    if (!order.motion) {
      r.measured = order.on_bus - pressed;
      break;
    }
    ++r.orders_to_move;
  }
  return r;
}

std::string microseconds(Duration d) { return std::to_string(d / 1us); }

TEST(EStopStopsDrive, ThroughTheRobotsOwnTasksWithinOneControlPeriod) {
  const char* can = std::getenv("CAIRN_TEST_CAN");
  const char* chip = std::getenv("CAIRN_TEST_GPIOCHIP");
  const char* world = std::getenv("CAIRN_TEST_GPIOSIM");
  if (can == nullptr || chip == nullptr || world == nullptr)
    GTEST_SKIP() << "no CAN interface or no GPIO chip is named";
  EStopRig rig(can, chip, world);
  Operator someone(rig);
  rig.run([&] { return someone.look(); });
  ASSERT_TRUE(someone.done()) << "after " << someone.presses << " presses nothing happened any more";
  EXPECT_EQ(someone.causes_right, kPresses);
  EXPECT_FALSE(someone.moved_by_itself) << "the contact was closed again, and nobody had asked";

  const History safety(*rig.far_end, rig.safety_schedule(), {rig.safety->edges_slot, rig.safety->level_slot});
  const History drive(*rig.far_end, rig.drive_schedule(), {rig.drive().decisions.slot()});
  std::vector<Duration> times;
  std::map<int, int> ticks;
  for (const EStopRig::Edge& edge : rig.edges) {
    if (edge.closed) continue;
    const Reaction r = reaction(rig, edge.at, safety, drive);
    EXPECT_EQ(r.safety_ticks, 1) << "the first tick after the edge sees it";
    EXPECT_GE(r.drive_ticks, 1);
    EXPECT_LE(r.drive_ticks, 2) << "this tick's drive task, or the next where the decision came while it ran";
    EXPECT_LE(r.orders_to_move, 2) << "as many as the drive had ticks before it heard of it";
    ASSERT_LT(r.measured, Duration::max()) << "the stop frame was on the bus";
    ++ticks[r.drive_ticks];
    times.push_back(r.measured);
  }
  ASSERT_EQ(times.size(), static_cast<std::size_t>(kPresses));
  std::sort(times.begin(), times.end());
  std::printf(
      "vm: e-stop, %d presses: seen by the next safety tick; frame in the first drive tick after it %d times,"
      " in the second %d times; edge to frame p50 %s us, max %s us; period %s us; slips %llu + %llu\n",
      kPresses, ticks[1], ticks[2], microseconds(times[times.size() / 2]).c_str(), microseconds(times.back()).c_str(),
      microseconds(rig.safety_schedule().releases.period).c_str(),
      static_cast<unsigned long long>(rig.safety_schedule().stats.slips.get()),
      static_cast<unsigned long long>(rig.drive_schedule().stats.slips.get()));
}

}  // namespace
}  // namespace cairn::vm
