// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/team_task.hpp"

#include <gtest/gtest.h>

#include "drivers/peers/peer_packet.hpp"
#include "onboard/app/profile/schedule_profile.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::app {
namespace {

/// Says who the robot is, and nothing after that.
class BeginningAlone final : public Source {
 public:
  Result<Poll> next(Packet& packet, Duration /*timeout*/) override {
    if (std::exchange(given_, true)) return Poll::kTimeout;
    encode(peer_link::Beginning{.robot = 1, .epoch = 1}, packet);
    return Poll::kPacket;
  }

 private:
  bool given_ = false;
};

/// In the place of mapping: one tile with a wall, at a time.
struct Mapper final : scheduler::Task {
  void tick(scheduler::Tick& tick) override {
    TileBatch* batch = batches.back(tick);
    if (batch == nullptr) return;
    *batch = {};
    batch->epoch = 1;
    batch->stamp = tick.release();
    mapping::TileState state;
    state.set(1, 2, 3, 3.5F);
    batch->tiles.emplace_back(mapping::TileKey{next++}, state);
    batches.push(tick);
  }
  scheduler::OutputPort<TileBatch> batches{*this, "tiles"};
  std::uint64_t next = 0;
};

class TeamTaskTest : public ::testing::Test {
 protected:
  TeamTaskTest() : team_(TeamProfile(), "husky", 0.2, monitor_) {
    const ScheduleProfile schedule;
    graph_.add(schedule.mapping, mapper_);
    graph_.add(schedule.team, team_, scheduler::TaskRole::kInput);
    graph_.connect(mapper_.batches, team_.tiles, {.capacity = 8});
    team_.attach(source_, SourceId{}, nullptr, {});
    team_.spare([this] { return shed_; });
  }
  /// Two seconds, live, on a machine whose clock stands still while a task works.
  void run(bool mapping = true) {
    for (int i = 0; i < 20; ++i) {
      now_ += std::chrono::milliseconds(100);
      scheduler::TickRecord record;
      record.index = ++index_;
      scheduler::Tick tick(scheduler::Regime::kLive, now_, record);
      if (mapping) mapper_.tick(tick);
      team_.tick(tick);
    }
  }
  [[nodiscard]] bool folded() const { return team_.team()->map().up_to_date(); }

  Monitor monitor_;
  BeginningAlone source_;
  Mapper mapper_;
  TeamTask team_;
  scheduler::TaskGraph graph_;
  safety::Shed shed_ = safety::Shed::kNothing;
  Time now_{};
  std::uint64_t index_ = 0;
};

TEST_F(TeamTaskTest, MapsWaitWhileTheRobotIsOverloaded) {
  run();
  run(false);
  ASSERT_TRUE(team_.team());
  EXPECT_TRUE(folded());
  shed_ = safety::Shed::kMapDensity;
  run();
  EXPECT_FALSE(folded()) << "each level leaves out what those before it do";
  shed_ = safety::Shed::kNothing;
  run(false);
  EXPECT_TRUE(folded()) << "what waited is done later";
}

}  // namespace
}  // namespace cairn::app
