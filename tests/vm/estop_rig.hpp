// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/clients/commands/command_socket.hpp"
#include "drivers/clients/messages/record.hpp"
#include "drivers/clients/sockets/local_client.hpp"
#include "drivers/drive/can/socketcan_link.hpp"
#include "drivers/drive/canopen/canopen.hpp"
#include "drivers/drive/canopen/cia402.hpp"
#include "onboard/app/profile/schedule_profile.hpp"
#include "onboard/app/tasks/drive_task.hpp"
#include "onboard/app/tasks/safety_task.hpp"
#include "onboard/scheduler/execution/executive.hpp"
#include "tests/drivers/drive/virtual_bus.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/motion/drive_model.hpp"

namespace cairn::vm {

/// What is behind the bus: two CiA 402 controllers with their motors, and someone who writes down every order to one of
/// them, and what the tasks did in which tick.
class FarEnd final : public scheduler::Task {
 public:
  /// Of a command to the first controller: when it was on the bus, and whether the motor may go on turning.
  struct Order {
    Time on_bus{};
    bool motion = false;
  };
  struct TickDone {
    scheduler::TickRecord record;
    const scheduler::ScheduledTask* task = nullptr;
  };

  FarEnd(drive::SocketCanLink& bus, const Clock& clock) : bus_(bus), clock_(clock) {
    simulator::DriveModelConfig left, right;
    right.node = 2;
    nodes_ = {simulator::DriveModel(left), simulator::DriveModel(right)};
  }
  void power_on() {
    serve([&](auto& node, auto& out) { node.power_on(clock_.now(), out); });
  }
  void keep_log_of(scheduler::ScheduledTask& task) { logged_.push_back(&task); }

  void tick(scheduler::Tick& /*tick*/) override {
    while (*bus_.next(packet_, Duration{0}) == Poll::kPacket) {
      if (packet_.channel == static_cast<std::uint16_t>(drive::Direction::kSent)) continue;
      const auto frame = drive::decode_frame(packet_.payload());
      if (!frame) continue;
      if (frame->is(drive::canopen::kRpdo1 + 1))
        orders.push_back({packet_.arrival, (frame->data[0] & 0x0FU) == drive::cia402::kEnableOperation});
      serve([&](auto& node, auto& out) { node.receive(*frame, clock_.now(), out); });
    }
    serve([&](auto& node, auto& out) { node.step(clock_.now(), out); });
    speed_mrad_s = static_cast<std::uint64_t>(1000 * std::abs(nodes_[0].speed()));
    for (scheduler::ScheduledTask* task : logged_)
      for (; task->log.front() != nullptr; task->log.pop()) ticks.push_back({*task->log.front(), task});
  }

  RelaxedCounter speed_mrad_s;  ///< of the first wheel
  std::vector<Order> orders;    ///< after the run
  std::vector<TickDone> ticks;  ///< likewise: those that were not idle

 private:
  template <class Act>
  void serve(Act act) {
    frames_.clear();
    for (auto& node : nodes_) act(node, frames_);
    for (const drive::CanFrame& frame : frames_) (void)bus_.send(frame);
  }
  drive::SocketCanLink& bus_;
  const Clock& clock_;
  std::vector<simulator::DriveModel> nodes_;
  std::vector<scheduler::ScheduledTask*> logged_;
  simulator::DriveModel::Frames frames_;
  Packet packet_;
};

/// The robot's own safety and drive tasks on real devices, as `cairn run` has them, and the far end of the bus.
class EStopRig {
 public:
  EStopRig(const std::string& can, const std::string& chip, std::string world) : world_(std::move(world)) {
    gpio_.chip = chip;
    gpio_.estop_line = "0";
    pull(true);
    link_ = drive::SocketCanLink::open(can, SourceId{0}, clock).value();
    peer_ = drive::SocketCanLink::open(can, SourceId{1}, clock).value();
    lines_ = gpio::open_lines(gpio_, SourceId{2}, clock).value();
    safety::Fitted fitted;
    fitted.drive = fitted.estop = fitted.watched[static_cast<std::size_t>(safety::Watched::kFeedback)] = true;
    safety.emplace(safety::FailsafeConfig{}, fitted);
    edges.reserve(1000);
    safety->use_lines(gpio_, *lines_, SourceId{2}, lines_.get(), [this](const Packet& p) { note(p); });
    (void)drive_.attach(drive::test::two_nodes(), *link_, SourceId{0}, link_.get(), {});
    drive_.obey_commands(*commands_, SourceId{3}, commands_.get(), {});
    far_end.emplace(*peer_, clock);
    far_end->keep_log_of(graph_.add(schedule_.safety, *safety));
    far_end->keep_log_of(graph_.add(schedule_.drive, drive_));
    graph_.add({.name = "far end", .rate_hz = 500}, *far_end, scheduler::TaskRole::kLiveOnly);
    graph_.connect(drive_.status, safety->drive, {.capacity = 64});
    graph_.connect(safety->decisions, drive_.decisions, {.capacity = 64});
    graph_.connect(drive_.rearms, safety->rearms, {.capacity = 8});
  }

  void pull(bool closed) const { std::ofstream(world_ + "/sim_gpio0/pull") << (closed ? "pull-up" : "pull-down"); }
  /// A client of the command socket asks for motion, or to be armed.
  void drive(double v) { say({.verb = clients::Command::Verb::kVelocity, .v = v, .who = {}}); }
  void arm(std::uint32_t epoch) { say({.verb = clients::Command::Verb::kArm, .epoch = epoch, .who = {}}); }

  void run(const std::function<bool()>& over) {
    far_end->power_on();
    scheduler::Executive(graph_).run_live({clock.now(), over}, clock);
    scheduler::TickRecord rest;
    scheduler::Tick last(scheduler::Regime::kDrain, clock.now(), rest);
    far_end->tick(last);
  }

  /// When the kernel saw the contact move, and where to.
  struct Edge {
    Time at{};
    bool closed = false;
  };
  [[nodiscard]] const scheduler::ScheduledTask& safety_schedule() const { return graph_.scheduled(*safety); }
  [[nodiscard]] const scheduler::ScheduledTask& drive_schedule() const { return graph_.scheduled(drive_); }
  [[nodiscard]] const app::DriveTask& drive() const { return drive_; }

  LiveClock clock;
  std::vector<Edge> edges;  ///< after the run
  std::optional<app::SafetyTask> safety;
  std::optional<FarEnd> far_end;

 private:
  void note(const Packet& packet) {
    const auto event = gpio::decode_event(packet);
    if (event && edges.size() < edges.capacity()) edges.push_back({packet.arrival, event->level});
  }

  void say(clients::Command command) {
    command.number = ++said_;
    command.sent = clock.now();
    command.valid_for = clients::Command::kMostValid;
    std::vector<std::byte> bytes;
    encode(command, bytes);
    (void)client_.send(bytes);
    while (client_.receive(bytes, clients::Record::kMaxBody, {}) == clients::LocalClient::Got::kMessage) {
    }
  }

  support::TemporaryFolder sockets_;
  std::unique_ptr<clients::CommandSocket> commands_ =
      clients::CommandSocket::open(sockets_ / "command.sock", SourceId{3}, clock).value();
  clients::LocalClient client_ = clients::LocalClient::connect(sockets_ / "command.sock").value();
  std::uint32_t said_ = 0;
  std::string world_;
  gpio::Config gpio_;
  app::ScheduleProfile schedule_;
  scheduler::TaskGraph graph_;
  std::unique_ptr<drive::SocketCanLink> link_, peer_;
  std::unique_ptr<gpio::GpioLines> lines_;
  app::DriveTask drive_;
};

}  // namespace cairn::vm
