// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/connect_inputs.hpp"

#include <gmock/gmock.h>

#include "tests/support/places.hpp"

namespace cairn::app {
namespace {

using namespace std::chrono_literals;

/// One packet.
class OnePacket final : public Source {
 public:
  explicit OnePacket(Time arrival) : arrival_(arrival) {}
  Result<Poll> next(Packet& packet, Duration /*timeout*/) override {
    if (std::exchange(given_, true)) return Poll::kEnd;
    packet.arrival = arrival_;
    return Poll::kPacket;
  }

 private:
  Time arrival_;
  bool given_ = false;
};

struct ConnectInputsTest : ::testing::Test {
  void add(recording::SensorKind kind, Time arrival) {
    Input& input = door.inputs.emplace_back();
    input.entry.id = to_string(kind);
    input.entry.kind = kind;
    input.source = std::make_unique<OnePacket>(arrival);
    door.recording.sources.push_back(input.entry);
  }
  void connect() {
    tasks.emplace(door.recording.sources, profile, options, previous, Sight(), monitor);
    const auto connected = connect_inputs(*tasks, {door, profile, options, previous, monitor}, nullptr);
    ASSERT_TRUE(connected) << to_string(connected.error());
  }

  Door door;
  RobotProfile profile;
  RunOptions options;
  PreviousRun previous;
  Monitor monitor;
  std::optional<RobotTasks> tasks;
};

TEST_F(ConnectInputsTest, WheelsThatCannotBeReadAreSaid) {
  profile = load_profile(places::source() / "config/husky.yaml").value();
  add(recording::kDrive, Time{2s});
  connect();
  ASSERT_EQ(monitor.events().size(), 1U);
  EXPECT_THAT(monitor.events().front().what, ::testing::HasSubstr("the profile has no scales"));

  Monitor quiet;
  profile.drive.driver.velocity_units_per_rad_s = 1000;
  profile.drive.driver.position_counts_per_rad = 12'000;
  RobotTasks with_scales(door.recording.sources, profile, options, previous, Sight(), quiet);
  ASSERT_TRUE(connect_inputs(with_scales, {door, profile, options, previous, quiet}, nullptr));
  EXPECT_TRUE(quiet.events().empty());
}

TEST_F(ConnectInputsTest, ADriveThatNoProfileKnowsIsLeftOut) {
  add(recording::kDrive, Time{2s});
  connect();
  ASSERT_EQ(monitor.events().size(), 1U);
  EXPECT_THAT(monitor.events().front().what, ::testing::HasSubstr("no profile says how to read it"));
}

TEST_F(ConnectInputsTest, EveryInputGoesToTheTaskThatReadsIt) {
  profile = load_profile(places::source() / "config/husky.yaml").value();
  add(recording::kScans, Time{4s});
  add(recording::kGpio, Time{3s});
  add(recording::kDrive, Time{2s});
  add(recording::kPeers, Time{1s});
  connect();
  EXPECT_EQ(tasks->receive.first_arrival(), Time{4s});
  EXPECT_EQ(tasks->safety.first_arrival(), Time{3s});
  EXPECT_EQ(tasks->drive.first_arrival(), Time{2s});
  EXPECT_EQ(tasks->team->team().first_arrival(), Time{1s});
  EXPECT_EQ(first_arrival(*tasks), Time{1s});
  EXPECT_EQ(missing_packets(*tasks), 0U);
}

TEST_F(ConnectInputsTest, WithoutANamedEStopTheOtherLinesAreRead) {
  add(recording::kGpio, Time{3s});
  connect();
  EXPECT_FALSE(tasks->fitted.estop);
  EXPECT_EQ(tasks->safety.first_arrival(), Time{3s});
  EXPECT_EQ(tasks->receive.first_arrival(), Time::max());
}

TEST_F(ConnectInputsTest, AnInputBeyondTheLastSlotIsLeftOutWithAnEvent) {
  for (std::size_t i = 0; i < ReceiveTask::kMaxInputs; ++i) add(recording::kCamera, Time{2s});
  add(recording::kThermal, Time{1s});
  connect();
  EXPECT_EQ(first_arrival(*tasks), Time{2s});
  ASSERT_EQ(monitor.events().size(), 1U);
  EXPECT_THAT(monitor.events()[0].what, ::testing::HasSubstr("thermal is left out"));
}

TEST_F(ConnectInputsTest, WithoutInputsNothingArrives) {
  connect();
  EXPECT_EQ(first_arrival(*tasks), Time::max());
}

}  // namespace
}  // namespace cairn::app
