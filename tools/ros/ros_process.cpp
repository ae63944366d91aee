// SPDX-License-Identifier: Apache-2.0
// cairn-ros: a client of a running core that speaks to programs of ROS 2 over Cyclone DDS. It knows no device, keeps no
// state, and may die at any time: the core notices nothing but its absence.
#include <fmt/format.h>
#include <poll.h>

#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/peers/bounded_end.hpp"
#include "drivers/peers/dds_log.hpp"
#include "hal/clock.hpp"
#include "hal/files/standard_output.hpp"
#include "onboard/client/robot_stream.hpp"
#include "tools/ros/bridge/robot_commands.hpp"
#include "tools/ros/bridge/robot_topics.hpp"
#include "tools/ros/commands/command_relay.hpp"
#include "tools/ros/dds/ros_graph.hpp"
#include "tools/ros/dds/ros_name.hpp"
#include "tools/ros/options.hpp"

namespace cairn::ros {
namespace {

using client::RobotStream;
using client::StreamMessage;
using peer_link::end_requested;

constexpr int kPatience_ms = 100;  // for a core that is not there, readers that come, and the end
constexpr int kMostInARow = 256;   // messages of the core, before commands get their turn again
constexpr const char* kNode = "cairn_ros";

/// Says each trouble once, until another one comes.
class Complaints {
 public:
  void hear(const Result<void>& result) {
    if (result) return;
    const std::string text = to_string(result.error());
    if (text != last_) fmt::print(stderr, "cairn-ros: {}\n", text);
    last_ = text;
  }

 private:
  std::string last_;
};

/// This end of robot.sock, whether a core is there or not.
class Core {
 public:
  explicit Core(std::string socket) : socket_(std::move(socket)) {}

  /// Asks for what is wanted now; looks for a core if there has been none yet.
  void ask(const client::SubscribeMessage& wants) {
    if (!stream_) {
      if (auto stream = RobotStream::connect(socket_, wants)) stream_.emplace(std::move(*stream));
      return;
    }
    const bool others = stream_->wants().streams != wants.streams;
    stream_->wants() = wants;
    if (others && stream_->connected()) (void)stream_->subscribe(wants);
  }
  /// Does not wait. Nothing: nothing more has come.
  std::optional<StreamMessage> next(Complaints& complaints) {
    if (!stream_) return std::nullopt;
    auto message = stream_->next(Duration{});
    if (!message) complaints.hear(message.error());
    if (!message || std::holds_alternative<std::monostate>(*message)) return std::nullopt;
    return std::move(*message);
  }
  [[nodiscard]] int readable_fd() const { return stream_ ? stream_->readable_fd() : -1; }

 private:
  std::string socket_;
  std::optional<RobotStream> stream_;
};

/// As the first core says it that greets. None: the end was requested before.
std::optional<std::string> name_of_robot(const std::string& socket, Complaints& complaints) {
  fmt::print(stderr, "cairn-ros: waits for a core at {} to learn the robot's name\n", socket);
  for (Core core(socket); !end_requested();) {
    core.ask({});
    pollfd waited{core.readable_fd(), POLLIN, 0};
    (void)::poll(&waited, 1, kPatience_ms);
    while (const auto message = core.next(complaints))
      if (const auto* hello = std::get_if<client::HelloMessage>(&*message)) return hello->robot;
  }
  return std::nullopt;
}

/// All that is there once the robot's name is known.
struct Bridge {
  std::unique_ptr<RosParticipant> participant;
  std::unique_ptr<RobotTopics> topics;
  RosGraph graph;
  std::optional<RobotCommands> commands;  // none: nobody may command
};

Result<Bridge> open(const Options& options, CommandRelay& relay) {
  auto participant = RosParticipant::open(options.network);
  if (!participant) return participant.error();
  const std::string& name = options.topics.name;
  auto topics = RobotTopics::open(**participant, options.topics);
  if (!topics) return topics.error();
  auto graph = RosGraph::open(**participant, options.graph, "/" + name, kNode);
  if (!graph) return graph.error();
  Bridge bridge{std::move(*participant), std::move(*topics), std::move(*graph), std::nullopt};
  if (options.command_socket.empty()) return bridge;
  auto commands = RobotCommands::open(*bridge.participant, name, relay);
  if (!commands) return commands.error();
  bridge.commands = *commands;
  return bridge;
}

void wait(const Core& core, const Bridge& bridge, const CommandRelay& relay) {
  std::array<pollfd, 3> waited{{{core.readable_fd(), POLLIN, 0},
                                {bridge.participant->readable_fd(), POLLIN, 0},
                                {relay.readable_fd(), POLLIN, 0}}};
  (void)::poll(waited.data(), waited.size(), kPatience_ms);
}

void serve(Core& core, Bridge& bridge, CommandRelay& relay, const Clock& clock, peer_link::DdsLog& log,
           Complaints& complaints) {
  for (Duration busy{}; !end_requested();) {
    core.ask(bridge.topics->wants());
    wait(core, bridge, relay);
    const Time woken = clock.now();
    bridge.participant->wait_again();
    const Duration utc = woken.time_since_epoch() + LiveClock::realtime_offset();
    if (bridge.commands) bridge.commands->take(busy, utc, bridge.topics->arming_epoch());
    for (int i = 0; i < kMostInARow; ++i) {
      const auto message = core.next(complaints);
      if (!message) break;
      complaints.hear(bridge.topics->take(*message, clock.now()));
    }
    relay.read_answers();
    std::vector<Diagnosis> others;
    if (bridge.commands) others.push_back(relay.diagnosis());
    complaints.hear(bridge.topics->tick(clock.now(), others));
    complaints.hear(bridge.graph.tick());
    log.settle();
    busy = clock.now() - woken;
  }
}

int run(Options options) {
  const LiveClock clock;
  peer_link::DdsLog log(clock, "cairn-ros");  // before the participant: it outlives Cyclone's threads
  Complaints complaints;
  if (options.topics.name.empty()) {
    const auto robot = name_of_robot(options.socket, complaints);
    if (!robot) return 0;
    options.topics.name = namespace_of(*robot);
  }
  CommandRelay relay(options.command_socket, clock);
  auto bridge = open(options, relay);
  if (!bridge) {
    fmt::print(stderr, "cairn-ros: {}\n", to_string(bridge.error()));
    return 1;
  }
  fmt::print(stderr, "cairn-ros: topics below /{} in domain {}{}\n", options.topics.name, options.network.domain,
             bridge->commands ? "" : "; nobody can command the robot: no --command-socket");
  Core core(options.socket);
  serve(core, *bridge, relay, clock, log, complaints);
  log.sum_up();
  return 0;
}

}  // namespace
}  // namespace cairn::ros

int main(int argc, char** argv) {
  cairn::ros::Options options;
  if (const auto code = cairn::ros::parse(argc, argv, options)) return cairn::end_of_program("cairn-ros", *code);
  cairn::peer_link::catch_end_signals();
  return cairn::end_of_program("cairn-ros", cairn::ros::run(std::move(options)));
}
