// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "drivers/drive/can_drive.hpp"
#include "tools/simulator/motion/drive_model.hpp"

namespace cairn::drive::test {

using namespace std::chrono_literals;

/// A robot with two simulated CiA 402 nodes: 0.16 m wheels, 0.5 m apart, the right motor mounted the other way round.
inline Config two_nodes() {
  Config c;
  c.wheel_radius_m = 0.16;
  c.wheel_separation_m = 0.5;
  c.max_speed_m_s = 1.5;
  c.max_yaw_rate_rad_s = 2;
  c.velocity_units_per_rad_s = 1000;
  c.position_counts_per_rad = 10000;
  c.vendor = 0x300;
  c.product = 0x4644;
  return c;
}

/// A CAN bus in virtual time: the drive on one end, simulated motor controllers on the other.
class VirtualBus final : public CanLink {
 public:
  VirtualBus() {
    simulator::DriveModelConfig left, right;
    right.node = 2;
    nodes.emplace_back(left);
    nodes.emplace_back(right);
  }

  void power_on() {
    for (auto& node : nodes) deliver([&](auto& out) { node.power_on(now, out); });
  }
  void advance(Duration dt) {
    now += dt;
    for (auto& node : nodes) deliver([&](auto& out) { node.step(now, out); });
  }
  void inject(const CanFrame& frame) {
    Packet packet;
    packet.arrival = now;
    packet.sequence = sequence_++;
    encode_frame(frame, packet);
    received_.push_back(packet);
  }
  /// Lets a node do something, and its frames arrive.
  template <class Do>
  void deliver(Do&& act) {
    simulator::DriveModel::Frames out;
    act(out);
    for (const CanFrame& frame : out)
      if (!lose || !lose(frame)) inject(frame);
  }

  Result<Poll> next(Packet& packet, Duration) override {
    if (down) return Error{Errc::kLinkDown, "down", {}, {}, {}};
    if (received_.empty()) return Poll::kTimeout;
    packet = received_.front();
    received_.pop_front();
    return Poll::kPacket;
  }
  SendResult send(const CanFrame& frame) override {
    if (down) return SendResult::kDown;
    if (full) return SendResult::kQueueFull;
    sent.push_back(frame);
    for (auto& node : nodes) deliver([&](auto& out) { node.receive(frame, now, out); });
    return SendResult::kSent;
  }
  Result<void> restart() override { return ++restarts, Result<void>(); }

  Time now{1s};
  std::vector<simulator::DriveModel> nodes;
  std::vector<CanFrame> sent;
  std::function<bool(const CanFrame&)> lose;  ///< which frames of the nodes never arrive
  bool full = false, down = false;
  int restarts = 0;

 private:
  std::deque<Packet> received_;
  std::uint64_t sequence_ = 0;
};

/// The bus and a drive on it, ticked every 5 ms.
class Robot {
 public:
  explicit Robot(const Config& config = two_nodes()) : drive(CanDrive::create(config, bus).value()) {}

  void run(Duration duration) {
    for (const Time end = bus.now + duration; bus.now < end;) {
      bus.advance(5ms);
      if (wanted) (void)drive->command({wanted->v, wanted->w, epoch}, bus.now);
      if (auto state = drive->tick(bus.now); state && *state != nullptr) newest = **state;
      if (every_tick) every_tick();
    }
  }
  bool arm() {
    const auto armed = drive->arm(bus.now);
    if (armed) epoch = *armed;
    return armed.has_value();
  }
  /// Powered, configured, armed and enabled.
  void start() {
    bus.power_on();
    run(1s);
    arm();
    run(500ms);
  }
  void go(double v, double w) { wanted = DriveCommand{v, w, 0}; }
  [[nodiscard]] DriveStatus status() const { return drive->status(); }
  [[nodiscard]] double left_speed() const { return bus.nodes[0].speed() * 0.16; }  // m/s at the rim
  [[nodiscard]] double right_speed() const { return -bus.nodes[1].speed() * 0.16; }

  VirtualBus bus;
  std::unique_ptr<CanDrive> drive;
  std::uint32_t epoch = 0;
  std::optional<DriveCommand> wanted;
  std::optional<DriveState> newest;
  std::function<void()> every_tick;
};

}  // namespace cairn::drive::test
