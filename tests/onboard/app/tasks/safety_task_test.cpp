// SPDX-License-Identifier: Apache-2.0
// The safety task by itself: what it makes of its line, of the news and of the operator, tick by tick.
#include "onboard/app/tasks/safety_task.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "onboard/app/runs/allocations.hpp"
#include "tests/onboard/app/tasks/safety_neighbours.hpp"
#include "tests/support/estop_line.hpp"

namespace cairn::app {
namespace {

using namespace std::chrono_literals;
using scheduler::Regime;
using scheduler::Tick;
using scheduler::TickRecord;

using support::EStopLine;

/// A robot with an e-stop and a drive whose motors do what they are told, under the safety task at 500 Hz.
class SafetyTaskTest : public testing::Test {
 protected:
  static constexpr Duration kPeriod = 2ms;

  SafetyTaskTest() {
    fitted_.drive = fitted_.estop = true;
    make(&line_);
  }
  void make(EStopLine* line) {
    task_.emplace(safety::FailsafeConfig{}, fitted_);
    neighbours_.connect(*task_);
    task_->use_lines({}, line_, SourceId{0}, line, {});
  }

  void tick(Regime regime, TickRecord& record) {
    Tick tick(regime, now_, record);
    const std::uint64_t before = allocations_of_this_thread();
    task_->tick(tick);
    allocated_ += allocations_of_this_thread() - before;
  }
  /// Live, for so long; every tick is kept for a replay.
  void run(Duration length) {
    for (const Time end = now_ + length; now_ < end; now_ += kPeriod) {
      TickRecord record;
      record.index = log_.size();
      tick(Regime::kLive, record);
      log_.push_back(record);
      decisions_made_.push_back(task_->decision());
      serve_motors(record.index);
    }
  }
  /// The motors are told by decisions and tell of themselves a tick later.
  void serve_motors(std::uint64_t index) {
    TickRecord record;
    record.index = index;
    Tick drive_tick(Regime::kLive, now_, record);
    bool armed = false, stopped = false;
    while (const safety::FailsafeDecision* decision = neighbours_.decisions.take(drive_tick)) {
      armed = armed || decision->arm;
      stopped = decision->mode == safety::Mode::kStop && !decision->arm;
    }
    if (!armed && !stopped) return;
    DriveNews* news = neighbours_.drive.back(drive_tick);
    news->status.level = armed ? DriveLevel::kNormal : DriveLevel::kStop;
    news->status.cause = armed ? DriveCause::kNone : DriveCause::kRequested;
    neighbours_.drive.push(drive_tick);
  }
  template <class News, class Fill>
  void send(scheduler::OutputPort<News>& port, Fill fill) {
    TickRecord record;
    record.index = log_.size();
    Tick tick(Regime::kLive, now_, record);
    News* news = port.back(tick);
    fill(*news);
    port.push(tick);
  }
  void ask(std::uint32_t epoch) {
    asked_.push_back({log_.size(), epoch});
    send(neighbours_.rearms, [&](RearmRequest& request) { request.epoch = epoch; });
  }
  void arm() {
    run(600ms);  // closed for long enough
    ask(task_->decision().epoch);
    run(50ms);
  }
  [[nodiscard]] safety::Mode mode() const { return task_->decision().mode; }

  cairn::test::SafetyNeighbours neighbours_;
  EStopLine line_;
  safety::Fitted fitted_;
  std::optional<SafetyTask> task_;
  Time now_{10s};
  std::vector<TickRecord> log_;
  std::vector<safety::FailsafeDecision> decisions_made_;
  std::uint64_t allocated_ = 0;
  struct Asked {
    std::size_t before;  // the tick
    std::uint32_t epoch;
  };
  std::deque<Asked> asked_;
};

TEST_F(SafetyTaskTest, ARobotIsStoppedUntilItIsAskedFor) {
  run(1s);
  EXPECT_EQ(mode(), safety::Mode::kStop);
  arm();
  EXPECT_EQ(mode(), safety::Mode::kNormal);
  EXPECT_EQ(allocated_, 0U);
}

TEST_F(SafetyTaskTest, ALostEStopThatIsClosedAgainObeysTheNextRequest) {
  arm();
  ASSERT_EQ(mode(), safety::Mode::kNormal);
  line_.there = false;
  run(kPeriod);
  EXPECT_EQ(mode(), safety::Mode::kStop) << "within the tick";
  EXPECT_EQ(task_->decision().cause, safety::Fault::kEStopLost);
  ask(task_->decision().epoch);
  run(1s);
  EXPECT_EQ(mode(), safety::Mode::kStop) << "nobody moves with an e-stop that cannot be read";
  line_.there = true;
  run(2s);
  EXPECT_EQ(mode(), safety::Mode::kStop) << "not by itself";
  EXPECT_FALSE(task_->decision().active.has(safety::Fault::kEStopLost)) << "that is over";
  ask(task_->decision().epoch);
  run(50ms);
  EXPECT_EQ(mode(), safety::Mode::kNormal);
}

TEST_F(SafetyTaskTest, ARequestBeforeTheContactWasClosedForLongEnoughIsLost) {
  arm();
  line_.move(false, now_);
  run(1s);
  ASSERT_EQ(task_->decision().cause, safety::Fault::kEStopOpen);
  line_.move(true, now_);
  run(200ms);  // of estop_rearm_ms
  ask(task_->decision().epoch);
  run(2s);
  EXPECT_EQ(mode(), safety::Mode::kStop) << "a refused request is not kept for later";
  ask(task_->decision().epoch);
  run(50ms);
  EXPECT_EQ(mode(), safety::Mode::kNormal);
}

TEST_F(SafetyTaskTest, AnOldRequestEndsNoLaterStop) {
  run(600ms);
  const std::uint32_t first = task_->decision().epoch;
  arm();
  line_.move(false, now_);
  line_.move(true, now_ + 1ms);
  run(2s);
  ASSERT_EQ(mode(), safety::Mode::kStop) << "two edges between two ticks";
  ask(first);
  run(1s);
  EXPECT_EQ(mode(), safety::Mode::kStop);
}

TEST_F(SafetyTaskTest, ALostTrackDegradesUntilAScanFitsAgain) {
  arm();
  send(neighbours_.odometry, [](OdometryNews& news) { news.lost = true; });
  run(kPeriod);
  EXPECT_EQ(mode(), safety::Mode::kDegraded);
  EXPECT_EQ(task_->decision().cause, safety::Fault::kOdometryLost);
  run(1s);
  EXPECT_EQ(mode(), safety::Mode::kDegraded) << "until there is other news";
  send(neighbours_.odometry, [](OdometryNews& news) { news.lost = false; });
  run(kPeriod);
  EXPECT_EQ(mode(), safety::Mode::kNormal);
}

TEST_F(SafetyTaskTest, FaultsFromAllSidesAreActiveTogether) {
  arm();
  send(neighbours_.sensors, [](SensorsSeen& news) { news.faults = {safety::Fault::kLidarStuck}; });
  send(neighbours_.odometry, [](OdometryNews& news) { news.lost = true; });
  task_->report({safety::Fault::kStageDemoted});
  run(kPeriod);
  EXPECT_EQ(task_->decision().active,
            (safety::FaultSet{safety::Fault::kLidarStuck, safety::Fault::kOdometryLost, safety::Fault::kStageDemoted}));
  EXPECT_EQ(mode(), safety::Mode::kHold);
  send(neighbours_.sensors, [](SensorsSeen& news) { news.faults = {}; });
  run(kPeriod);
  EXPECT_EQ(task_->decision().active, (safety::FaultSet{safety::Fault::kOdometryLost, safety::Fault::kStageDemoted}));
  EXPECT_EQ(allocated_, 0U);
}

/// A live run in which everything happens, and what of it comes from other tasks and from the line.
class ReplayedSafetyTask : public SafetyTaskTest {
 protected:
  void live() {
    arm();
    lose(true);
    run(20ms);
    task_->report({safety::Fault::kStageDemoted});
    run(20ms);
    line_.there = false;
    run(20ms);
    line_.there = true;
    lose(false);
    arm();
    move(false);
    run(20ms);
    move(true);
    task_->report({});
    arm();
  }
  void lose(bool lost) {
    news_.push_back({log_.size(), lost});
    send(neighbours_.odometry, [lost](OdometryNews& n) { n.lost = lost; });
  }
  void move(bool closed) {
    line_.move(closed, now_);
    edges_.push_back(line_.edges.back());
  }
  void send_news_before(std::size_t tick) {
    for (; !requests_.empty() && requests_.front().before == tick; requests_.pop_front())
      send(neighbours_.rearms, [this](RearmRequest& request) { request.epoch = requests_.front().epoch; });
    for (; !news_.empty() && news_.front().before == tick; news_.pop_front())
      send(neighbours_.odometry, [this](OdometryNews& n) { n.lost = news_.front().lost; });
  }

  struct Sent {
    std::size_t before;  // the tick
    bool lost;
  };
  std::deque<Sent> news_;
  std::deque<Asked> requests_;  // of asked_, those not sent yet
  std::deque<Packet> edges_;
};

/// The log alone, without a line, an operator or housekeeping.
TEST_F(ReplayedSafetyTask, DecidesInEveryTickAsItDidLive) {
  live();
  ASSERT_EQ(mode(), safety::Mode::kNormal);
  EStopLine recorded;
  recorded.edges = edges_;
  SafetyTask again({}, fitted_);
  neighbours_.connect(again);
  again.use_lines({}, recorded, SourceId{0}, nullptr, {});
  now_ = Time{10s};
  requests_ = asked_;
  std::uint64_t arms = 0;
  for (std::size_t i = 0; i < log_.size(); ++i, now_ += kPeriod) {
    send_news_before(i);
    TickRecord record = log_[i];
    Tick tick(Regime::kLogged, now_, record);
    again.tick(tick);
    const safety::FailsafeDecision &then = decisions_made_[i], &now = again.decision();
    ASSERT_TRUE(then.mode == now.mode && then.cause == now.cause && then.active == now.active &&
                then.epoch == now.epoch && then.arm == now.arm)
        << "tick " << i;
    arms += now.arm ? 1 : 0;
    serve_motors(i);
  }
  EXPECT_EQ(arms, 3U);
}

}  // namespace
}  // namespace cairn::app
