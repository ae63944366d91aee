// SPDX-License-Identifier: Apache-2.0
// A driven run is its replay: the safety and the drive task get the packets and the schedule of then, and nothing else.
#include <gtest/gtest.h>

#include <deque>

#include "onboard/app/tasks/drive_task.hpp"
#include "onboard/app/tasks/safety_task.hpp"
#include "onboard/scheduler/task_graph.hpp"
#include "tests/drivers/drive/virtual_bus.hpp"
#include "tests/support/command_queue.hpp"
#include "tests/support/estop_line.hpp"

namespace cairn::app {
namespace {

using namespace std::chrono_literals;
using scheduler::Regime;
using scheduler::TickRecord;

constexpr Duration kPeriod = 2ms;

/// What came in, once more.
class RecordedPackets final : public Source {
 public:
  Result<Poll> next(Packet& packet, Duration /*timeout*/) override {
    if (packets.empty()) return Poll::kEnd;
    packet = packets.front();
    packets.pop_front();
    return Poll::kPacket;
  }
  std::deque<Packet> packets;
};

/// The state after a tick that a replay must have again.
struct After {
  safety::Mode mode{};
  DriveLevel level{};
  DriveCause cause{};
  std::uint32_t epoch = 0;
  std::uint64_t frames_sent = 0;
  double v = 0;
  friend bool operator==(const After&, const After&) = default;
};

/// Both tasks, joined as in a robot.
class Loop {
 public:
  Loop(Source& bus, drive::CanLink* link, Source& line, gpio::GpioLines* lines, Source& commands,
       clients::AnswerPort* answers, std::array<scheduler::Feed::Tap, 3> taps = {}) {
    safety::Fitted fitted;
    fitted.drive = fitted.estop = fitted.watched[static_cast<std::size_t>(safety::Watched::kFeedback)] = true;
    safety_.emplace(safety::FailsafeConfig{}, fitted);
    graph_.add({.name = "safety"}, *safety_);
    graph_.add({.name = "drive"}, drive_);
    graph_.connect(drive_.status, safety_->drive, {.capacity = 64, .lag = Duration{1}});
    graph_.connect(drive_.rearms, safety_->rearms, {.capacity = 8, .lag = Duration{1}});
    graph_.connect(safety_->decisions, drive_.decisions, {.capacity = 64});
    safety_->use_lines({}, line, SourceId{1}, lines, taps[1]);
    EXPECT_TRUE(drive_.attach(drive::test::two_nodes(), bus, SourceId{0}, link, taps[0]));
    drive_.obey_commands(commands, SourceId{2}, answers, taps[2]);
  }
  After tick(Regime regime, Time now, TickRecord& safety_record, TickRecord& drive_record) {
    scheduler::Tick safety_tick(regime, now, safety_record), drive_tick(regime, now, drive_record);
    safety_->tick(safety_tick);
    drive_.tick(drive_tick);
    const DriveStatus status = drive_.drive()->status();
    return {safety_->decision().mode,
            status.level,
            status.cause,
            status.epoch,
            drive_.drive()->counters().sent,
            drive_.state() ? drive_.state()->v : 0};
  }
  [[nodiscard]] std::uint32_t epoch() const { return safety_->decision().epoch; }

 private:
  std::optional<SafetyTask> safety_;
  DriveTask drive_;
  scheduler::TaskGraph graph_;
};

/// A live run in which a client arms, drives, is stopped by another one and by the e-stop, and arms again.
class DrivenReplay : public ::testing::Test {
 protected:
  void live() {
    bus_.power_on();
    run(1s);
    commands_.join(1, bus_.now);
    for (const auto* stopper : {"nobody", "client", "e-stop"}) {
      commands_.arm(bus_.now, loop_.epoch());
      run(1s);
      drive(500ms);
      if (std::string(stopper) == "client")
        commands_.say(2, bus_.now, {.verb = clients::Command::Verb::kStop, .who = {}});
      if (std::string(stopper) == "e-stop") line_.move(false, bus_.now);
      drive(500ms);
      if (!line_.closed) line_.move(true, bus_.now);
      run(1s);
    }
  }
  void drive(Duration length) {
    for (const Time end = bus_.now + length; bus_.now < end; run(20ms)) commands_.drive(bus_.now, 0.4, 0.1);
  }
  void run(Duration length) {
    for (const Time end = bus_.now + length; bus_.now < end;) {
      bus_.advance(kPeriod);
      TickRecord safety, drive;
      safety.index = drive.index = safety_log_.size();
      after_.push_back(loop_.tick(Regime::kLive, bus_.now, safety, drive));
      safety_log_.push_back(safety);
      drive_log_.push_back(drive);
    }
  }
  scheduler::Feed::Tap keep(std::deque<Packet>& packets) {
    return [&packets](const Packet& packet) { packets.push_back(packet); };
  }

  drive::test::VirtualBus bus_;
  support::EStopLine line_;
  support::CommandQueue commands_;
  RecordedPackets frames_, edges_, commanded_;
  Loop loop_{bus_,
             &bus_,
             line_,
             &line_,
             commands_,
             &commands_,
             {keep(frames_.packets), keep(edges_.packets), keep(commanded_.packets)}};
  std::vector<TickRecord> safety_log_, drive_log_;
  std::vector<After> after_;
};

TEST_F(DrivenReplay, IsTheLiveRunTickForTick) {
  const Time start = bus_.now;
  live();
  double fastest = 0;
  for (const After& a : after_) fastest = std::max(fastest, a.v);
  ASSERT_GT(fastest, 0.3);
  ASSERT_FALSE(commanded_.packets.empty());

  Loop again(frames_, nullptr, edges_, nullptr, commanded_, nullptr);
  Time now = start;
  for (std::size_t i = 0; i < after_.size(); ++i) {
    now += kPeriod;
    ASSERT_EQ(again.tick(Regime::kLogged, now, safety_log_[i], drive_log_[i]), after_[i]) << "tick " << i;
  }
}

}  // namespace
}  // namespace cairn::app
