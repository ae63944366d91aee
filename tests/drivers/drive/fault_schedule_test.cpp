// SPDX-License-Identifier: Apache-2.0
// Random faults at random times: whatever happens, a robot that stopped does not move before it is armed again.
#include <gtest/gtest.h>

#include "tests/drivers/drive/virtual_bus.hpp"
#include "tests/support/rounds.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::drive {
namespace {

using test::Robot;
using namespace std::chrono_literals;

class Schedule {
 public:
  explicit Schedule(std::uint64_t seed) : random_(seed) {
    robot_.every_tick = [this] { check(); };
  }

  void run() {
    robot_.start();
    for (int i = 0; i < 60 && !testing::Test::HasFailure(); ++i) {
      robot_.go(random_.uniform(-1, 1), random_.uniform(-1, 1));
      act(random_.below(16));
      robot_.run(5ms * static_cast<int>(1 + random_.below(60)));
    }
  }

  [[nodiscard]] int stops() const { return stops_; }

 private:
  void act(std::size_t kind) {
    auto& bus = robot_.bus;
    auto& node = bus.nodes[random_.below(2)];
    const auto error = [&](std::uint32_t classes, std::uint8_t detail) {
      bus.inject(make_frame(kErrorFrame | classes, {0, detail, 0, 0, 0, 0, 0, 0}));
    };
    switch (kind) {
      case 0:
        return robot_.drive->stop(DriveCause::kEmergencyStop, bus.now);
      case 1:
        return bus.deliver([&](auto& out) { node.fail(0x3210, out, random_.below(4) == 0); });
      case 2:
        return bus.deliver([&](auto& out) { node.power_on(bus.now, out); });
      case 3:
        return node.power_off();
      case 4:
        return node.mute(random_.below(2) == 0);
      case 5:
        bus.full = random_.below(2) == 0;
        return;
      case 6:
        bus.down = random_.below(2) == 0;
        return;
      case 7:
        return error(kErrorBusOff, 0);
      case 8:
        return error(kErrorRestarted, 0);
      case 9:
        return error(kErrorController, random_.below(2) == 0 ? kControllerPassive : kControllerActive);
      case 10:
        bus.lose = [this](const CanFrame&) { return random_.below(5) == 0; };
        return;
      case 11:
        return bus.inject(garbage());
      case 12:
        robot_.wanted.reset();
        return;
      default:
        return recover();
    }
  }

  void recover() {
    auto& bus = robot_.bus;
    bus.full = bus.down = false;
    bus.lose = {};
    for (auto& node : bus.nodes) node.mute(false);
    bus.inject(make_frame(kErrorFrame | kErrorController, {0, kControllerActive, 0, 0, 0, 0, 0, 0}));
    robot_.run(10ms);
    if (robot_.arm()) stopped_at_.reset();
  }

  CanFrame garbage() {
    CanFrame frame;
    constexpr std::array<std::uint32_t, 8> kIds{0x181, 0x182, 0x281, 0x282, 0x081, 0x581, 0x701, 0x702};
    frame.id = kIds[random_.below(kIds.size())];
    frame.length = static_cast<std::uint8_t>(random_.below(9));
    for (std::size_t i = 0; i < frame.length; ++i) frame.data[i] = static_cast<std::uint8_t>(random_.next());
    return frame;
  }

  void check() {
    const bool stopped = robot_.status().level == DriveLevel::kStop;
    if (!stopped) stopped_at_.reset();
    if (stopped && !stopped_at_) {
      stopped_at_ = robot_.bus.now;
      speeds_ = {std::abs(robot_.left_speed()), std::abs(robot_.right_speed())};
      ++stops_;
    }
    for (const CanFrame& frame : robot_.bus.sent) {
      if (!frame.is(canopen::kRpdo1 + 1) && !frame.is(canopen::kRpdo1 + 2)) continue;
      const auto order = cia402::decode_rpdo1(frame).value();
      if (robot_.status().level != DriveLevel::kNormal) {
        EXPECT_EQ(order.target_velocity, 0);
      }
      if (stopped) {
        EXPECT_NE(order.controlword & 0x0FU, cia402::kEnableOperation);
      }
    }
    robot_.bus.sent.clear();
    if (!stopped_at_) return;
    // A node that no frame reaches any more goes on until its own watchdog of 100 ms stops it.
    const bool watchdog = robot_.bus.now - *stopped_at_ > 150ms;
    const std::array<double, 2> speeds{std::abs(robot_.left_speed()), std::abs(robot_.right_speed())};
    for (std::size_t i = 0; i < 2; ++i) {
      if (watchdog) {
        EXPECT_LE(speeds[i], speeds_[i] + 1e-12) << "wheel " << i << " speeds up after a stop";
      }
      if (robot_.bus.now - *stopped_at_ > 1500ms) {
        EXPECT_EQ(speeds[i], 0) << "wheel " << i << " does not come to rest";
      }
    }
    if (watchdog) speeds_ = speeds;
  }

  simulator::Random random_;
  Robot robot_;
  std::optional<Time> stopped_at_;
  std::array<double, 2> speeds_{};
  int stops_ = 0;
};

TEST(FaultSchedule, NoMotionAfterAStopWithoutArming) {
  const int schedules = support::rounds(300, 50);
  int stops = 0;
  for (int seed = 1; seed <= schedules && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Schedule schedule(static_cast<std::uint64_t>(seed));
    schedule.run();
    stops += schedule.stops();
  }
  EXPECT_GT(stops, schedules * 5 / 3);
}

}  // namespace
}  // namespace cairn::drive
