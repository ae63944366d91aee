// SPDX-License-Identifier: Apache-2.0
// The e-stop's wire through the kernel to the motors: a simulated GPIO chip (CAIRN_TEST_GPIOCHIP, CAIRN_TEST_GPIOSIM),
// our drivers, a CAN interface (CAIRN_TEST_CAN) and simulated CiA 402 controllers behind it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "drivers/drive/can_drive.hpp"
#include "drivers/drive/canopen.hpp"
#include "drivers/drive/cia402.hpp"
#include "drivers/drive/socketcan_link.hpp"
#include "drivers/gpio/estop.hpp"
#include "drivers/gpio/gpio_lines.hpp"
#include "tests/drivers/drive/virtual_bus.hpp"
#include "tools/simulator/drive_model.hpp"

namespace cairn {
namespace {

using namespace std::chrono_literals;
using drive::CanFrame;

class EStopStopsDrive : public testing::Test {
 protected:
  void SetUp() override {
    const char* can = std::getenv("CAIRN_TEST_CAN");
    const char* chip = std::getenv("CAIRN_TEST_GPIOCHIP");
    const char* world = std::getenv("CAIRN_TEST_GPIOSIM");
    if (can == nullptr || chip == nullptr || world == nullptr)
      GTEST_SKIP() << "no CAN interface or no GPIO chip is named";
    world_ = world;
    gpio_config.chip = chip;
    gpio_config.estop_line = "0";
    pull(true);
    link = drive::SocketCanLink::open(can, SourceId{0}, clock).value();
    peer = drive::SocketCanLink::open(can, SourceId{1}, clock).value();
    motors = drive::CanDrive::create(drive::test::two_nodes(), *link).value();
    lines = gpio::open_lines(gpio_config, SourceId{2}, clock).value();
    estop.emplace(gpio_config);
    simulator::DriveModelConfig left, right;
    right.node = 2;
    nodes = {simulator::DriveModel(left), simulator::DriveModel(right)};
    serve([&](auto& node, auto& out) { node.power_on(clock.now(), out); });
  }

  void pull(bool closed) const { std::ofstream(world_ + "/sim_gpio0/pull") << (closed ? "pull-up" : "pull-down"); }

  template <class Act>
  void serve(Act act) {
    simulator::DriveModel::Frames out;
    for (auto& node : nodes) act(node, out);
    for (const CanFrame& frame : out) (void)peer->send(frame);
  }

  void serve_bus() {
    while (*peer->next(packet, 1ms) == Poll::kPacket) {
      if (packet.channel == static_cast<std::uint16_t>(drive::Direction::kSent)) continue;
      const auto frame = drive::decode_frame(packet.payload());
      if (!frame) continue;
      quick_stops += frame->is(drive::canopen::kRpdo1 + 1) && frame->data[0] == drive::cia402::kQuickStop ? 1 : 0;
      serve([&](auto& node, auto& out) { node.receive(*frame, clock.now(), out); });
    }
    serve([&](auto& node, auto& out) { node.step(clock.now(), out); });
  }

  /// What a control loop does in a tick: edges, the level, and then the motors.
  void tick() {
    serve_bus();
    while (*lines->next(packet, 0ms) == Poll::kPacket) {
      const auto event = gpio::decode_event(packet).value();
      estop->edge(packet.arrival, event.level, event.sequence);
    }
    const Time now = clock.now();
    if (const auto level = lines->level(gpio::Line::kEStop))
      estop->level(now, *level);
    else
      estop->lost(now);
    if (estop->stopped(now)) motors->stop(DriveCause::kEmergencyStop, now);
    if (epoch) (void)motors->command({0.5, 0, *epoch}, now);
    if (const auto state = motors->tick(now); state && *state != nullptr) speed = (*state)->v;
  }

  template <class Condition>
  bool tick_until(Condition met) {
    for (const Time end = clock.now() + 30s; clock.now() < end;) {
      tick();
      if (met()) return true;
    }
    return false;
  }

  /// Re-arms the e-stop and the drive as soon as both allow it.
  bool try_to_arm() {
    const Time now = clock.now();
    if (estop->stopped(now) && !estop->rearm(now)) return false;
    if (const auto armed = motors->arm(now)) epoch = *armed;
    return epoch.has_value();
  }

  LiveClock clock;
  gpio::Config gpio_config;
  std::unique_ptr<drive::SocketCanLink> link, peer;
  std::unique_ptr<drive::CanDrive> motors;
  std::unique_ptr<gpio::GpioLines> lines;
  std::optional<gpio::EStop> estop;
  std::vector<simulator::DriveModel> nodes;
  std::optional<std::uint32_t> epoch;
  Packet packet;
  double speed = 0;
  int quick_stops = 0;

 private:
  std::string world_;
};

TEST_F(EStopStopsDrive, AnOpenedContactStopsTheMotorsUntilBothAreArmedAgain) {
  ASSERT_TRUE(tick_until([this] { return try_to_arm(); }));
  ASSERT_TRUE(tick_until([this] { return speed > 0.49; }));
  const int before = quick_stops;

  pull(false);
  ASSERT_TRUE(tick_until([this] { return estop->stopped(clock.now()); }));
  EXPECT_EQ(motors->status().cause, DriveCause::kEmergencyStop);
  ASSERT_TRUE(tick_until([this] { return speed < 0.01 && nodes[0].speed() < 0.01; }));
  EXPECT_GT(quick_stops, before) << "the stop frame was on the bus";

  pull(true);  // the contact closes: nothing may move by itself
  const Time closed = clock.now();
  ASSERT_TRUE(tick_until([&] { return clock.now() > closed + 1s; }));
  EXPECT_LT(speed, 0.01);
  EXPECT_EQ(motors->status().level, DriveLevel::kStop);

  epoch.reset();
  ASSERT_TRUE(tick_until([this] { return try_to_arm(); }));
  EXPECT_TRUE(tick_until([this] { return speed > 0.49; }));
  motors->stop(DriveCause::kRequested, clock.now());
}

}  // namespace
}  // namespace cairn
